#include "tests/vis/function_source.h"
#include "vis/packet/packet_scene.h"
#include "volume/reconstruct/cubic.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <gtest/gtest.h>
#include <utility>

/// Samples as they are laid out, and what empty space is skipped by: bounds of blocks.
namespace tessera::vis::packet {
namespace {

using volume::LatticeKind;

std::optional<double> wave(glm::dvec3 p, bool masked) {
    if (masked && std::abs(p.x - p.z * 0.5 - 2.2) < 1.7) return std::nullopt;
    return std::sin(0.9 * p.x) * std::cos(0.8 * p.y) + std::sin(1.1 * p.z + 0.1 * p.x);
}

std::shared_ptr<FunctionSource> waves(LatticeKind kind, bool masked) {
    const auto value = [masked](glm::dvec3 p) { return wave(p, masked); };
    return std::make_shared<FunctionSource>(kind, glm::ivec3(19, 17, 25), glm::dvec3(1),
                                            std::vector<FunctionSource::Channel>{{"a", value, {-2, 2}}}, 8);
}

/// Coefficients of cubic B-splines, of a lattice whose border samples go on without end.
class Coefficients {
public:
    Coefficients(const auto& raw, const volume::LevelGeometry& geometry, const volume::Lattice& lattice)
        : steps_(1, 1, lattice.kind == LatticeKind::BCC ? 2 : 1) {
        const int beyond = kMargin + volume::prefilterReach(volume::Prefilter::Cubic, geometry);
        volume::BrickSamples all;
        all.size = (lattice.texels() + 2 * beyond) * steps_;
        for (int z = 0; z < all.size.z; ++z)
            for (int y = 0; y < all.size.y; ++y)
                for (int x = 0; x < all.size.x; ++x) {
                    const volume::Sample sample = raw(glm::ivec3(x, y, z) - beyond * steps_);
                    all.values.push_back(float(sample.value));
                    all.present.push_back(sample.present);
                }
        found_ = volume::cubicCoefficients(all, geometry);
    }
    volume::Sample operator()(glm::ivec3 at) const {
        return volume::BrickView{found_, steps_.z == 2 ? LatticeKind::BCC : LatticeKind::CC, -kMargin * steps_}(at);
    }

private:
    glm::ivec3 steps_;
    volume::BrickSamples found_;
};

/// Every sample with its margin is that of the source, or what the prefilter makes of it; beyond the lattice the
/// nearest of the same sublattice.
TEST(PacketLayout, HoldsTheSamplesOfTheSource) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
        for (const bool masked : {false, true})
            for (const Filter filter : {Filter::Average, Filter::AverageQuasi, Filter::Cubic}) {
                const auto source = waves(kind, masked);
                const PacketVolume volume = readPacketVolume(*source, {.filter = filter, .exact = true});
                ASSERT_EQ(volume.present.empty(), !masked);
                const volume::Lattice& lattice = source->grid().lattice;
                const auto raw = [&](glm::ivec3 at) -> volume::Sample {
                    const glm::ivec3 inside = volume::clampToLattice(kind, lattice.size, at);
                    const std::optional<double> value = wave(lattice.position(inside), masked);
                    return {value ? double(float(*value)) : 0, value.has_value()};
                };
                const volume::LevelGeometry geometry = volume::levelGeometry(source->grid(), 0);
                const volume::Prefiltered filtered(raw, geometry);
                ASSERT_EQ(volume.cubic, filter == Filter::Cubic);
                const Coefficients coefficients(raw, geometry, lattice);
                int absent = 0;
                for (int odd = 0; odd < (volume.bcc ? 2 : 1); ++odd)
                    for (int z = 0; z <= volume.cells.z; ++z)
                        for (int y = 0; y <= volume.cells.y; ++y)
                            for (int x = 0; x <= volume.cells.x; ++x) {
                                glm::ivec3 at = glm::ivec3(x, y, z) - kMargin;
                                if (volume.bcc) at.z = 2 * at.z + odd;
                                const volume::Sample wanted = filter == Filter::Average        ? raw(at)
                                                              : filter == Filter::AverageQuasi ? filtered(at)
                                                                                               : coefficients(at);
                                const std::size_t stored = volume.at({x, y, z}, odd);
                                if (masked) {
                                    ASSERT_EQ(volume.present[stored], wanted.present ? kQuantum : 0);
                                }
                                absent += !wanted.present;
                                const double got = volume.offset + volume.scale * double(volume.floats[stored]);
                                if (wanted.present) {
                                    ASSERT_NEAR(got, wanted.value, filter == Filter::Cubic ? 1e-5 : 1e-6)
                                        << x << ' ' << y << ' ' << z << ' ' << odd;
                                } else {
                                    ASSERT_EQ(volume.floats[stored], 0);
                                }
                            }
                EXPECT_EQ(absent > 500, masked) << absent;
            }
}

/// No wider than the samples around a block are.
TEST(PacketBlocks, BoundsAreTight) {
    const PacketVolume volume = readPacketVolume(*waves(LatticeKind::CC, false), {.filter = Filter::Average});
    int compared = 0;
    for (int z = 0; z + kFine <= volume.cells.z; z += kFine)
        for (int y = 0; y + kFine <= volume.cells.y; y += kFine)
            for (int x = 0; x + kFine <= volume.cells.x; x += kFine) {
                std::int16_t lo = kQuantum, hi = 0;
                for (int n = 0; n < 125; ++n) {
                    const std::int16_t sample = volume.shorts[volume.at({x + n % 5, y + n / 5 % 5, z + n / 25}, 0)];
                    lo = std::min(lo, sample);
                    hi = std::max(hi, sample);
                }
                const std::size_t block =
                    std::size_t((z / kFine * volume.blocks.y + y / kFine) * volume.blocks.x + x / kFine);
                ASSERT_NEAR(volume.lo[block], lo, 0.51);
                ASSERT_NEAR(volume.hi[block], hi, 0.51);
                ++compared;
            }
    EXPECT_GT(compared, 100);
}

/// Everything that interpolation between samples reads in the cells of a block lies within the block's bounds. In a
/// cell that are the samples at its corners; of the odd sublattice of BCC, which lies half a cell further, also those
/// before them; with the cubic filter one more on every side.
TEST(PacketBlocks, BoundsHoldAllThatIsRead) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
        for (const auto& [masked, filter] : {std::pair{false, Filter::Average},
                                             {true, Filter::Average},
                                             {false, Filter::Cubic},
                                             {true, Filter::Cubic}}) {
            const PacketVolume volume = readPacketVolume(*waves(kind, masked), {.filter = filter});
            ASSERT_EQ(volume.bcc, kind == LatticeKind::BCC);
            const int more = filter == Filter::Cubic ? 1 : 0;
            int read = 0;
            for (int n = 0; n < volume.cells.x * volume.cells.y * volume.cells.z; ++n) {
                const glm::ivec3 cell(n % volume.cells.x, n / volume.cells.x % volume.cells.y,
                                      n / volume.cells.x / volume.cells.y);
                const glm::ivec3 block = cell / kFine;
                const std::size_t own = (std::size_t(block.z) * std::size_t(volume.blocks.y) + std::size_t(block.y)) *
                                            std::size_t(volume.blocks.x) +
                                        std::size_t(block.x);
                for (int odd = 0; odd < (volume.bcc ? 2 : 1); ++odd) {
                    const int first = -odd - more, count = 2 + odd + 2 * more;
                    for (int corner = 0; corner < count * count * count; ++corner) {
                        const glm::ivec3 by =
                            glm::ivec3(corner % count, corner / count % count, corner / count / count) + first;
                        const std::size_t at = volume.at(glm::clamp(cell + by, glm::ivec3(0), volume.cells), odd);
                        if (!volume.present.empty() && volume.present[at] == 0) {
                            ASSERT_EQ(volume.absent[own], 1);
                            continue;
                        }
                        ++read;
                        ASSERT_GE(float(volume.shorts[at]), volume.lo[own] - 0.51f) << n << ' ' << odd << ' ' << corner;
                        ASSERT_LE(float(volume.shorts[at]), volume.hi[own] + 0.51f) << n << ' ' << odd << ' ' << corner;
                    }
                }
            }
            EXPECT_GT(read, 50000);
        }
}

