#include "codec/archive/archive.h"
#include "codec/container/container.h"
#include "codec/pack/pack.h"
#include "tests/codec/make_dataset.h"

#include <cstring>
#include <gtest/gtest.h>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::ScalarType;

/// A small archive with everything in it: masks, labels, vectors, exact samples, two times, several bricks.
std::vector<char> smallArchive(const TemporaryFolder& folder, double maxError) {
    const std::vector<MadeParameter> parameters{{"O2", ScalarType::F32, 1, Texture::Smooth, true, false},
                                                {"U", ScalarType::F32, 2, Texture::Nasty, false, false},
                                                {"T", ScalarType::F32, 1, Texture::Decimals, false, false},
                                                {"region", ScalarType::U8, 1, Texture::Noise, false, true}};
    volume::Dataset made = makeDataset({7, 5, 9}, parameters, 2);
    PackOptions options;
    options.brickSize = 4;
    options.maxError = maxError;
    pack(made, options, folder / "small.tsr");
    return readFile(folder / "small.tsr");
}

/// What became of an archive with damage in it.
enum class Outcome { RefusedAtOpen, DamageReported, Unnoticed };

Outcome outcome(const std::string& path) {
    try {
        const Archive archive(path);
        if (verifyArchive(archive).damaged == 0) return Outcome::Unnoticed;
        return Outcome::DamageReported;
    } catch (const Error& error) {
        EXPECT_EQ(error.file(), path);
        EXPECT_FALSE(error.place().empty());
        return Outcome::RefusedAtOpen;
    }
}

TEST(Hostile, EveryFlippedByteIsNoticed) {
    const TemporaryFolder folder;
    std::vector<char> bytes = smallArchive(folder, 0);
    const std::string path = folder / "flipped.tsr";
    for (std::size_t i = 0; i < bytes.size(); i += i < 400 || i + 400 > bytes.size() ? 1 : 3) {
        for (const char flip : {char(0x01), char(0x80)}) {
            bytes[i] = char(bytes[i] ^ flip);
            writeFile(path, bytes);
            const Outcome found = outcome(path);
            EXPECT_NE(found, Outcome::Unnoticed) << "byte " << i << " of " << bytes.size();
            // One of the two headers is enough to read by.
            EXPECT_TRUE(i >= 2 * kHeaderBytes || found == Outcome::DamageReported) << "byte " << i;
            bytes[i] = char(bytes[i] ^ flip);
            if (i >= 400 && i + 400 <= bytes.size()) break;
        }
    }
    writeFile(path, bytes);
    EXPECT_EQ(outcome(path), Outcome::Unnoticed);
}

TEST(Hostile, EveryTruncationIsRefused) {
    const TemporaryFolder folder;
    const std::vector<char> bytes = smallArchive(folder, 0);
    const std::string path = folder / "cut.tsr";
    for (std::size_t length = 0; length < bytes.size(); length += length < 200 || length + 200 > bytes.size() ? 1 : 7) {
        writeFile(path, {bytes.begin(), bytes.begin() + std::ptrdiff_t(length)});
        EXPECT_EQ(outcome(path), Outcome::RefusedAtOpen) << length;
    }
    std::vector<char> longer = bytes;
    longer.push_back(0);
    writeFile(path, longer); // an append that was not finished
    EXPECT_EQ(outcome(path), Outcome::Unnoticed);
}

TEST(Hostile, DamagedBricksAreErrorsAndTheOthersStayReadable) {
    const TemporaryFolder folder;
    std::vector<char> bytes = smallArchive(folder, 0);
    bytes[kHeaderBytes + bytes.size() / 4] ^= 0x10;
    writeFile(folder / "a.tsr", bytes);
    const Archive archive(folder / "a.tsr");
    int failed = 0, fine = 0;
    const glm::ivec3 count = archive.grid().count();
    for (int channel = 0; channel < int(archive.info().channels().size()); ++channel)
        for (int time = 0; time < 2; ++time)
            for (int z = 0; z < count.z; ++z)
                for (int y = 0; y < count.y; ++y)
                    for (int x = 0; x < count.x; ++x) try {
                            (void)archive.read({channel, time, 0, {x, y, z}});
                            ++fine;
                        } catch (const Error& error) {
                            ++failed;
                            EXPECT_NE(std::string(error.what()).find("checksum"), std::string::npos);
                        }
    EXPECT_GE(failed, 1);
    EXPECT_GT(fine, failed);
}

