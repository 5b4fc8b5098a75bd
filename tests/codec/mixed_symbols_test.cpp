#include "codec/bytes/mixed_symbols.h"

#include "codec/blocks/pack_blocks.h"

#include "codec/archive/archive.h"
#include "codec/archive/archive_state.h"
#include "codec/brick/whole_brick.h"
#include "codec/pack/pack.h"
#include "tests/codec/make_dataset.h"
#include "tests/codec/plain_labels.h"
#include "tests/codec/sealed_file.h"

#include <algorithm>
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::ScalarType;

/// A smooth brick below `colours`, with some noise and a mirrored upper half.
std::vector<std::uint8_t> symbolsOf(const MixedShape& shape, int colours) {
    std::mt19937 random(7);
    std::vector<std::uint8_t> symbols;
    const auto slice = std::size_t(shape.size.x) * std::size_t(shape.size.y);
    for (std::size_t i = 0; i < shape.count(); ++i) {
        const auto x = double(i % std::size_t(shape.size.x)), z = double(i / slice);
        const double smooth = (std::sin(0.3 * x) * std::cos(0.2 * z) + 1) / 2 * (colours - 1);
        symbols.push_back(std::uint8_t(random() % 16 == 0 ? random() % unsigned(colours) : unsigned(smooth)));
    }
    for (std::size_t i = 0; i < shape.count() / 2; ++i) symbols[shape.count() - 1 - i] = symbols[i];
    return symbols;
}

TEST(MixedBrick, ComesBackWhateverItsShapeAndNothingElseDoes) {
    for (const glm::ivec3 size : {glm::ivec3(1), {1, 1, 300}, {300, 1, 1}, {1, 40, 1}, {9, 8, 7}, {33, 30, 26}})
        for (const int sublattices : {1, 2})
            for (const int colours : {2, 3, 100, 256}) {
                SCOPED_TRACE(std::to_string(size.x) + " x " + std::to_string(size.y) + " x " + std::to_string(size.z) +
                             ", " + std::to_string(colours) + " of " + std::to_string(sublattices));
                const MixedShape shape{size, sublattices};
                const std::vector<std::uint8_t> symbols = symbolsOf(shape, colours);
                Bytes coded = encodeMixed(shape, colours, symbols);
                std::vector<std::uint8_t> out(symbols.size());
                ASSERT_EQ(decodeMixed(shape, colours, coded, out), DecodeStatus::Ok);
                ASSERT_EQ(out, symbols);
                for (std::size_t length = 0; length + kMostLeftOut < coded.size(); length += 1 + coded.size() / 20)
                    EXPECT_TRUE(decodeMixed(shape, colours, std::span(coded).first(length), out) != DecodeStatus::Ok ||
                                out != symbols);
                coded.resize(coded.size() + 9, std::byte{1});
                EXPECT_EQ(decodeMixed(shape, colours, coded, out), DecodeStatus::Trailing);
            }
}

TEST(MixedBrick, DamageNeverCrashes) {
    const MixedShape shape{{17, 16, 15}, 1};
    const std::vector<std::uint8_t> symbols = symbolsOf(shape, 200);
    const Bytes coded = encodeMixed(shape, 200, symbols);
    std::mt19937 random(3);
    std::vector<std::uint8_t> out(symbols.size());
    for (int trial = 0; trial < 300; ++trial) {
        Bytes damaged = coded;
        for (int i = 0; i < 1 + trial % 3; ++i) damaged[random() % damaged.size()] = std::byte(random());
        if (decodeMixed(shape, 200, damaged, out) != DecodeStatus::Ok) continue;
        EXPECT_TRUE(std::ranges::all_of(out, [](std::uint8_t symbol) { return symbol < 200; }));
    }
    for (const std::byte filler : {std::byte{0}, std::byte{0xff}, std::byte{0x55}})
        (void)decodeMixed(shape, 200, Bytes(5000, filler), out);
}

TEST(MixedBrick, IsRefusedWhereItIsNotAllowed) {
    const MixedShape shape{{20, 20, 20}, 1};
    std::vector<std::uint32_t> codes;
    for (const std::uint8_t symbol : symbolsOf(shape, 50)) codes.push_back(1000u - 7u * symbol);
    Compressor compressor(kMostZstdLevel, true);
    const Bytes coded = encodeWholeMixed(codes, shape, compressor);
    ASSERT_TRUE(!coded.empty() && isWhole(coded[0]) && isMixed(coded[0]));
    std::vector<std::uint32_t> out(codes.size());
    ASSERT_EQ(decodeWhole(coded, out, shape), DecodeStatus::Ok);
    EXPECT_EQ(out, codes);
    EXPECT_EQ(decodeWhole(coded, out), DecodeStatus::BadMode);
    EXPECT_EQ(decodeWhole(coded, out, MixedShape{{20, 20, 21}, 1}), DecodeStatus::BadMode);
    for (std::size_t length = 1; length < 10; ++length)
        EXPECT_NE(decodeWhole(std::span(coded).first(length), out, shape), DecodeStatus::Ok);
    // One colour needs no index.
    const Bytes single{coded[0], std::byte{0}, std::byte{1}, std::byte{4}, std::byte{0}, std::byte{0}, std::byte{0}};
    EXPECT_EQ(decodeWhole(single, out, shape), DecodeStatus::BadMode);
    EXPECT_TRUE(encodeWholeMixed(std::vector<std::uint32_t>(8000, 5), shape, compressor).empty());
    std::vector<std::uint32_t> many(codes.size());
    for (std::size_t i = 0; i < many.size(); ++i) many[i] = std::uint32_t(i % 257);
    EXPECT_TRUE(encodeWholeMixed(many, shape, compressor).empty());
    const MixedShape large{{128, 128, 33}, 1};
    std::vector<std::uint32_t> all(large.count());
    for (std::size_t i = 0; i < all.size(); i += 5) all[i] = 1;
    EXPECT_TRUE(encodeWholeMixed(all, large, compressor).empty());
    EXPECT_EQ(decodeWhole(coded, all, large), DecodeStatus::BadMode);
}

