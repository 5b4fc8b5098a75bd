#include "codec/wavelet/lifting.h"

#include <bit>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <vector>

namespace tessera::codec {
namespace {

constexpr Wavelet kAll[] = {Wavelet::N1,  Wavelet::N2,  Wavelet::W11, Wavelet::W13, Wavelet::W15, Wavelet::W22,
                            Wavelet::W24, Wavelet::W26, Wavelet::N4,  Wavelet::W42, Wavelet::W44, Wavelet::W46};
constexpr int kSizes[] = {1, 2, 3, 4, 17};

std::size_t volumeOf(glm::ivec3 size) {
    return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
}

struct Case {
    glm::ivec3 size;
    std::vector<std::uint32_t> values;
    std::vector<std::uint8_t> present;
};

Case randomCase(std::mt19937& random, int bits) {
    const auto pick = [&] { return kSizes[random() % std::size(kSizes)]; };
    Case made{{pick(), pick(), pick()}, {}, {}};
    for (std::size_t i = 0; i < volumeOf(made.size); ++i)
        made.values.push_back(bits == 32 ? std::uint32_t(random()) : std::uint32_t(random()) % (1u << bits));
    if (random() % 2 == 0)
        for (std::size_t i = 0; i < made.values.size(); ++i) made.present.push_back(random() % 3 != 0);
    return made;
}

TEST(Lifting, InvertsBitForBitForAllSizesMasksAndRanges) {
    std::mt19937 random(1);
    for (int trial = 0; trial < 1500; ++trial) {
        const Wavelet wavelet = kAll[trial % std::size(kAll)];
        const int bits = (trial / 12) % 3 == 0 ? 8 : (trial / 12) % 3 == 1 ? 16 : 32;
        const Case original = randomCase(random, bits);
        const int steps = int(random() % 4);
        std::vector<Arithmetic> ways{Arithmetic::Wide};
        if (bits < 32) ways.push_back(Arithmetic::Narrow);
        if (wavelet == Wavelet::N1 || wavelet == Wavelet::N2) ways.push_back(Arithmetic::Float);
        for (const Arithmetic arithmetic : ways) {
            Case work = original;
            forward(work.values, work.present, work.size, steps, wavelet, arithmetic);
            std::vector<std::uint8_t> moved = original.present;
            if (!moved.empty()) deinterleave(moved, work.size, steps);
            ASSERT_EQ(moved, work.present);
            inverse(work.values, work.present, work.size, steps, wavelet, arithmetic);
            ASSERT_EQ(work.values, original.values) << kWaveletNames[std::size_t(wavelet)] << " trial " << trial;
            ASSERT_EQ(work.present, original.present);
        }
    }
}

TEST(Lifting, AllInstructionSetsGiveTheSameCoefficients) {
    std::mt19937 random(9);
    constexpr int kTrials = 600, kBits[] = {8, 16, 32};
    int masked = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
        const Wavelet wavelet = kAll[trial % std::size(kAll)];
        const int bits = kBits[trial / 12 % 3];
        const Case original = randomCase(random, bits);
        masked += original.present.empty() ? 0 : 1;
        const Arithmetic arithmetic = bits < 32 && trial % 2 == 0 ? Arithmetic::Narrow : Arithmetic::Wide;
        Case plain = original;
        forward(plain.values, plain.present, plain.size, 2, wavelet, arithmetic, Cpu::Portable);
        std::vector<Cpu> sets;
        if (bestCpu() != Cpu::Portable) sets.push_back(Cpu::Avx2);
        if (bestCpu() == Cpu::Avx512) sets.push_back(Cpu::Avx512);
        for (const Cpu cpu : sets) {
            Case other = original;
            forward(other.values, other.present, other.size, 2, wavelet, arithmetic, cpu);
            ASSERT_EQ(other.values, plain.values) << kWaveletNames[std::size_t(wavelet)] << " trial " << trial;
            inverse(other.values, other.present, other.size, 2, wavelet, arithmetic, cpu);
            ASSERT_EQ(other.values, original.values) << kWaveletNames[std::size_t(wavelet)] << " trial " << trial;
        }
        inverse(plain.values, plain.present, plain.size, 2, wavelet, arithmetic, Cpu::Portable);
        ASSERT_EQ(plain.values, original.values);
    }
    EXPECT_GT(masked, kTrials / 4);
}

TEST(Lifting, NarrowAndWideAgreeOnSixteenBits) {
    std::mt19937 random(2);
    for (int trial = 0; trial < 400; ++trial) {
        Case narrow = randomCase(random, 16), wide = narrow;
        const Wavelet wavelet = kAll[random() % std::size(kAll)];
        forward(narrow.values, narrow.present, narrow.size, 3, wavelet, Arithmetic::Narrow);
        forward(wide.values, wide.present, wide.size, 3, wavelet, Arithmetic::Wide);
        ASSERT_EQ(narrow.values, wide.values);
    }
}

TEST(Lifting, AFullMaskChangesNothing) {
    std::mt19937 random(3);
    for (int trial = 0; trial < 400; ++trial) {
        Case plain = randomCase(random, 32);
        plain.present.clear();
        Case masked = plain;
        masked.present.assign(masked.values.size(), 1);
        const Wavelet wavelet = kAll[random() % std::size(kAll)];
        forward(plain.values, plain.present, plain.size, 2, wavelet, Arithmetic::Wide);
        forward(masked.values, masked.present, masked.size, 2, wavelet, Arithmetic::Wide);
        ASSERT_EQ(plain.values, masked.values) << kWaveletNames[std::size_t(wavelet)];
    }
}

TEST(Lifting, AbsentSamplesAreMovedButNeverReadOrChanged) {
    std::mt19937 random(4);
    for (int trial = 0; trial < 400; ++trial) {
        Case one = randomCase(random, 32);
        if (one.present.empty()) continue;
        Case other = one;
        for (std::size_t i = 0; i < one.values.size(); ++i)
            if (one.present[i] == 0) other.values[i] = std::uint32_t(random());
        const Wavelet wavelet = kAll[random() % std::size(kAll)];
        forward(one.values, one.present, one.size, 3, wavelet, Arithmetic::Wide);
        forward(other.values, other.present, other.size, 3, wavelet, Arithmetic::Wide);
        for (std::size_t i = 0; i < one.values.size(); ++i)
            ASSERT_TRUE(one.present[i] == 0 || one.values[i] == other.values[i]);
    }
}

TEST(Lifting, ConstantRegionsStayExactlyConstantAtEveryLevel) {
    // Two regions of one constant each, apart by absent garbage, of random shape: every coarse sample that is present
    // is one of the two constants, and the details of regions at least two wide are zero.
    std::mt19937 random(5);
    const glm::ivec3 size(17, 16, 33);
    for (const Wavelet wavelet : kAll) {
        std::vector<std::uint32_t> values(volumeOf(size));
        std::vector<std::uint8_t> present(values.size());
        const int border = 6 + int(random() % 5);
        for (std::size_t i = 0; i < values.size(); ++i) {
            const int x = int(i % 17), z = int(i / (17 * 16));
            const int side = x + z / 4 < border ? 0 : x + z / 4 > border + 4 ? 1 : 2;
            present[i] = side < 2;
            values[i] = side == 0 ? 1000 : side == 1 ? 77 : std::uint32_t(random());
        }
        forward(values, present, size, 1, wavelet, Arithmetic::Wide);
        const glm::ivec3 low = levelSize(size, 1);
        int seen[2] = {0, 0};
        for (int z = 0; z < low.z; ++z)
            for (int y = 0; y < low.y; ++y)
                for (int x = 0; x < low.x; ++x) {
                    const auto i = std::size_t((z * size.y + y) * size.x + x);
                    if (present[i] == 0) continue;
                    ASSERT_TRUE(values[i] == 1000 || values[i] == 77) << values[i];
                    ++seen[values[i] == 1000 ? 0 : 1];
                }
        EXPECT_GT(seen[0], 50);
        EXPECT_GT(seen[1], 50);
    }
    // A single region in garbage, as many levels as there are.
    for (const Wavelet wavelet : kAll) {
        std::vector<std::uint32_t> values(volumeOf(size));
        std::vector<std::uint8_t> present(values.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
            present[i] = random() % 2 == 0;
            values[i] = present[i] != 0 ? 4242u : std::uint32_t(random());
        }
        for (int level = 1; level <= 4; ++level) {
            std::vector<std::uint32_t> coarse = values;
            std::vector<std::uint8_t> flags = present;
            forward(coarse, flags, size, level, wavelet, Arithmetic::Wide);
            const glm::ivec3 low = levelSize(size, level);
            for (int z = 0; z < low.z; ++z)
                for (int y = 0; y < low.y; ++y)
                    for (int x = 0; x < low.x; ++x) {
                        const auto i = std::size_t((z * size.y + y) * size.x + x);
                        ASSERT_TRUE(flags[i] == 0 || coarse[i] == 4242u) << kWaveletNames[std::size_t(wavelet)];
                    }
        }
    }
}

TEST(Lifting, LinearRampsLeaveNoDetailInsideAndStayLinear) {
    for (const Wavelet wavelet : {Wavelet::W22, Wavelet::W24, Wavelet::W26, Wavelet::N2})
        for (const std::size_t n : {32u, 33u}) {
            std::vector<std::uint32_t> line(n);
            for (std::size_t i = 0; i < n; ++i) line[i] = std::uint32_t(6 * i + 5);
            forward(line, {}, {int(n), 1, 1}, 1, wavelet, Arithmetic::Wide);
            for (std::size_t i = (n + 1) / 2; i < n; ++i) EXPECT_EQ(line[i], i == 31 && n == 32 ? 6u : 0u);
            for (std::size_t i = 0; i < (n + 1) / 2; ++i) EXPECT_EQ(line[i], 12 * i + 5) << i;
        }
}

TEST(Lifting, CubicsLeaveNoDetailInside) {
    for (const Wavelet wavelet : {Wavelet::N4, Wavelet::W42, Wavelet::W44, Wavelet::W46}) {
        std::vector<std::uint32_t> line(64);
        for (std::size_t i = 0; i < line.size(); ++i) line[i] = std::uint32_t(i * i * i * 16 - 7 * i * i * 16);
        forward(line, {}, {64, 1, 1}, 1, wavelet, Arithmetic::Wide);
        for (std::size_t i = 33; i < 62; ++i) EXPECT_EQ(line[i], 0u) << kWaveletNames[std::size_t(wavelet)] << " " << i;
    }
}

TEST(Lifting, MeansOfTwoLieHalfACellFurther) {
    std::vector<std::uint32_t> line(32);
    for (std::size_t i = 0; i < line.size(); ++i) line[i] = std::uint32_t(10 * i);
    forward(line, {}, {32, 1, 1}, 1, Wavelet::W11, Arithmetic::Wide);
    for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(line[i], 20 * i + std::uint32_t(10 * levelPhase(Wavelet::W11)));
    EXPECT_EQ(levelPhase(Wavelet::W22), 0);
}

TEST(Lifting, UpdateKeepsTheMeanOfABump) {
    // A delta keeps its sum, wherever it lies: coarse samples count double.
    for (const Wavelet wavelet : {Wavelet::W22, Wavelet::W24, Wavelet::W26, Wavelet::W42, Wavelet::W44, Wavelet::W46})
        for (const std::size_t at : {30u, 31u}) {
            std::vector<std::uint32_t> line(65, 0);
            line[at] = 8000;
            forward(line, {}, {65, 1, 1}, 1, wavelet, Arithmetic::Wide);
            double sum = 0;
            for (std::size_t i = 0; i < 33; ++i) sum += 2 * double(std::int32_t(line[i]));
            EXPECT_NEAR(sum, 8000, 8) << kWaveletNames[std::size_t(wavelet)];
        }
}

TEST(Lifting, FloatCodesKeepOrderAndEveryBit) {
    using Limits = std::numeric_limits<float>;
    const float ordered[] = {
        -Limits::infinity(),  -Limits::max(), -1.5f, -1.0f,         -Limits::denorm_min(), -0.0f, 0.0f,
        Limits::denorm_min(), 1.0f,           1.5f,  Limits::max(), Limits::infinity()};
    for (std::size_t i = 0; i + 1 < std::size(ordered); ++i)
        EXPECT_LT(std::int32_t(codeOfFloat(ordered[i])), std::int32_t(codeOfFloat(ordered[i + 1])));
    std::mt19937 random(6);
    for (int i = 0; i < 100000; ++i) {
        const auto bits = std::uint32_t(random());
        ASSERT_EQ(std::bit_cast<std::uint32_t>(floatOfCode(codeOfFloat(std::bit_cast<float>(bits)))), bits);
    }
    for (const std::uint32_t bits : {0x7fc00001u, 0xffc12345u, 0x7f800001u, 0xff800001u})
        EXPECT_EQ(std::bit_cast<std::uint32_t>(floatOfCode(codeOfFloat(std::bit_cast<float>(bits)))), bits);
}

} // namespace
} // namespace tessera::codec
