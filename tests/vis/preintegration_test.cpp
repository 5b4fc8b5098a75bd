#include "tests/reference/raycast.h"
#include "tests/vis/function_source.h"
#include "vis/optics/preintegration.h"
#include "vis/optics/ray_setup.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <random>

namespace tessera::vis {
namespace {

TransferFunction peaks() {
    TransferFunction function;
    function.opacity = {{0, 0}, {0.3f, 0}, {0.32f, 0.4f}, {0.34f, 0}, {0.6f, 0}, {0.7f, 0.05f}, {0.9f, 0.99f}};
    return function;
}

double extinction(const glm::dvec4& color) {
    return -std::log1p(-std::min(color.a, 1 - 1e-12));
}

TEST(Preintegration, EqualsTheMeanOverManyPlaces) {
    const TransferFunction function = peaks();
    const IntegralFunctions integrals = integralFunctions(function, {0, 1});
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-0.1, 1.1);
    for (int n = 0; n < 200; ++n) {
        const double a = place(random), b = place(random);
        const double lo = std::clamp(a, 0.0, 1.0), hi = std::clamp(b, 0.0, 1.0);
        glm::dvec4 mean(0);
        const int parts = 20000;
        for (int i = 0; i < parts; ++i) {
            const glm::dvec4 srgb = evaluate(function, {0, 1}, glm::mix(lo, hi, (i + 0.5) / parts));
            mean += glm::dvec4(linearFromSrgb(glm::dvec3(srgb)), 1) * extinction(srgb) / double(parts);
        }
        const glm::dvec4 got = preintegrated(integrals, a, b);
        EXPECT_NEAR(got.a, 1 - std::exp(-mean.a), 2e-4) << a << " " << b;
        if (mean.a > 1e-6) {
            EXPECT_LT(glm::length(glm::dvec3(got) - glm::dvec3(mean) / mean.a), 2e-3) << a << " " << b;
        }
        EXPECT_EQ(got, preintegrated(integrals, b, a));
    }
}

TEST(Preintegration, OfOnePlaceIsTheFunctionThere) {
    const TransferFunction function = peaks();
    const IntegralFunctions integrals = integralFunctions(function, {-2, 5});
    for (double x = 0.001; x < 1; x += 0.0137) {
        const glm::dvec4 srgb = evaluate(function, {-2, 5}, glm::mix(-2.0, 5.0, x));
        const glm::dvec4 near = preintegrated(integrals, x, x + 1e-6);
        EXPECT_NEAR(preintegrated(integrals, x, x).a, srgb.a, 3e-4) << x;
        EXPECT_NEAR(near.a, srgb.a, 3e-4) << "no jump at the fallback, " << x;
    }
}

TEST(Preintegration, OpticalDepthsOfPartsAddUp) {
    const IntegralFunctions integrals = integralFunctions(peaks(), {0, 1});
    std::mt19937 random(4);
    std::uniform_real_distribution<double> place(0, 1);
    for (int n = 0; n < 300; ++n) {
        const double a = place(random), b = place(random), middle = 0.5 * (a + b);
        const double whole = extinction(preintegrated(integrals, a, b));
        const double parts =
            0.5 * (extinction(preintegrated(integrals, a, middle)) + extinction(preintegrated(integrals, middle, b)));
        EXPECT_NEAR(whole, parts, 1e-6 * (1 + whole));
    }
}

TEST(Preintegration, TableHoldsItPremultiplied) {
    const IntegralFunctions integrals = integralFunctions(peaks(), {0, 1});
    const std::vector<glm::vec4> table = preintegrationTable(integralFunctions(peaks(), {0, 1}), 256);
    for (int y = 0; y < 256; y += 5)
        for (int x = 0; x < 256; x += 3) {
            const glm::dvec4 wanted = preintegrated(integrals, x / 255.0, y / 255.0);
            const glm::dvec4 got(table[std::size_t(y * 256 + x)]);
            EXPECT_LT(glm::length(got - glm::dvec4(glm::dvec3(wanted) * wanted.a, wanted.a)), 1e-5) << x << " " << y;
        }
}

/// What the technique is for: at twice the step it is at least as near to the truth as post-classification.
TEST(Preintegration, IsAsGoodAtTwiceTheStep) {
    const auto wave = [](glm::dvec3 p) {
        return 0.5 + 0.3 * std::sin(p.x * 0.7) * std::cos(p.y * 0.6) + 0.2 * std::sin(p.z * 0.8);
    };
    for (volume::LatticeKind kind : {volume::LatticeKind::CC, volume::LatticeKind::BCC}) {
        const FunctionSource source(kind, {17, 17, 17}, glm::dvec3(1), {{"c", wave}});
        Scene scene;
        scene.showBox = false;
        scene.transfer["c"].opacity = {{0, 0},    {0.4f, 0},     {0.42f, 0.3f}, {0.44f, 0},
                                       {0.6f, 0}, {0.61f, 0.5f}, {0.62f, 0}};
        const auto draw = [&](Classification classification, float step) {
            scene.layers = {{"", true, VolumeLayer{.channel = "c", .classification = classification, .shaded = false}}};
            scene.render.stepVoxels = step;
            return reference::render(scene, source, {24, 24});
        };
        const reference::Image truth = draw(Classification::Post, 0.02f);
        const double post = reference::compare(draw(Classification::Post, 0.5f), truth, 1).rmse;
        const double once = reference::compare(draw(Classification::PreIntegrated, 0.5f), truth, 1).rmse;
        const double twice = reference::compare(draw(Classification::PreIntegrated, 1), truth, 1).rmse;
        std::printf("RMSE of %s: post %.5f, pre-integrated %.5f, at twice the step %.5f\n",
                    std::string(volume::kLatticeNames[std::size_t(kind)]).c_str(), post, once, twice);
        EXPECT_LT(once, post);
        EXPECT_LE(twice, post);
    }
}

} // namespace
} // namespace tessera::vis