/// A smooth volume whose upper half mirrors the lower one.
volume::Dataset mirrored(glm::ivec3 size, ScalarType type, int times, bool masked = false) {
    volume::Dataset made = makeDataset(size, {{"a", type, 1, Texture::Smooth, masked, false}}, times);
    const auto read = made.read;
    made.read = [read, size](int parameter, int component, int time) {
        volume::Field field = read(parameter, component, time);
        const std::size_t slice = field.samples.size() / std::size_t(size.z);
        for (std::size_t z = 0; z < std::size_t(size.z) / 2; ++z)
            std::copy_n(field.samples.begin() + std::ptrdiff_t(z * slice), slice,
                        field.samples.end() - std::ptrdiff_t((z + 1) * slice));
        return field;
    };
    return made;
}

bool declaresMixed(const Archive& archive) {
    return (stateOf(archive, false).header.features & kMixedBricks) != 0;
}

TEST(MixedBrick, BothReadersAgreeAtEveryLevel) {
    const TemporaryFolder folder;
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC})
        for (const int brickSize : {0, 16}) {
            volume::Dataset made = mirrored({38, 33, 30}, ScalarType::U8, 1);
            PackOptions options;
            options.lattice = lattice;
            options.brickSize = brickSize;
            pack(made, options, folder / "a.tsr");
            const Archive archive(folder / "a.tsr");
            ASSERT_TRUE(declaresMixed(archive));
            EXPECT_EQ(verifyArchive(archive).damaged, 0u);
            if (lattice == StoredLattice::CC) {
                EXPECT_EQ(readField(archive, 0, 0, 0).samples, made.read(0, 0, 0).samples);
            }
            const plain::Decoder decoder(readFile(folder / "a.tsr"));
            const glm::ivec3 count = archive.grid().count();
            for (int level = 0; level < decoder.levels(); ++level)
                for (int number = 0; number < count.x * count.y * count.z; ++number) {
                    const glm::ivec3 index{number % count.x, number / count.x % count.y, number / (count.x * count.y)};
                    const volume::BrickKey key{0, 0, level, index};
                    const volume::BrickSamples expected = archive.read(key);
                    const volume::BrickStats stats = archive.stats(key);
                    const plain::Brick brick = plainBrick(decoder, archive, key, 0, number);
                    ASSERT_EQ(brick.values.size(), expected.values.size());
                    for (std::size_t i = 0; i < brick.values.size(); ++i)
                        ASSERT_EQ(std::clamp(float(brick.values[i]), stats.min, stats.max), expected.values[i]);
                }
        }
}

TEST(MixedBrick, SeriesMasksAndManyValuesAreNotMixed) {
    const TemporaryFolder folder;
    const glm::ivec3 size{30, 29, 28};
    PackOptions options;
    options.lattice = StoredLattice::CC;
    const auto packed = [&](volume::Dataset made) {
        pack(made, options, folder / "a.tsr");
        return declaresMixed(Archive(folder / "a.tsr"));
    };
    EXPECT_TRUE(packed(mirrored(size, ScalarType::U8, 1)));
    EXPECT_TRUE(packed(mirrored(size, ScalarType::I16, 1)));
    EXPECT_FALSE(packed(mirrored(size, ScalarType::U8, 2)));
    EXPECT_FALSE(packed(mirrored(size, ScalarType::U8, 1, true)));
    EXPECT_FALSE(packed(mirrored(size, ScalarType::F32, 1)));
    EXPECT_FALSE(packed(makeDataset(size, {{"a", ScalarType::I32, 1, Texture::Nasty, false, false}}, 1)));
    const auto inBlocks = [&](int times, std::size_t ofBlock) {
        packInBlocks(mirrored(size, ScalarType::U8, times), options, folder / "b.tsr", {ofBlock, {}});
        return declaresMixed(Archive(folder / "b.tsr"));
    };
    EXPECT_TRUE(inBlocks(1, 1));
    EXPECT_FALSE(inBlocks(3, 1)) << "a block of one time is not a single time";
    EXPECT_FALSE(inBlocks(3, 2));
    options.levels = 1;
    EXPECT_FALSE(packed(mirrored(size, ScalarType::U8, 1)));
}

TEST(MixedBrick, AnArchiveThatDoesNotDeclareThemIsRefused) {
    const TemporaryFolder folder;
    volume::Dataset made = mirrored({30, 29, 28}, ScalarType::U8, 1);
    PackOptions options;
    options.lattice = StoredLattice::CC;
    pack(made, options, folder / "a.tsr");
    Header header = stateOf(Archive(folder / "a.tsr"), false).header;
    ASSERT_NE(header.features & kMixedBricks, 0u);
    header.features &= ~kMixedBricks;
    const std::vector<char> packed = readFile(folder / "a.tsr");
    const auto* const data = reinterpret_cast<const std::byte*>(packed.data());
    const std::vector<char> bytes = sealed(header, Bytes(data, data + packed.size()));
    writeFile(folder / "b.tsr", bytes);
    const Archive archive(folder / "b.tsr");
    EXPECT_THROW((void)readField(archive, 0, 0, 0), Error);
}

} // namespace
} // namespace tessera::codec
