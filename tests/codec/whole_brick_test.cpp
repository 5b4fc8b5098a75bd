#include "codec/whole_brick.h"

#include "codec/brick_codec.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace tessera::codec {
namespace {

std::vector<std::uint32_t> decoded(const Bytes& bytes, std::size_t count, DecodeStatus wanted = DecodeStatus::Ok) {
    std::vector<std::uint32_t> codes(count);
    EXPECT_EQ(decodeWhole(bytes, codes), wanted);
    return codes;
}

TEST(WholeBrick, AnyNumberOfDistinctCodesComesBack) {
    std::mt19937 random(21);
    Compressor compressor(3);
    for (const int distinct : {1, 2, 3, 16, 255, 256, 257, 1000})
        for (const std::size_t count : {0u, 1u, 7u, 5000u}) {
            SCOPED_TRACE(std::to_string(distinct) + " of " + std::to_string(count));
            std::vector<std::uint32_t> colours(static_cast<std::size_t>(distinct)), codes(count);
            for (std::uint32_t& colour : colours) colour = std::uint32_t(random());
            for (std::size_t i = 0; i < count; ++i)
                codes[i] = colours[i < colours.size() ? i : random() % colours.size()];
            const Bytes bytes = encodeWhole(codes, compressor);
            ASSERT_TRUE(isWhole(bytes[0]));
            EXPECT_EQ(decoded(bytes, count), codes);
        }
}

TEST(WholeBrick, FewWideCodesCostTheirIndices) {
    std::mt19937 random(22);
    Compressor compressor(3);
    const std::uint32_t colours[] = {0u, 0xdeadbeefu, 0x7fffffffu, 0x80000000u};
    std::vector<std::uint32_t> codes(20000);
    for (std::uint32_t& code : codes) code = colours[random() % 4];
    EXPECT_LE(double(encodeWhole(codes, compressor).size()), double(codes.size()) * 3 / 8);
}

TEST(WholeBrick, APaletteWithFewGapsIsWrittenWithoutAny) {
    // Steps that are all alike cost next to nothing, whichever colours are not used.
    std::vector<std::uint32_t> codes, gaps;
    for (std::uint32_t i = 0; i < 20000; ++i) codes.push_back(100 + i % 200);
    for (const std::uint32_t code : codes) gaps.push_back(code % 7 == 3 ? code + 1 : code);
    Compressor compressor(3);
    const Bytes bytes = encodeWhole(gaps, compressor);
    EXPECT_EQ(bytes[0], std::byte{6});
    EXPECT_GE(int(bytes[1]) + 1, 199);
    EXPECT_EQ(decoded(bytes, gaps.size()), gaps);
}

TEST(WholeBrick, RefusesAnIndexBeyondThePalette) {
    // Two colours, 5 and 6; then four indices as they are.
    const auto bytes = [](std::uint8_t last) {
        Bytes out;
        for (const int byte : {6, 1, 2, 1, 10, 1, 2, 1, 0, 1, 1, int(last)}) out.push_back(std::byte(byte));
        return out;
    };
    EXPECT_EQ(decoded(bytes(0), 4), (std::vector<std::uint32_t>{5, 6, 6, 5}));
    (void)decoded(bytes(2), 4, DecodeStatus::BadData);
    Bytes cut = bytes(0);
    for (std::size_t length = 1; length < cut.size(); ++length) {
        std::vector<std::uint32_t> codes(4);
        EXPECT_NE(decodeWhole(std::span(cut).first(length), codes), DecodeStatus::Ok) << length;
    }
}

TEST(WholeBrick, ASparseVolumeIsCodedAsOne) {
    BrickFormat format{volume::LatticeKind::CC, {32, 32, 32}, 4, Wavelet::W22, volume::ScalarType::U8, {}, false, 8};
    Bytes samples(countOf(format.size));
    for (std::size_t i = 0; i < samples.size(); i += 97) samples[i] = std::byte(1 + i % 3);
    Compressor compressor(3);
    Histogram histogram(format.levels, {});
    SplitMemory memory;
    countBrick(prepareBrick(format, samples, {}, 0, {}, memory), histogram);
    const Model model = makeModel(histogram, 16);
    const std::vector<Bytes> segments = encodeBrick(format, samples, {}, 0, compressor, BandEncoder(model));
    ASSERT_FALSE(segments[0].empty());
    EXPECT_TRUE(isWhole(segments[0][0]));
    for (int level = 0; level < format.levels; ++level) {
        std::vector<std::span<const std::byte>> views(segments.begin(), segments.end() - level);
        DecodedBrick brick;
        ASSERT_EQ(decodeBrick(format, views, level, {}, BandDecoder(model), brick), DecodeStatus::Ok);
        const std::vector<std::uint32_t> codes = brick.codes();
        EXPECT_EQ(codes.size(), countOf(samplesAt(format, level)));
        for (std::size_t i = 0; level == 0 && i < samples.size(); ++i) ASSERT_EQ(codes[i], std::uint32_t(samples[i]));
    }
}

} // namespace
} // namespace tessera::codec
