#include "tests/vis/function_source.h"
#include "vis/packed/laid_rows.h"
#include "vis/packed/packet_volume.h"
#include "volume/reconstruct/reconstruct.h"

#include <cmath>
#include <gtest/gtest.h>

/// Rows of samples as they are laid out: filtered by each instruction set, and rounded to shorts.
namespace tessera::vis::packet {
namespace {

using volume::LatticeKind;

/// Waves above a level far from 0, as temperatures in Kelvin are.
std::optional<double> warm(glm::dvec3 p, bool masked) {
    if (masked && std::abs(p.x - 0.4 * p.z - 3) < 2) return std::nullopt;
    return 350 + std::sin(0.7 * p.x + 0.2 * p.z) * std::cos(0.9 * p.y) + 0.02 * p.z;
}

std::shared_ptr<FunctionSource> warmSource(LatticeKind kind, bool masked, glm::ivec3 size) {
    const auto value = [masked](glm::dvec3 p) { return warm(p, masked); };
    return std::make_shared<FunctionSource>(kind, size, glm::dvec3(1),
                                            std::vector<FunctionSource::Channel>{{"T", value, {348, 352}}}, 8);
}

TEST(LaidRows, AreTheSameByEveryInstructionSet) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
        for (const bool filtered : {false, true})
            for (const bool masked : {false, true}) {
                const glm::ivec3 size(21, 18, 24);
                const auto source = warmSource(kind, masked, size);
                const glm::ivec3 texels = source->grid().lattice.texels();
                const PaddedSamples padded =
                    readPadded(*source, {.only = {}, .first = glm::ivec3(-3), .count = texels + 6}, {});
                const LaidRows plain(padded, kind, filtered, Cpu::Portable), best(padded, kind, filtered);
                ASSERT_EQ(plain.masked(), masked);
                const glm::ivec3 all = plain.size();
                for (const int width : {3, 8, 18, all.x})
                    for (int z = 0; z < all.z; ++z) {
                        const int rows = all.y - 1;
                        std::vector<float> a(std::size_t(width) * std::size_t(rows)), b(a.size());
                        std::vector<std::uint8_t> p(a.size()), q(a.size());
                        plain.read({all.x - width, 1, z}, width, rows, a.data(), p.data());
                        best.read({all.x - width, 1, z}, width, rows, b.data(), q.data());
                        ASSERT_EQ(a, b) << width << ' ' << z;
                        ASSERT_EQ(p, q);
                    }
                const Extent one = plain.extent(all), other = best.extent(all);
                EXPECT_EQ(one.lo, other.lo);
                EXPECT_EQ(one.hi, other.hi);
            }
}

/// The shorts of a volume are the samples that the filter gives in double, rounded; the range of them is used up.
TEST(LaidRows, GiveShortsThatAreTheFilteredSamples) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
        for (const bool masked : {false, true}) {
            const auto source = warmSource(kind, masked, {19, 22, 25});
            const PacketVolume volume = readPacketVolume(*source, {});
            const volume::Lattice& lattice = source->grid().lattice;
            const auto raw = [&](glm::ivec3 at) -> volume::Sample {
                const auto value = warm(lattice.position(volume::clampToLattice(kind, lattice.size, at)), masked);
                return {value ? double(float(*value)) : 0, value.has_value()};
            };
            const volume::Prefiltered filtered(raw, volume::levelGeometry(source->grid(), 0));
            int least = kQuantum, most = 0;
            for (int odd = 0; odd < (volume.bcc ? 2 : 1); ++odd)
                for (int z = 0; z <= volume.cells.z; ++z)
                    for (int y = 0; y <= volume.cells.y; ++y)
                        for (int x = 0; x <= volume.cells.x; ++x) {
                            glm::ivec3 at = glm::ivec3(x, y, z) - kMargin;
                            if (volume.bcc) at.z = 2 * at.z + odd;
                            const volume::Sample wanted = filtered(at);
                            const int got = volume.shorts[volume.at({x, y, z}, odd)];
                            if (!wanted.present) {
                                ASSERT_EQ(got, 0);
                                continue;
                            }
                            least = std::min(least, got);
                            most = std::max(most, got);
                            ASSERT_NEAR(got, (wanted.value - volume.offset) / volume.scale, 1)
                                << "half a step, and a float's last digit of 350";
                        }
            EXPECT_EQ(least, 0);
            EXPECT_EQ(most, kQuantum);
        }
}

} // namespace
} // namespace tessera::vis::packet
