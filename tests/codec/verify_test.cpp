#include "codec/archive/archive.h"
#include "codec/bytes/lzma.h"
#include "codec/container/container.h"
#include "codec/pack/pack.h"
#include "tests/codec/make_dataset.h"
#include "tests/codec/sealed_file.h"

#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::ScalarType;

VerifyReport verified(const TemporaryFolder& folder, const std::vector<char>& bytes) {
    writeFile(folder / "verified.tsr", bytes);
    return verifyArchive(Archive(folder / "verified.tsr"));
}

/// An archive of 4 x 1 x 1 bricks; every time has the same samples and gaps if it is still.
std::vector<char> rowOfBricks(const TemporaryFolder& folder, bool masked, int times, bool isStill) {
    volume::Dataset made = makeDataset({32, 8, 8}, {{"v", ScalarType::U16, 1, Texture::Noise, masked, false}}, times);
    made.read = [inner = made.read, isStill](int p, int c, int t) { return inner(p, c, isStill ? 0 : t); };
    PackOptions options;
    options.lattice = StoredLattice::CC;
    options.brickSize = 8;
    pack(made, options, folder / "row.tsr");
    return readFile(folder / "row.tsr");
}

TEST(Verify, CountsEveryByteOfModelsMasksAndBricks) {
    const TemporaryFolder folder;
    const std::vector<char> whole = rowOfBricks(folder, true, 1, true);
    std::uint64_t metadataAt = 0; // which follows them
    std::memcpy(&metadataAt, whole.data() + 24, 8);
    EXPECT_EQ(verified(folder, whole).bytes, metadataAt - 2 * kHeaderBytes);
}

/// The archive with its index changed, which is right in all but that.
template <class Change> std::vector<char> withIndex(const std::vector<char>& whole, const Change& change) {
    const auto* first = reinterpret_cast<const std::byte*>(whole.data());
    Bytes bytes(first, first + whole.size());
    Header header = parseHeaders(bytes, bytes.size(), "").header;
    EXPECT_EQ(header.index.offset + header.index.length, bytes.size());
    Bytes page;
    EXPECT_EQ(decodeBlock(std::span(bytes).subspan(header.index.offset), page), DecodeStatus::Ok);
    change(page);
    const Bytes piece = encodeBlock(page);
    bytes.resize(header.index.offset);
    bytes.insert(bytes.end(), piece.begin(), piece.end());
    header.index = {header.index.offset, piece.size(), checksum(piece)};
    return sealed(header, std::move(bytes));
}

TEST(Verify, StatisticsThatAreNotThoseOfTheSamplesAreDamage) {
    const TemporaryFolder folder;
    const std::vector<char> forged = withIndex(rowOfBricks(folder, false, 1, true), [](Bytes& page) {
        const float is = 99, isNot = 98; // the largest number of each brick
        std::byte pattern[sizeof is];
        std::memcpy(pattern, &is, sizeof is);
        const auto at = std::search(page.begin(), page.end(), std::begin(pattern), std::end(pattern));
        ASSERT_NE(at, page.end());
        std::memcpy(&*at, &isNot, sizeof isNot);
    });
    const VerifyReport report = verified(folder, forged);
    EXPECT_EQ(report.damage,
              std::vector<std::string>{
                  "v component 0 time 0 brick 0,0,0: index: its statistics differ from those of its samples"});
}

/// The last place in a page that holds a number, with another there.
void replaceLast(Bytes& page, float is, float isNot) {
    std::byte pattern[sizeof is];
    std::memcpy(pattern, &is, sizeof is);
    const auto at = std::find_end(page.begin(), page.end(), std::begin(pattern), std::end(pattern));
    ASSERT_NE(at, page.end());
    std::memcpy(&*at, &isNot, sizeof isNot);
}

TEST(Verify, ARangeThatIsNotThatOfTheSamplesIsDamage) {
    const TemporaryFolder folder;
    // Of one brick, which has no statistics.
    PackOptions options;
    options.lattice = StoredLattice::CC;
    volume::Dataset made = makeDataset({8, 8, 8}, {{"v", ScalarType::U16, 1, Texture::Noise, false, false}}, 1);
    pack(made, options, folder / "one.tsr");
    const std::vector<char> one = readFile(folder / "one.tsr");
    const volume::BrickStats is = Archive(folder / "one.tsr").stats({0, 0, 0, {0, 0, 0}});
    EXPECT_EQ(verified(folder, one).damaged, 0u);
    EXPECT_EQ(verified(folder, withIndex(one, [&](Bytes& page) { replaceLast(page, is.max, is.max - 1); })).damage,
              std::vector<std::string>{
                  "v component 0 time 0 brick 0,0,0: index: its range differs from that of its samples"});
    // Of a brick that repeats the one of the time before.
    const std::vector<char> still = rowOfBricks(folder, false, 2, true);
    EXPECT_EQ(verified(folder, still).damaged, 0u);
    EXPECT_EQ(verified(folder, withIndex(still, [](Bytes& page) { replaceLast(page, 99, 98); })).damage,
              std::vector<std::string>{
                  "v component 0 time 1 brick 3,0,0: index: its range differs from that of the brick it repeats"});
}

