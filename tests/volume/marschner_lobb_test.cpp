#include "volume/synthetic/marschner_lobb.h"

#include "volume/base/error.h"
#include "volume/synthetic/models.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace tessera::volume {
namespace {

TEST(MarschnerLobb, ValuesOfThePaper) {
    const MarschnerLobb signal;
    // On the axis rho_r = cos(2 pi fM) = 1; at r = 1 rho_r = cos(0) = 1; sin(pi z / 2) = -1, 0, 1 at z = -1, 0, 1.
    EXPECT_NEAR(signal({0, 0, -1}), 1, 1e-12);
    EXPECT_NEAR(signal({0, 0, 0}), 1.5 / 2.5, 1e-12);
    EXPECT_NEAR(signal({1, 0, 1}), 0.5 / 2.5, 1e-12);
    EXPECT_NEAR(signal({0.6, 0.8, 0}), 1.5 / 2.5, 1e-12);
    EXPECT_NEAR(signal({0, 0, 0}, 0.5), 1 / 2.5, 1e-12); // half a turn later: rho_r = -1
    EXPECT_NEAR(signal({0.3, 0.2, 0.1}, 1), signal({0.3, 0.2, 0.1}), 1e-12);
}

TEST(MarschnerLobb, GradientIsTheDerivative) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const MarschnerLobb signal{0.3, 4.5};
    const double h = 1e-6;
    for (int n = 0; n < 200; ++n) {
        const glm::dvec3 p(uniform(random), uniform(random), uniform(random));
        const glm::dvec3 slope = signal.gradient(p, 0.2);
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 step(0);
            step[axis] = h;
            EXPECT_NEAR(slope[axis], (signal(p + step, 0.2) - signal(p - step, 0.2)) / (2 * h), 1e-6);
        }
    }
}

TEST(MarschnerLobb, ModelOfAnySizeTypeAndTimes) {
    EXPECT_NE(std::ranges::count(modelNames(), "marschner-lobb"), 0);
    for (const double bits : {8, 16, 32}) {
        const Dataset dataset =
            makeModel("marschner-lobb", {{"nx", 5}, {"ny", 17}, {"nz", 2}, {"times", 3}, {"fM", 2}, {"bits", bits}});
        EXPECT_EQ(dataset.info.times, (std::vector<double>{0, 1.0 / 3, 2.0 / 3}));
        const MarschnerLobb signal{0.25, 2};
        const Field field = dataset.read(0, 0, 2);
        EXPECT_EQ(field.lattice, dataset.info.lattice);
        EXPECT_EQ(field.lattice.size, glm::ivec3(5, 17, 2));
        const double step = bits == 32 ? 1e-7 : 0.5001 / (std::exp2(bits) - 1);
        for (int k = 0; k < 2; ++k)
            for (int j = 0; j < 17; ++j)
                for (int i = 0; i < 5; ++i)
                    EXPECT_NEAR(field.value(field.lattice.index({i, j, k})),
                                signal({-1 + i * 0.5, -1 + j * 0.125, -1 + k * 2}, 2.0 / 3), step);
        EXPECT_EQ(dataset.info.parameters[0].ranges, (std::vector<Range>{{0, 1}}));
    }
}

TEST(MarschnerLobb, BadSettingsAreNamed) {
    for (const std::map<std::string, double>& bad : std::vector<std::map<std::string, double>>{
             {{"nx", 1}}, {{"nx", 2.5}}, {{"times", 0}}, {{"size", 4}}, {{"bits", 12}}, {{"fM", NAN}}}) {
        try {
            makeModel("marschner-lobb", bad);
            FAIL() << bad.begin()->first;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(bad.begin()->first), std::string::npos) << error.what();
        }
    }
    EXPECT_THROW(makeModel("tooth", {}), Error);
}

} // namespace
} // namespace tessera::volume
