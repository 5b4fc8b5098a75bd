#include "vis/lanes/lanes.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

/// Functions of packets of numbers, here compiled without instructions of their own, against those of the library.
namespace tessera::vis::packet::TESSERA_LANES {
namespace {

/// Of a packet whose lanes are alike.
double valueOf(Floats all) {
    return double(least(all));
}

TEST(Lanes, SineAndCosineAreCloseForATurn) {
    for (int i = -700; i <= 700; ++i) {
        const float radians = float(i) * 0.01f;
        EXPECT_NEAR(valueOf(sine(Floats(radians))), std::sin(double(radians)), 1e-6) << radians;
        EXPECT_NEAR(valueOf(cosine(Floats(radians))), std::cos(double(radians)), 1e-6) << radians;
    }
}

TEST(Lanes, AnglesAreCloseInEveryOctant) {
    for (int i = 0; i < 720; ++i)
        for (const double length : {1e-6, 0.3, 1.0, 1e5}) {
            const double angle = (i - 359.5) * std::numbers::pi / 360;
            const float x = float(length * std::cos(angle)), y = float(length * std::sin(angle));
            EXPECT_NEAR(valueOf(angleOf(Floats(y), Floats(x))), std::atan2(double(y), double(x)), 1e-6) << i;
        }
    EXPECT_EQ(valueOf(angleOf(Floats(0), Floats(0))), 0);
    EXPECT_NEAR(valueOf(angleOf(Floats(0), Floats(-1))), std::numbers::pi, 1e-6);
}

TEST(Lanes, LogarithmsAndPowersAreClose) {
    for (int i = 1; i <= 400; ++i) {
        const float x = float(std::exp(0.1 * (i - 200)));
        EXPECT_NEAR(valueOf(logarithm(Floats(x))), std::log2(double(x)), 2e-5) << x;
        const float whole = float(i - 200) * 0.1f;
        EXPECT_NEAR(valueOf(powerOfTwo(Floats(whole))) / std::exp2(double(whole)), 1, 1e-4) << whole;
    }
    for (const float exponent : {0.25f, 0.5f, 1.0f, 2.0f, 6.0f})
        for (int i = 1; i <= 100; ++i)
            EXPECT_NEAR(valueOf(power(Floats(float(i) * 0.01f), Floats(exponent))),
                        std::pow(double(float(i) * 0.01f), double(exponent)), 1e-4);
}

} // namespace
} // namespace tessera::vis::packet::TESSERA_LANES
