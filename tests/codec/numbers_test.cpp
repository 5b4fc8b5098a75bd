#include "codec/brick/sample_numbers.h"

#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace tessera::codec {
namespace {

volume::Field fieldOf(const std::vector<float>& values) {
    volume::Field field =
        volume::makeField({volume::LatticeKind::CC, {int(values.size()), 1, 1}, {}, {}}, volume::ScalarType::F32);
    std::copy(values.begin(), values.end(), field.as<float>().begin());
    return field;
}

TEST(Numbers, FindsDecimalsInDisguise) {
    std::mt19937 random(1);
    double power = 1;
    for (int digits = 0; digits <= 4; ++digits, power *= 10) {
        std::vector<float> values(5000);
        for (float& value : values) value = float(double(int(random() % 80000) - 30000) / power);
        const NumberCoding coding = chooseCoding(fieldOf(values), 0);
        EXPECT_EQ(coding, (NumberCoding{NumberKind::Scaled, 0, power}));
        for (const float value : values)
            ASSERT_TRUE(close(coding, 0, value, sampleOf<float>(coding, codeOf(coding, value))));
    }
}

TEST(Numbers, FindsFixedPointNumbers) {
    std::mt19937 random(2);
    std::vector<float> values(5000);
    for (float& value : values) value = 434.0f + float(random() % 100000) / 32768.0f;
    const NumberCoding coding = chooseCoding(fieldOf(values), 0);
    EXPECT_EQ(coding.kind, NumberKind::Scaled);
    EXPECT_EQ(coding.step, 32768);
}

TEST(Numbers, OtherFloatsKeepTheirBits) {
    std::mt19937 random(3);
    std::vector<float> values(5000);
    for (float& value : values) value = std::bit_cast<float>(std::uint32_t(random()));
    const NumberCoding coding = chooseCoding(fieldOf(values), 0);
    EXPECT_EQ(coding.kind, NumberKind::Float);
    for (const float value : values)
        ASSERT_EQ(std::bit_cast<std::uint32_t>(sampleOf<float>(coding, codeOf(coding, value))),
                  std::bit_cast<std::uint32_t>(value));
}

TEST(Numbers, AFewOddOnesDoNotSpoilTheRest) {
    std::vector<float> values(5000);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = float(double(i) / 10);
    values[77] = -0.0f;
    values[78] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(chooseCoding(fieldOf(values), 0), (NumberCoding{NumberKind::Scaled, 0, 10}));
}

// Rows are rounded as single samples are, by every instruction set.
TEST(Numbers, CodesOfRowsAreThoseOfTheirSamples) {
    std::mt19937 random(8);
    std::vector<float> values{0.0f, -0.0f, 0.5f, 1.5f, 2.5f, -0.5f, -2.5f, 1e30f, -1e30f, 536870912.0f, 536870944.0f};
    for (const float odd : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
        values.insert(values.end(), {odd, -odd});
    for (int i = 0; i < 1000; ++i) {
        values.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(random())));
        values.push_back(static_cast<float>(int(random() % 200001) - 100000) * 0.125f);
    }
    for (const NumberCoding& coding :
         {NumberCoding{NumberKind::Quantised, 0, 1}, NumberCoding{NumberKind::Quantised, 3.25, 0.1},
          NumberCoding{NumberKind::Stepped, -7, 0.3}, NumberCoding{NumberKind::Scaled, 0, 100},
          NumberCoding{NumberKind::Float, 0, 1}})
        for (const Cpu cpu : {Cpu::Portable, Cpu::Avx2, Cpu::Avx512}) {
            if (cpu > bestCpu()) continue;
            for (const std::size_t count : {values.size(), std::size_t(5)}) {
                std::vector<std::uint32_t> codes(count);
                codesOf(coding, std::as_bytes(std::span(values).first(count)), codes.data(), cpu);
                for (std::size_t i = 0; i < count; ++i)
                    ASSERT_EQ(codes[i], codeOf(coding, values[i])) << values[i] << ' ' << int(coding.kind);
            }
        }
}

TEST(Numbers, AbsentSamplesHaveNoSay) {
    std::vector<float> values(5000);
    volume::Mask mask(values.size(), 1);
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = float(double(i) / 10);
        if (i % 3 == 0) mask[i] = 0, values[i] = 1e30f;
    }
    volume::Field field = fieldOf(values);
    field.mask = std::make_shared<const volume::Mask>(mask);
    EXPECT_EQ(chooseCoding(field, 0).step, 10);
}

TEST(Numbers, TheBoundHoldsInFloatFarFromZero) {
    std::mt19937 random(4);
    for (const double offset : {0.0, 273.15, 101325.0, -4e6})
        for (const double bound : {1e-1, 1e-3, 1e-2, 3e-5}) {
            std::vector<float> values(3000);
            for (float& value : values) value = float(offset + double(random() % 10000) * 1.7e-3);
            const NumberCoding coding = chooseCoding(fieldOf(values), bound);
            std::size_t outside = 0;
            for (const float value : values) {
                const float decoded = sampleOf<float>(coding, codeOf(coding, value));
                if (std::abs(double(value) - double(decoded)) > bound) ++outside;
            }
            EXPECT_EQ(outside, 0u) << offset << " " << bound;
            if (bound > 1e-2 && std::abs(offset) < 1e5) {
                EXPECT_EQ(coding.kind, NumberKind::Quantised);
                EXPECT_GT(coding.step, 1.9 * bound);
            }
        }
}

} // namespace
} // namespace tessera::codec
