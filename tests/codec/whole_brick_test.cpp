#include "codec/brick/whole_brick.h"

#include "codec/brick/brick_codec.h"

#include <cmath>
#include <cstring>
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

/// The model that suits a brick.
Model modelOf(const BrickFormat& format, const Bytes& samples) {
    Histogram histogram(format.levels, {});
    SplitMemory memory;
    countBrick(prepareBrick(format, samples, {}, 0, {}, memory), histogram);
    return makeModel(histogram, 16);
}

TEST(WholeBrick, ASparseVolumeIsCodedAsOne) {
    BrickFormat format{volume::LatticeKind::CC, {32, 32, 32}, 4, Wavelet::W22, volume::ScalarType::U8, {}, false, 8};
    Bytes samples(countOf(format.size));
    for (std::size_t i = 0; i < samples.size(); i += 97) samples[i] = std::byte(1 + i % 3);
    const Model model = modelOf(format, samples);
    Compressor compressor(3);
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

// A field of floats whose other half is its mirror image takes little more than the half; noise stays in levels.
TEST(WholeBrick, MirroredFloatsAreStoredOnce) {
    BrickFormat format{volume::LatticeKind::CC, {32, 32, 32}, 4, Wavelet::W22, volume::ScalarType::F32, {}, false, 32};
    const std::size_t slice = 32 * 32;
    std::size_t bytes[2] = {};
    for (const bool mirrored : {false, true}) {
        std::mt19937 random(5);
        std::uniform_real_distribution<float> any(1, 2);
        std::vector<float> values(countOf(format.size));
        for (std::size_t z = 0; z < 32; ++z)
            for (std::size_t i = 0; i < slice; ++i)
                values[z * slice + i] = mirrored && z >= 16 ? values[(31 - z) * slice + i] : any(random);
        Bytes samples(values.size() * sizeof(float));
        std::memcpy(samples.data(), values.data(), samples.size());
        const Model model = modelOf(format, samples);
        Compressor compressor(3);
        const std::vector<Bytes> segments = encodeBrick(format, samples, {}, 0, compressor, BandEncoder(model));
        for (const Bytes& segment : segments) bytes[mirrored] += segment.size();
        EXPECT_EQ(!segments[0].empty() && isWhole(segments[0][0]), mirrored);

        const std::vector<std::span<const std::byte>> views(segments.begin(), segments.end());
        DecodedBrick brick;
        ASSERT_EQ(decodeBrick(format, views, 0, {}, BandDecoder(model), brick), DecodeStatus::Ok);
        const std::vector<std::uint32_t> codes = brick.codes();
        for (std::size_t i = 0; i < slice * 16 && mirrored; ++i)
            ASSERT_EQ(codes[i], codes[(31 - i / slice) * slice + i % slice]) << i;
    }
    EXPECT_LT(double(bytes[1]), 0.6 * double(bytes[0]));
}

} // namespace
} // namespace tessera::codec
