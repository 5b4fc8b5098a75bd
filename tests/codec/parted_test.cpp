#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "tests/codec/make_dataset.h"
#include "tests/codec/plain/decoder.h"
#include "tests/codec/plain_labels.h"
#include "tests/codec/sealed_file.h"
#include "volume/synthetic/fuel_cell.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::Field;
using volume::ScalarType;

/// A cell of two sides with a plate of some samples between them, in which p is absent if `gap`; p jumps there. At
/// later times all moves a little, the plate as well.
volume::Dataset cell(int plate, bool gap, ScalarType type = ScalarType::F32, int times = 1) {
    volume::Dataset made =
        makeDataset({21, 34, 40}, {{"p", type}, {"region", ScalarType::U8, 1, {}, false, true}}, times);
    made.info.parameters[0].parts = {"region", {{0, 1}, {2}}};
    made.info.parameters[1].labels = {{0, "air"}, {1, "plate"}, {2, "fuel"}};
    made.read = [plate, gap, type, lattice = made.info.lattice](int p, int, int time, volume::SliceRange slices) {
        Field field = volume::makeField(lattice, p == 0 ? type : ScalarType::U8);
        volume::Mask mask(field.count(), 1);
        std::size_t i = 0;
        for (int z = 0; z < lattice.size.z; ++z)
            for (int y = 0; y < lattice.size.y; ++y)
                for (int x = 0; x < lattice.size.x; ++x, ++i) {
                    const int above = y - 15 - time - x / 9;
                    const int region = above < 0 ? 0 : above < plate ? 1 : 2;
                    const double value = (region == 2 ? 300 - 0.9 * z : 0.7 * z) +
                                         3 * std::sin(0.06 * x + 0.04 * y) * std::cos(0.05 * z);
                    if (p == 1) field.as<std::uint8_t>()[i] = std::uint8_t(region);
                    if (p == 0 && type == ScalarType::F32) field.as<float>()[i] = float(value + 0.1 * time);
                    if (p == 0 && type == ScalarType::I32)
                        field.as<std::int32_t>()[i] = std::int32_t(std::rint(1e6 * (value + 0.1 * time)));
                    if (p == 0 && gap && region == 1) mask[i] = 0;
                }
        if (p == 0 && gap) field.mask = std::make_shared<const volume::Mask>(std::move(mask));
        return volume::slicesOf(field, slices);
    };
    return made;
}

PackOptions within(double bound, int brickSize = 16) {
    PackOptions options;
    options.lattice = StoredLattice::CC;
    options.maxError = bound;
    options.brickSize = brickSize;
    return options;
}

std::uint32_t featuresIn(const std::string& path) {
    const std::vector<char> bytes = readFile(path);
    return parseHeaders(std::as_bytes(std::span(bytes)), bytes.size(), path).header.features;
}

/// Bytes of the bricks of a parameter.
double bricksOf(const Archive& archive, int parameter) {
    double bytes = 0;
    for (std::size_t b = 0; b < archive.grid().brickCount(); ++b)
        bytes +=
            double(archive.brickBytes({archive.info().channelIndex(parameter, 0), 0, 0, archive.grid().indexOf(b)}));
    return bytes;
}

double furthest(const Field& is, const Field& was) {
    double apart = 0;
    for (std::size_t i = 0; i < was.count(); ++i) {
        EXPECT_EQ(is.present(i), was.present(i));
        if (was.present(i)) apart = std::max(apart, std::abs(is.value(i) - was.value(i)));
    }
    return apart;
}

void expectSecondReaderAgrees(const Archive& archive, const std::string& path) {
    const plain::Decoder decoder(readFile(path));
    for (int time = 0; time < int(archive.info().times.size()); ++time)
        for (int level = 0; level < archive.grid().levels; ++level)
            for (std::size_t number = 0; number < archive.grid().brickCount(); ++number) {
                const volume::BrickKey key{0, time, level, archive.grid().indexOf(number)};
                const plain::Brick brick = decoder.brick(std::size_t(time) * 2, int(number), level);
                const volume::BrickStats stats = archive.stats(key);
                const volume::BrickSamples labels = archive.read({1, time, 0, key.index});
                const bool meet = std::ranges::count(labels.values, labels.values[0]) < std::ssize(labels.values);
                if (level > 0 && meet) continue; // is made of level 0
                const volume::BrickSamples read = archive.read(key);
                for (std::size_t i = 0; i < brick.values.size(); ++i) {
                    ASSERT_EQ(brick.present[i], read.isPresent(i));
                    if (!brick.present[i]) continue;
                    auto value = float(brick.values[i]);
                    if (level > 0) value = std::clamp(value, stats.min, stats.max);
                    ASSERT_EQ(value, read.values[i]) << "level " << level << " at " << time;
                }
            }
}

