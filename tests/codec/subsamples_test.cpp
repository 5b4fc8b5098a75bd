#include "codec/brick/subsamples.h"

#include "codec/archive/archive.h"
#include "codec/archive/brick_access.h"
#include "codec/bytes/lzma.h"
#include "codec/container/index.h"
#include "codec/pack/pack.h"
#include "codec/remote/remote_file.h"
#include "tests/codec/make_dataset.h"
#include "tests/codec/plain/decoder.h"
#include "tests/codec/sealed_file.h"
#include "tests/volume/regions.h"

#include <bit>
#include <cstring>
#include <gtest/gtest.h>
#include <random>

/// The coarsest level of bricks in which parts meet: samples of level 0, read without its bytes.
namespace tessera::codec {
namespace {

using namespace testing;
using volume::BrickKey;
using volume::BrickSamples;
using volume::Dataset;

/// Two regions with gaps; at the last time everything is as at the one before.
Dataset regionsWithGaps(int times) {
    volume::test::TwoRegions regions;
    regions.place = 11;
    regions.speed = 1;
    Dataset made =
        volume::test::twoRegions(volume::test::ccLattice({33, 20, 24}), volume::test::linearIn, regions, times);
    made.read = [read = made.read, times](int p, int c, int t) {
        volume::Field field = read(p, c, std::min(t, times - 2));
        if (p != 0) return field;
        std::mt19937 random(3);
        volume::Mask mask(field.count());
        for (std::uint8_t& flag : mask) flag = random() % 5 != 0 ? 1 : 0;
        field.mask = std::make_shared<const volume::Mask>(std::move(mask));
        return field;
    };
    return made;
}

PackOptions bricksOf16(StoredLattice lattice, double maxError) {
    PackOptions options;
    options.lattice = lattice;
    options.brickSize = 16;
    options.maxError = maxError;
    return options;
}

/// What the index says of a file.
struct OpenIndex {
    std::unique_ptr<FileBytes> bytes;
    Header header;
    Index index;

    OpenIndex(const std::string& path, const Archive& archive) : bytes(openBytes(path, {})) {
        header = parseHeaders(bytes->part({0, kFirstChunk}).bytes(), bytes->size(), path).header;
        const auto components = std::uint64_t(componentCount(archive.info()));
        index =
            readIndex(*bytes, header,
                      {components, archive.grid().brickCount(), archive.grid(), archive.metadata().corrections}, path);
    }
};

void expectSamplesOfLevelZero(const volume::BrickSamples& coarse, const volume::BrickSamples& fine, int sublattices,
                              int step) {
    std::size_t at = 0;
    for (int z = 0; z < coarse.size.z; ++z)
        for (int y = 0; y < coarse.size.y; ++y)
            for (int x = 0; x < coarse.size.x; ++x, ++at) {
                const int slice = z / sublattices * step * sublattices + z % sublattices;
                const std::size_t from =
                    (std::size_t(slice) * std::size_t(fine.size.y) + std::size_t(y * step)) * std::size_t(fine.size.x) +
                    std::size_t(x * step);
                ASSERT_EQ(coarse.isPresent(at), fine.isPresent(from));
                if (coarse.isPresent(at)) {
                    ASSERT_EQ(coarse.values[at], fine.values[from]);
                }
            }
    ASSERT_EQ(at, coarse.values.size());
}

TEST(Subsamples, CoarsestPartsAndLabelsAreSamplesOfLevelZero) {
    const TemporaryFolder folder;
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC, StoredLattice::D4})
        for (const double maxError : {0.0, 1e-3}) {
            SCOPED_TRACE(std::string(kStoredLatticeNames[std::size_t(lattice)]) + " " + std::to_string(maxError));
            Dataset made = regionsWithGaps(lattice == StoredLattice::D4 ? 8 : 3);
            pack(made, bricksOf16(lattice, maxError), folder / "a.tsr");
            EXPECT_EQ(readFile(folder / "a.tsr")[12] & 32, 32) << "features of the header";
            const Archive archive(folder / "a.tsr");
            EXPECT_EQ(verifyArchive(archive).damaged, 0u);
            const int last = archive.grid().levels - 1;
            std::size_t met = 0, changed = 0, repeated = 0;
            for (int t = 0; t < int(archive.info().times.size()); ++t)
                for (std::size_t b = 0; b < archive.grid().brickCount(); ++b) {
                    const glm::ivec3 at = archive.grid().indexOf(b);
                    const volume::BrickStats label = archive.stats({1, t, last, at});
                    if (label.min == label.max) continue;
                    ++met;
                    for (const int channel : {0, 1})
                        expectSamplesOfLevelZero(archive.read({channel, t, last, at}),
                                                 archive.read({channel, t, 0, at}),
                                                 lattice == StoredLattice::BCC ? 2 : 1, 1 << last);
                    if (t > 0) ++(archive.repeats({0, t, 0, at}) == 0 ? changed : repeated);
                }
            EXPECT_GT(met, 2u);
            EXPECT_GT(changed, 0u);
            EXPECT_TRUE(repeated > 1 || lattice == StoredLattice::D4);
        }
}