TEST(Verify, AStatedRangeThatLeavesOutSamplesIsDamage) {
    const TemporaryFolder folder;
    for (const bool honest : {true, false}) {
        volume::Dataset made = makeDataset({8, 8, 8}, {{"v", ScalarType::U16, 1, Texture::Noise, false, false}}, 1);
        made.info.parameters[0].ranges = {{0, honest ? 65535. : 50.}};
        PackOptions options;
        options.lattice = StoredLattice::CC;
        pack(made, options, folder / "stated.tsr");
        const VerifyReport report = verifyArchive(Archive(folder / "stated.tsr"));
        EXPECT_EQ(report.damage, honest ? std::vector<std::string>()
                                        : std::vector<std::string>{
                                              "metadata: the range of v component 0 leaves out some of its samples"});
        EXPECT_EQ(report.damagedBricks, 0u);
    }
}

TEST(Verify, AModelOutsideTheFileIsRefused) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset(
        {8, 8, 8}, {{"a", ScalarType::U8, 1, Texture::Noise}, {"b", ScalarType::I16, 1, Texture::Smooth}}, 1);
    PackOptions options;
    options.lattice = StoredLattice::CC;
    pack(made, options, folder / "two.tsr");
    constexpr std::size_t kHead = 64, kTime = 8, kModel = 24;
    for (const std::size_t model : {0, 1}) {
        const std::vector<char> forged = withIndex(readFile(folder / "two.tsr"), [&](Bytes& page) {
            const std::uint64_t beyond = std::uint64_t(1) << 40;
            std::memcpy(page.data() + kHead + kTime + model * kModel, &beyond, sizeof beyond);
        });
        try {
            verified(folder, forged);
            ADD_FAILURE() << model;
        } catch (const Error& error) {
            EXPECT_EQ(error.reason(), "a chunk lies outside the file") << model;
        }
    }
}

TEST(Verify, ADamagedHeaderIsNoDamagedBrick) {
    const TemporaryFolder folder;
    const std::vector<char> whole = rowOfBricks(folder, false, 1, true);
    EXPECT_EQ(verified(folder, whole).damaged, 0u);
    for (const std::size_t at : {std::size_t(20), kHeaderBytes + 20}) {
        std::vector<char> bytes = whole;
        bytes[at] ^= 1;
        const VerifyReport report = verified(folder, bytes);
        EXPECT_TRUE(report.damagedHeader);
        EXPECT_EQ(report.damaged, 1u);
        EXPECT_EQ(report.damagedBricks, 0u);
        EXPECT_EQ(report.bricks, 4u);
    }
}

// Whatever byte it is: places once each, and never more bricks than there are.
TEST(Verify, EveryDamagedPlaceIsCountedOnce) {
    const TemporaryFolder folder;
    for (const bool masked : {false, true})
        for (const bool isStill : {false, true}) {
            const std::vector<char> whole = rowOfBricks(folder, masked, 3, isStill);
            std::uint64_t metadataAt = 0;
            std::memcpy(&metadataAt, whole.data() + 24, 8);
            std::size_t most = 0, least = 12;
            for (std::size_t i = 2 * kHeaderBytes; i < metadataAt; i += 5) {
                std::vector<char> bytes = whole;
                bytes[i] ^= 4;
                const VerifyReport report = verified(folder, bytes);
                EXPECT_EQ(report.damaged, 1u) << i;
                EXPECT_EQ(report.damage.size(), 1u);
                EXPECT_FALSE(report.damagedHeader);
                EXPECT_EQ(report.bricks, 12u);
                EXPECT_LE(report.damagedBricks, 12u);
                EXPECT_EQ(report.damagedBricks == 12, report.samples == 0);
                // As many as a reader finds.
                const Archive archive(folder / "verified.tsr");
                std::uint64_t failed = 0;
                for (int t = 0; t < 3; ++t)
                    for (int x = 0; x < 4; ++x) try {
                            (void)archive.read({0, t, 0, {x, 0, 0}});
                        } catch (const Error&) {
                            ++failed;
                        }
                EXPECT_EQ(report.damagedBricks, failed) << i;
                most = std::max(most, std::size_t(report.damagedBricks));
                least = std::min(least, std::size_t(report.damagedBricks));
            }
            EXPECT_EQ(least, isStill ? 3u : 1u); // with those that repeat it
            EXPECT_GE(most, 3u);                 // a model, a mask
        }
}

TEST(Verify, BricksOfADamagedMaskAreLookedAtToo) {
    const TemporaryFolder folder;
    std::vector<char> bytes = rowOfBricks(folder, true, 1, true);
    // The mask comes first, and of a frame its first brick.
    std::uint64_t metadataAt = 0;
    std::memcpy(&metadataAt, bytes.data() + 24, 8);
    const VerifyReport whole = verified(folder, bytes);
    EXPECT_EQ(whole.damaged, 0u);
    for (std::size_t i = 2 * kHeaderBytes; i < metadataAt; ++i) bytes[i] ^= 4;
    const VerifyReport report = verified(folder, bytes);
    EXPECT_EQ(report.damagedBricks, 4u);
    EXPECT_EQ(report.samples, 0u);
    EXPECT_EQ(report.damaged, 4u + 1u + 4u); // masks, the model, bricks
}

} // namespace
} // namespace tessera::codec