TEST(Parted, TakeHalfTheBytesAndKeepTheBound) {
    const TemporaryFolder folder;
    for (const int plate : {1, 2, 3})
        for (const bool gap : {false, true})
            for (const double bound : {1e-2, 1e-3, 1e-4}) {
                volume::Dataset made = cell(plate, gap);
                pack(made, within(bound, 64), folder / "a.tsr");
                const Archive archive(folder / "a.tsr");
                EXPECT_NE(featuresIn(folder / "a.tsr") & kPartedFrames, 0u);
                EXPECT_LE(furthest(readField(archive, 0, 0, 0), made.read(0, 0, 0)),
                          bound * extentOf(archive.info().parameters[0]));
                EXPECT_EQ(readField(archive, 1, 0, 0).samples, made.read(1, 0, 0).samples);
                EXPECT_EQ(verifyArchive(archive).damaged, 0u);
                expectSecondReaderAgrees(archive, folder / "a.tsr");
                volume::Dataset together = cell(plate, gap);
                together.info.parameters[0].parts = {};
                pack(together, within(bound, 64), folder / "b.tsr");
                EXPECT_EQ(featuresIn(folder / "b.tsr") & kPartedFrames, 0u);
                // Gaps keep some of the jump from the transform, and fine bounds pay for much else.
                const double share = !gap && bound > 5e-4 ? 0.5 : 0.8;
                EXPECT_LE(bricksOf(archive, 0), share * bricksOf(Archive(folder / "b.tsr"), 0))
                    << plate << " " << bound;
            }
}

// Integers and bounds of the mean error, too; in several bricks, some of one part.
TEST(Parted, OfAnyNumbersAndBoundsAreReadAlike) {
    const TemporaryFolder folder;
    for (const ScalarType type : {ScalarType::F32, ScalarType::I32})
        for (const double psnr : {0., 60.}) {
            volume::Dataset made = cell(2, true, type);
            PackOptions options = within(psnr > 0 ? 0 : 1e-3, 8);
            options.psnr = psnr;
            pack(made, options, folder / "a.tsr");
            const Archive archive(folder / "a.tsr");
            EXPECT_NE(featuresIn(folder / "a.tsr") & kPartedFrames, 0u) << volume::name(type) << psnr;
            EXPECT_EQ(verifyArchive(archive).damaged, 0u);
            expectSecondReaderAgrees(archive, folder / "a.tsr");
            if (psnr == 0) {
                EXPECT_LE(furthest(readField(archive, 0, 0, 0), made.read(0, 0, 0)),
                          1e-3 * extentOf(archive.info().parameters[0]));
            }
            volume::Dataset parts = cell(2, true, type);
            pack(parts, options, folder / "slabs.tsr", {}, {}, 1);
            EXPECT_EQ(readFile(folder / "a.tsr"), readFile(folder / "slabs.tsr"));
        }
}

TEST(Parted, OfASeriesGrowAsIfWrittenAtOnce) {
    const TemporaryFolder folder;
    constexpr int kSteps = 4;
    volume::Dataset all = cell(2, false, ScalarType::F32, kSteps), begin = all, rest = all;
    PackOptions options = within(0);
    options.absError = 0.3;
    pack(all, options, folder / "whole.tsr");
    begin.info.times.resize(1);
    rest.info.times.erase(rest.info.times.begin());
    rest.read = [read = all.read](int p, int c, int time, volume::SliceRange slices) {
        return read(p, c, time + 1, slices);
    };
    pack(begin, options, folder / "grown.tsr");
    append(rest, folder / "grown.tsr");
    const Archive whole(folder / "whole.tsr"), grown(folder / "grown.tsr");
    EXPECT_NE(featuresIn(folder / "whole.tsr") & kPartedFrames, 0u);
    expectSecondReaderAgrees(whole, folder / "whole.tsr");
    for (int time = 0; time < kSteps; ++time) {
        EXPECT_LE(furthest(readField(whole, 0, 0, time), all.read(0, 0, time)), 0.3);
        EXPECT_EQ(readField(whole, 0, 0, time).samples, readField(grown, 0, 0, time).samples) << time;
    }
}

TEST(Parted, OfTheFuelCellTakeNoMore) {
    const TemporaryFolder folder;
    for (const double bound : {1e-2, 1e-3, 1e-4}) {
        volume::Dataset made = volume::makeFuelCell({{"times", 1}}), together = made;
        for (volume::Parameter& parameter : together.info.parameters) parameter.parts = {};
        pack(made, within(bound, 0), folder / "a.tsr");
        pack(together, within(bound, 0), folder / "b.tsr");
        const Archive a(folder / "a.tsr"), b(folder / "b.tsr");
        for (int p = 0; p < int(a.info().parameters.size()); ++p) {
            if (a.info().parameters[std::size_t(p)].parts.count() < 2) continue;
            EXPECT_LE(bricksOf(a, p), bricksOf(b, p) + 4) << a.info().parameters[std::size_t(p)].name << " " << bound;
            EXPECT_LE(furthest(readField(a, p, 0, 0), made.read(p, 0, 0)),
                      bound * extentOf(a.info().parameters[std::size_t(p)]));
        }
    }
}

TEST(Parted, AreRefusedWithoutTheirFlagOrTheirLabel) {
    const TemporaryFolder folder;
    const std::string path = folder / "a.tsr";
    volume::Dataset made = cell(2, false);
    pack(made, within(1e-3), path);
    const std::vector<char> chars = readFile(path);
    const auto bytes = std::as_bytes(std::span(chars));
    Header header = parseHeaders(bytes, bytes.size(), path).header;
    header.features &= ~kPartedFrames;
    writeFile(path, sealed(header, Bytes(bytes.begin(), bytes.end())));
    EXPECT_THROW(Archive{path}, Error);
    EXPECT_THROW(plain::Decoder(readFile(path)), std::runtime_error);
}

} // namespace
} // namespace tessera::codec