// What is shown first of large data, and what other machines are asked for.
TEST(Subsamples, NeedNoBytesOfFinerLevels) {
    const TemporaryFolder folder;
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC}) {
        Dataset made = regionsWithGaps(2);
        pack(made, bricksOf16(lattice, 0), folder / "a.tsr");
        const Archive whole(folder / "a.tsr");
        std::vector<char> bytes = readFile(folder / "a.tsr");
        const OpenIndex file(folder / "a.tsr", whole);
        for (const FrameRecord& frame : file.index.frames)
            for (std::size_t s = whole.grid().brickCount(); s < frame.segments.size(); ++s)
                std::fill_n(bytes.begin() + std::ptrdiff_t(frame.segments[s].offset), frame.segments[s].length, 'x');
        writeFile(folder / "b.tsr", bytes);
        const Archive damaged(folder / "b.tsr");
        const int last = whole.grid().levels - 1;
        for (std::size_t b = 0; b < whole.grid().brickCount(); ++b)
            for (const int channel : {0, 1}) {
                const BrickKey key{channel, 0, last, whole.grid().indexOf(b)};
                const BrickSamples expected = whole.read(key), found = damaged.read(key);
                EXPECT_EQ(found.values, expected.values);
                EXPECT_EQ(found.present, expected.present);
            }
        EXPECT_THROW((void)damaged.read({0, 0, 0, {0, 0, 0}}), Error);
    }
}

TEST(Subsamples, AreReadByTheSecondDecoder) {
    const TemporaryFolder folder;
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC, StoredLattice::D4})
        for (const double maxError : {0.0, 1e-3}) {
            Dataset made = regionsWithGaps(lattice == StoredLattice::D4 ? 8 : 3);
            pack(made, bricksOf16(lattice, maxError), folder / "a.tsr");
            const Archive archive(folder / "a.tsr");
            const plain::Decoder decoder(readFile(folder / "a.tsr"));
            const int last = archive.grid().levels - 1;
            for (std::size_t frame = 0; frame < decoder.frames(); ++frame)
                for (std::size_t b = 0; b < archive.grid().brickCount(); ++b) {
                    const plain::Brick fine = decoder.brick(frame, int(b), 0),
                                       coarse = decoder.brick(frame, int(b), last);
                    ASSERT_EQ(coarse.subsamples, fine.subsamples);
                    BrickFormat shape;
                    shape.kind = archive.grid().lattice.kind;
                    shape.size = {fine.size[0], fine.size[1], fine.size[2]};
                    shape.levels = archive.grid().levels;
                    std::size_t next = 0;
                    forLevel(shape, last, [&](std::size_t at) {
                        if (!fine.present[at]) return;
                        ASSERT_LT(next, coarse.subsamples.size());
                        ASSERT_EQ(coarse.subsamples[next++], fine.bits[at]);
                    });
                    ASSERT_EQ(next, coarse.subsamples.size());
                }
        }
}

TEST(Subsamples, OtherParametersAndSingleBricksHaveNone) {
    const TemporaryFolder folder;
    Dataset plainData = makeDataset({40, 40, 40}, {{"a", volume::ScalarType::U8, 1, Texture::Smooth, true, false}}, 1);
    pack(plainData, bricksOf16(StoredLattice::CC, 0), folder / "a.tsr");
    EXPECT_EQ(readFile(folder / "a.tsr")[12] & 32, 0);
    Dataset small = volume::test::twoRegions(volume::test::ccLattice({9, 9, 9}), volume::test::linearIn);
    pack(small, bricksOf16(StoredLattice::CC, 0), folder / "b.tsr");
    EXPECT_EQ(readFile(folder / "b.tsr")[12] & 32, 0);
}

TEST(Subsamples, ThatAreNotThoseOfLevelZeroAreDamage) {
    const TemporaryFolder folder;
    volume::test::TwoRegions regions;
    regions.place = 22; // of the first brick one, of no other alone
    Dataset made = volume::test::twoRegions(volume::test::ccLattice({40, 20, 16}), volume::test::constantIn, regions);
    pack(made, bricksOf16(StoredLattice::CC, 0), folder / "a.tsr");
    const OpenIndex file(folder / "a.tsr", Archive(folder / "a.tsr"));
    const std::vector<char> chars = readFile(folder / "a.tsr");
    const auto* first = reinterpret_cast<const std::byte*>(chars.data());
    Bytes bytes(first, first + chars.size());
    const Segment& segment = file.index.frames[0].segments[0];
    ASSERT_EQ(bytes[segment.offset], std::byte{1}); // all are one number, which follows
    bytes[segment.offset + 2] ^= std::byte{1};
    const std::uint64_t was = segment.checksum, is = checksum(std::span(bytes).subspan(segment.offset, segment.length));
    Bytes page;
    ASSERT_EQ(decodeBlock(std::span(bytes).subspan(file.header.index.offset), page), DecodeStatus::Ok);
    std::byte pattern[sizeof was];
    std::memcpy(pattern, &was, sizeof was);
    const auto at = std::search(page.begin(), page.end(), std::begin(pattern), std::end(pattern));
    ASSERT_NE(at, page.end());
    std::memcpy(&*at, &is, sizeof is);
    const Bytes block = encodeBlock(page);
    bytes.resize(file.header.index.offset);
    bytes.insert(bytes.end(), block.begin(), block.end());
    Header header = file.header;
    header.index = {header.index.offset, block.size(), checksum(block)};
    writeFile(folder / "b.tsr", sealed(header, std::move(bytes)));
    EXPECT_EQ(verifyArchive(Archive(folder / "b.tsr")).damage,
              std::vector<std::string>{
                  "v component 0 time 0 brick 0,0,0: index: its coarsest samples differ from those of level 0"});
}

} // namespace
} // namespace tessera::codec
