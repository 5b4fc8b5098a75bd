#include "bench/data/thesis_coding.h"

#include "bench/data/run_length.h"
#include "tests/codec/make_dataset.h"
#include "volume/base/error.h"

#include <gtest/gtest.h>
#include <numeric>

namespace tessera::app {
namespace {

using namespace codec;
using namespace codec::testing;
using volume::ScalarType;

TEST(Runs, GiveBackWhatWasCoded) {
    std::mt19937 random(3);
    for (int trial = 0; trial < 1000; ++trial) {
        Bytes bytes(random() % 700);
        const auto kinds = 1 + random() % 5;
        for (std::size_t i = 0; i < bytes.size(); ++i)
            bytes[i] = random() % 4 != 0 && i > 0 ? bytes[i - 1] : static_cast<std::byte>(random() % kinds);
        const Bytes coded = encodeRuns(bytes);
        EXPECT_LE(coded.size(), bytes.size() + (bytes.size() + 126) / 127 + 1);
        Bytes back(bytes.size());
        ASSERT_EQ(decodeRuns(coded, back), DecodeStatus::Ok);
        ASSERT_EQ(back, bytes);
        Bytes longer = coded;
        longer.push_back(std::byte{1});
        ASSERT_NE(decodeRuns(longer, back), DecodeStatus::Ok);
        if (!coded.empty()) {
            const Bytes shorter(coded.begin(), coded.end() - 1);
            ASSERT_NE(decodeRuns(shorter, back), DecodeStatus::Ok);
        }
    }
    EXPECT_EQ(encodeRuns(Bytes(127 * 10)).size(), 20u); // the most runs can do: 63.5 : 1
}

TEST(Thresholds, DoWhatTheyAreNamedFor) {
    std::vector<std::int32_t> details{-9, -2, 0, 1, 2, 5, 3, -1};
    std::vector<std::int32_t> hard = details, soft = details, half = details;
    applyThreshold(hard, Threshold::Hard, 2);
    applyThreshold(soft, Threshold::Soft, 2);
    applyThreshold(half, Threshold::Quantile, 0.5);
    EXPECT_EQ(hard, (std::vector<std::int32_t>{-9, 0, 0, 0, 0, 5, 3, 0}));
    EXPECT_EQ(soft, (std::vector<std::int32_t>{-7, 0, 0, 0, 0, 3, 1, 0}));
    EXPECT_EQ(half, (std::vector<std::int32_t>{-9, 0, 0, 0, 2, 5, 3, 0}));
    std::mt19937 random(5);
    for (int trial = 0; trial < 1000; ++trial) {
        std::vector<std::int32_t> many(1 + random() % 50);
        for (std::int32_t& value : many) value = std::int32_t(random() % 21) + 1;
        const double part = double(random() % 101) / 100;
        const auto count = many.size();
        applyThreshold(many, Threshold::Quantile, part);
        EXPECT_EQ(std::size_t(std::count(many.begin(), many.end(), 0)), std::size_t(part * double(count)));
    }
}

TEST(ThesisCoding, LosesNothingWithoutThresholdAndLessBytesMeanMoreError) {
    volume::Dataset made = makeDataset({33, 30, 17},
                                       {{"a", ScalarType::U8, 1, Texture::Smooth, false, false},
                                        {"b", ScalarType::I16, 1, Texture::Nasty, false, false}},
                                       1);
    for (int p = 0; p < 2; ++p)
        for (const Wavelet wavelet : {Wavelet::W11, Wavelet::W22, Wavelet::W42}) {
            const volume::Field field = made.read(p, 0, 0);
            const ThesisResult exact = thesisCode(field, {wavelet, 3, Threshold::Soft, 0, false});
            EXPECT_EQ(exact.rms, 0);
            const ThesisResult best = thesisCode(field, {wavelet, 3, Threshold::Soft, 0, true});
            EXPECT_LE(best.bytes, exact.bytes + 6);
            for (const Threshold kind : {Threshold::Hard, Threshold::Soft}) {
                const ThesisResult some = thesisCode(field, {wavelet, 3, kind, 1.5, false});
                const ThesisResult more = thesisCode(field, {wavelet, 3, kind, 5.5, false});
                if (p == 1) continue; // noise of 16 bits stays as it is
                EXPECT_LT(some.bytes, exact.bytes);
                EXPECT_LE(more.bytes, some.bytes);
                EXPECT_GT(some.rms, 0);
                EXPECT_GE(more.rms, some.rms);
            }
        }
    volume::Dataset floats = makeDataset({4, 4, 4}, {{"a", ScalarType::F32, 1, Texture::Smooth, false, false}}, 1);
    EXPECT_THROW((void)thesisCode(floats.read(0, 0, 0), {}), Error);
}

} // namespace
} // namespace tessera::app