/// Writes header, metadata and index anew so that every checksum of them holds: what only a hostile writer can do.
std::vector<char> resealed(std::vector<char> bytes) {
    const auto read = [&](std::size_t at) {
        std::uint64_t value = 0;
        std::memcpy(&value, bytes.data() + at, 8);
        return value;
    };
    const auto seal = [&](std::size_t offsetAt, std::size_t sumAt) {
        const std::uint64_t offset = read(offsetAt), length = read(offsetAt + 8);
        if (offset > bytes.size() || length > bytes.size() - offset) return;
        const std::uint64_t sum = checksum(std::as_bytes(std::span(bytes)).subspan(offset, length));
        std::memcpy(bytes.data() + sumAt, &sum, 8);
    };
    seal(24, 40);
    seal(48, 64);
    const std::uint64_t sum = checksum(std::as_bytes(std::span(bytes)).first(kHeaderBytes - 8));
    std::memcpy(bytes.data() + kHeaderBytes - 8, &sum, 8);
    std::copy_n(bytes.begin(), kHeaderBytes, bytes.begin() + kHeaderBytes);
    return bytes;
}

/// Tries forgeries of an archive.
void forge(const TemporaryFolder& folder, const std::vector<char>& bytes) {
    const std::string path = folder / "forged.tsr";
    std::uint64_t metadataAt = 0, indexAt = 0;
    std::memcpy(&metadataAt, bytes.data() + 24, 8);
    std::memcpy(&indexAt, bytes.data() + 48, 8);
    std::mt19937 random(5);
    const auto attempt = [&](std::vector<char> changed) {
        writeFile(path, resealed(std::move(changed)));
        (void)outcome(path);
        try {
            const Archive archive(path);
            for (int level = 0; level < archive.grid().levels; ++level) (void)archive.read({0, 0, level, {0, 0, 0}});
            (void)readField(archive, 0, 0, 0);
        } catch (const Error&) { // the only allowed answer
        }
    };
    for (std::size_t i = 8; i < kHeaderBytes; ++i) {
        std::vector<char> changed = bytes;
        changed[i] = char(random());
        attempt(std::move(changed));
    }
    for (int trial = 0; trial < 600; ++trial) {
        std::vector<char> changed = bytes;
        const bool index = trial % 2 == 0;
        const std::size_t begin = index ? indexAt : metadataAt, end = index ? bytes.size() : indexAt;
        for (int flips = 1 + int(random() % 3); flips > 0; --flips)
            changed[begin + random() % (index ? std::min<std::size_t>(end - begin, 600) : end - begin)] =
                random() % 2 == 0 ? char(random()) : char(random() % 2 == 0 ? 0xff : '9');
        attempt(std::move(changed));
    }
}

TEST(Hostile, ForgedHeadersAndIndexesNeverCrash) {
    const TemporaryFolder folder;
    const std::vector<char> bytes = smallArchive(folder, 1e-3);
    forge(folder, bytes);
    // One that has grown, and one whose metadata and pages are not packed.
    volume::Dataset more = makeDataset({7, 5, 9}, {{"p", ScalarType::F32, 1, Texture::Smooth, true, false}}, 2);
    append(more, folder / "small.tsr");
    forge(folder, readFile(folder / "small.tsr"));
    const std::string corpus = TESSERA_SOURCE_DIR "/tests/fuzz/corpus/fuzz_archive/";
    for (const char* stored :
         {"bcc-bounded-3.tsr", "integers-3.tsr", "parted-3.tsr", "corrected-3.tsr", "numbers-3.tsr"})
        forge(folder, readFile(corpus + stored));
}

TEST(Hostile, OtherFilesAreRefusedWithAReason) {
    const TemporaryFolder folder;
    writeFile(folder / "empty.tsr", {});
    writeFile(folder / "text.tsr", std::vector<char>(500, 'x'));
    EXPECT_EQ(outcome(folder / "empty.tsr"), Outcome::RefusedAtOpen);
    EXPECT_EQ(outcome(folder / "text.tsr"), Outcome::RefusedAtOpen);
    EXPECT_THROW(Archive(folder / "missing.tsr"), Error);
    EXPECT_THROW(Archive(folder / "."), Error);
    for (const auto& [version, age] : {std::pair{4, "newer"}, std::pair{2, "early"}, std::pair{1, "early"}}) {
        std::vector<char> other = smallArchive(folder, 0);
        other[8] = char(version);
        writeFile(folder / "other.tsr", resealed(other));
        try {
            const Archive archive(folder / "other.tsr");
            FAIL() << "version " << version << " was read";
        } catch (const Error& error) {
            EXPECT_NE(error.reason().find(std::string(age) + " version of Tessera (archive version " +
                                          std::to_string(version)),
                      std::string::npos)
                << error.reason();
        }
    }
    std::vector<char> features = smallArchive(folder, 0);
    features[15] = 1; // of both copies
    writeFile(folder / "features.tsr", resealed(features));
    EXPECT_THROW(Archive(folder / "features.tsr"), Error);
}

TEST(Hostile, ContextsTheHeaderDoesNotNameAreRefused) {
    const TemporaryFolder folder;
    std::vector<char> bytes = smallArchive(folder, 0);
    bytes[12] = char(bytes[12] & ~char(kBandContexts));
    writeFile(folder / "bands.tsr", resealed(bytes));
    EXPECT_EQ(outcome(folder / "bands.tsr"), Outcome::DamageReported);
}

} // namespace
} // namespace tessera::codec
