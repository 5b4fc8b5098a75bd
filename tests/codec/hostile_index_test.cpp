#include "codec/archive/archive.h"
#include "codec/archive/archive_writer.h"
#include "codec/bytes/entropy.h"
#include "codec/bytes/lzma.h"
#include "codec/container/container.h"
#include "codec/container/index.h"
#include "tests/codec/make_dataset.h"
#include "tests/codec/plain/decoder.h"
#include "tests/codec/sealed_file.h"

#include <gtest/gtest.h>

/// Small files whose index decodes to much.
namespace tessera::codec {
namespace {

using namespace testing;
using volume::ScalarType;

void add(Bytes& out, std::span<const std::byte> bytes) {
    out.insert(out.end(), bytes.begin(), bytes.end());
}

/// A compact archive of as many times and pages, each of one frame of so many bricks without a byte.
std::vector<char> emptyBricks(std::size_t pages, int bricks) {
    Metadata metadata;
    metadata.info = makeDataset({4 * bricks, 4, 4}, {{"v", ScalarType::U8}}, 1).info;
    metadata.source = metadata.info.lattice;
    metadata.grid = {metadata.info.lattice, 4, 1, 0};
    metadata.program = "a test";
    Header header;
    header.features = kCompact;
    Bytes out(2 * kHeaderBytes);
    const Bytes text = serialise(metadata, header.features);
    header.metadata = {out.size(), text.size(), checksum(text)};
    add(out, text);
    for (std::size_t p = 0; p < pages; ++p) {
        IndexPage page;
        page.previousPage = header.index;
        page.times = {double(p)};
        if (p == 0) page.models = {{2 * kHeaderBytes, 0, checksum({})}};
        FrameRecord& frame = page.frames.emplace_back();
        frame.time = std::uint32_t(p);
        frame.offset = 2 * kHeaderBytes;
        frame.codeBits = 8;
        frame.model = 0;
        frame.bricks.resize(std::size_t(bricks));
        frame.segments.resize(std::size_t(bricks));
        const Bytes records = serialise(page, header.features), coded = encodeLzma(records, 0);
        Bytes piece; // as LZMA, however long
        appendLength(piece, std::uint32_t(records.size()));
        add(piece, coded);
        header.index = {out.size(), piece.size(), checksum(piece)};
        add(out, piece);
    }
    return sealed(header, std::move(out));
}

bool opens(const TemporaryFolder& folder, const std::vector<char>& bytes) {
    writeFile(folder / "forged.tsr", bytes);
    bool plainOpens = true, isOpen = true;
    try {
        const plain::Decoder decoder(bytes);
    } catch (const std::runtime_error&) {
        plainOpens = false;
    }
    try {
        const Archive archive(folder / "forged.tsr");
    } catch (const Error& error) {
        EXPECT_FALSE(error.place().empty());
        isOpen = false;
    }
    EXPECT_EQ(isOpen, plainOpens);
    return isOpen;
}

TEST(HostileIndex, APageThatDecodesToMoreThanOneMayIsRefused) {
    const TemporaryFolder folder;
    EXPECT_TRUE(opens(folder, emptyBricks(1, 3200))); // 64,228 bytes
    EXPECT_FALSE(opens(folder, emptyBricks(1, 3300)));
    EXPECT_FALSE(opens(folder, emptyBricks(1, 500000)));
}

TEST(HostileIndex, PagesThatTogetherDecodeToMoreThanTheyMayAreRefused) {
    const TemporaryFolder folder;
    EXPECT_TRUE(opens(folder, emptyBricks(40, 3200)));
    EXPECT_FALSE(opens(folder, emptyBricks(90, 3200)));
}

// Empty times may be appended for ever.
TEST(HostileIndex, TheWriterKeepsWithinWhatReadersTake) {
    const TemporaryFolder folder;
    constexpr int kBricks = 1800;
    std::size_t pages = 120;
    while (opens(folder, emptyBricks(pages + 1, kBricks))) ++pages;
    EXPECT_LT(pages, 140u);
    writeFile(folder / "forged.tsr", emptyBricks(pages, kBricks));
    for (int more = 0; more < 5; ++more) {
        const Archive archive(folder / "forged.tsr");
        Metadata metadata = archive.metadata();
        metadata.info.times.push_back(metadata.info.times.back() + 1);
        volume::Field nothing = volume::makeField(metadata.info.lattice, ScalarType::U8);
        nothing.mask = std::make_shared<const volume::Mask>(nothing.count(), std::uint8_t(0));
        ArchiveWriter writer(archive, metadata, false);
        writer.addFrame(0, 0, int(metadata.info.times.size()) - 1, std::move(nothing), {});
        writer.finish(metadata);
        EXPECT_TRUE(opens(folder, readFile(folder / "forged.tsr"))) << more;
    }
    EXPECT_EQ(Archive(folder / "forged.tsr").info().times.size(), pages + 5);
}

} // namespace
} // namespace tessera::codec
