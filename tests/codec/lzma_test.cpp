#include "codec/bytes/lzma.h"

#include "codec/bands/rans_model.h"

#include <gtest/gtest.h>
#include <random>
#include <string>

namespace tessera::codec {
namespace {

/// Bytes of which some repeat what came before.
Bytes repetitive(std::size_t count, std::mt19937& random) {
    Bytes bytes;
    while (bytes.size() < count) {
        const std::size_t run = 1 + random() % 20;
        const std::size_t from = bytes.empty() ? 0 : random() % bytes.size();
        const bool again = !bytes.empty() && random() % 3 != 0;
        for (std::size_t i = 0; i < run; ++i)
            bytes.push_back(again ? bytes[from + i % (bytes.size() - from)]
                                  : std::byte(random() % 7 * 40 + random() % 3));
    }
    bytes.resize(count);
    return bytes;
}

TEST(Lzma, GivesBackWhatItWasGivenAndNothingElse) {
    std::mt19937 random(31);
    for (const std::size_t count : {1u, 2u, 17u, 1000u, 5000u})
        for (int bits = 0; bits <= kMostLiteralBits; ++bits) {
            const Bytes in = repetitive(count, random);
            Bytes coded = encodeLzma(in, bits);
            Bytes out(count);
            ASSERT_EQ(decodeLzma(coded, bits, out), DecodeStatus::Ok);
            EXPECT_EQ(out, in);
            EXPECT_EQ(decodeLzma(coded, kMostLiteralBits + 1, out), DecodeStatus::BadMode);
            for (std::size_t cut = 0; cut < coded.size(); cut += 1 + coded.size() / 50) {
                const Bytes shorter(coded.begin(), coded.begin() + std::ptrdiff_t(cut));
                EXPECT_NE(decodeLzma(shorter, bits, out), DecodeStatus::Ok) << cut << " of " << coded.size();
            }
            Bytes longer(count + 64);
            EXPECT_NE(decodeLzma(coded, bits, longer), DecodeStatus::Ok);
            coded.push_back(std::byte{0});
            EXPECT_NE(decodeLzma(coded, bits, out), DecodeStatus::Ok);
        }
}

TEST(Lzma, StreamsTakeItWhereItIsShorterAndAllowed) {
    std::vector<std::uint32_t> symbols;
    for (int i = 0; i < 2000; ++i)
        for (const char letter : std::to_string(i * i / 7) + ";") symbols.push_back(std::uint32_t(letter));
    Bytes plain, thorough, quick;
    Compressor most(kMostZstdLevel), lzma(kMostZstdLevel, true), little(3, true);
    encodeStream(symbols, most, plain);
    encodeStream(symbols, lzma, thorough);
    encodeStream(symbols, little, quick);
    EXPECT_LT(thorough.size(), plain.size());
    EXPECT_EQ(thorough[0], std::byte{7});
    EXPECT_EQ(plain[0], std::byte{3});
    EXPECT_EQ(quick[0], std::byte{3});
    std::vector<std::uint32_t> out(symbols.size());
    for (const Bytes* bytes : {&plain, &thorough, &quick}) {
        std::span<const std::byte> in = *bytes;
        ASSERT_EQ(decodeStream(in, out), DecodeStatus::Ok);
        EXPECT_TRUE(in.empty());
        EXPECT_EQ(out, symbols);
    }
    for (std::size_t cut = 0; cut < thorough.size(); cut += 31) {
        const Bytes shorter(thorough.begin(), thorough.begin() + std::ptrdiff_t(cut));
        std::span<const std::byte> in = shorter;
        EXPECT_NE(decodeStream(in, out), DecodeStatus::Ok) << cut;
    }
}

TEST(LzmaBlocks, ComeBackShortLongAndEmpty) {
    std::mt19937 random(33);
    for (const std::size_t count : {0u, 1u, 5u, 300u, 70000u}) {
        const Bytes in = repetitive(count, random);
        Bytes out;
        const Bytes coded = encodeBlock(in);
        ASSERT_EQ(decodeBlock(coded, out), DecodeStatus::Ok);
        EXPECT_EQ(out, in);
        EXPECT_LE(coded.size(), in.size() + 3);
    }
}

TEST(LzmaBlocks, GoOnFromTheDictionary) {
    const std::string text = R"("grid":{"brickSize":64,"levels":5,"phase":0.0},"lossless":true,"maxError":0.0)";
    const auto in = std::as_bytes(std::span(text));
    const Bytes coded = encodeBlock(in);
    EXPECT_LT(coded.size(), text.size() / 3);
    Bytes out;
    for (std::size_t cut = 0; cut < coded.size(); ++cut) {
        const Bytes shorter(coded.begin(), coded.begin() + std::ptrdiff_t(cut));
        EXPECT_NE(decodeBlock(shorter, out), DecodeStatus::Ok) << cut;
    }
    // A length that nothing so short can have, and one beyond all bounds.
    Bytes lie{std::byte{0xff}, std::byte{0xff}, std::byte{0x7f}, std::byte{0}, std::byte{1}};
    EXPECT_EQ(decodeBlock(lie, out), DecodeStatus::BadLength);
    // One that it could have, but no writer makes.
    for (const std::size_t count : {kLongBlock, kLongBlock + 1}) {
        const Bytes zeros(count), body = encodeLzma(zeros, 0); // no use of the dictionary
        lie.clear();
        appendLength(lie, std::uint32_t(count));
        lie.insert(lie.end(), body.begin(), body.end());
        EXPECT_EQ(decodeBlock(lie, out), count == kLongBlock ? DecodeStatus::Ok : DecodeStatus::BadLength);
    }
    lie = Bytes(6, std::byte{0xff});
    EXPECT_EQ(decodeBlock(lie, out), DecodeStatus::BadLength);
}

TEST(LzmaBlocks, AModelOfNoBytesIsThatOfNoTokens) {
    Model model;
    ASSERT_EQ(parseModel({}, 3, model), DecodeStatus::Ok);
    EXPECT_EQ(model, makeModel(Histogram(3, {}), 1));
    EXPECT_EQ(model.tables.size(), 1u);
    EXPECT_EQ(model.tables[0][0], 2048);
    EXPECT_EQ(model.tables[0][kEscape], 2048);
}

TEST(Streams, NumbersOfNoOrTooManyBytesAreRefused) {
    for (const std::size_t count : {3u, 3000u}) { // as they are, and compressed
        std::vector<std::uint32_t> symbols(count);
        for (std::size_t i = 0; i < count; ++i) symbols[i] = std::uint32_t(i * i % 251);
        Compressor compressor(3);
        Bytes coded;
        encodeStream(symbols, compressor, coded);
        ASSERT_EQ(std::to_integer<int>(coded[1]), 1) << "bytes of each";
        for (const int width : {0, 5, 255}) {
            coded[1] = static_cast<std::byte>(width);
            std::span<const std::byte> in(coded);
            EXPECT_EQ(decodeStream(in, symbols), DecodeStatus::BadLength) << width;
        }
    }
}

} // namespace
} // namespace tessera::codec