TEST(PacketJobs, HaveTheStepsAskedFor) {
    const auto data = waves(LatticeKind::CC, false);
    Scene scene;
    scene.render.stepVoxels = 0.4f;
    PacketScene drawn(scene, data->info(), {});
    EXPECT_TRUE(drawn.empty());
    const volume::Lattice& lattice = data->grid().lattice;
    EXPECT_FLOAT_EQ(drawn.job(scene, data->info(), lattice, {8, 6}, 1, {}).stepVoxels, 0.4f);
    EXPECT_FLOAT_EQ(drawn.job(scene, data->info(), lattice, {8, 6}, 3, {}).stepVoxels, 1.2f) << "coarser in motion";
}

// Floats take twice the memory: they are for functions over a small part of the data's range.
TEST(PacketChannels, AreExactWhereTheFunctionIsNarrow) {
    volume::DatasetInfo info;
    info.lattice.size = {4, 4, 4};
    info.parameters.resize(2);
    info.parameters[0].name = "a";
    info.parameters[1].name = "b";
    for (volume::Parameter& parameter : info.parameters) parameter.ranges = {{0, 16}};
    Scene scene;
    scene.layers = {{"", true, VolumeLayer{.channel = "a"}},
                    {"", true, IsoLayer{.channel = "b"}},
                    {"", false, VolumeLayer{.channel = "b"}}};
    const auto exact = [&] {
        const std::vector<LayerSamples> drawn = layerSamples(scene, info, drawnScene(scene, info));
        EXPECT_EQ(drawn.size(), 2u) << "hidden layers need nothing";
        EXPECT_EQ(drawn.at(0).channel.exact, drawn.at(1).channel.exact) << "all alike";
        return drawn.at(0).channel.exact;
    };
    EXPECT_FALSE(exact());
    scene.transfer["b"].autoRange = false;
    scene.transfer["b"].range = {3, 5.5};
    EXPECT_FALSE(exact());
    scene.transfer["b"].range = {3, 4.5};
    EXPECT_TRUE(exact()) << "less than an eighth";
}

} // namespace
} // namespace tessera::vis::packet
