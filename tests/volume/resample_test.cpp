#include "volume/resample/resample.h"

#include "tests/volume/fields.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <random>

namespace tessera::volume {
namespace {

using test::ccLattice;
using test::sampled;

Field noise(glm::ivec3 size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 255);
    return sampled<std::uint8_t>(ccLattice(size), [&](glm::dvec3) { return uniform(random); });
}

TEST(Resample, SameLatticeIsIdentity) {
    for (const glm::ivec3 size : {glm::ivec3(1), glm::ivec3(2, 3, 1), glm::ivec3(17, 5, 9)}) {
        const Field cc = noise(size, 1);
        EXPECT_EQ(resample(cc, cc.lattice, ResampleFilter::Cubic).samples, cc.samples);
        // A lattice that differs by rounding only is resampled, and still the same.
        Lattice shifted = cc.lattice;
        shifted.origin.x += 1e-13;
        for (const ResampleFilter filter : {ResampleFilter::Nearest, ResampleFilter::Linear, ResampleFilter::Cubic})
            EXPECT_EQ(resample(cc, shifted, filter).samples, cc.samples);
        const Field bcc = toBcc(cc, false);
        EXPECT_EQ(resample(bcc, bcc.lattice, ResampleFilter::Cubic).samples, bcc.samples);
    }
}

TEST(Resample, ReproducesLinearFunctionsUpToTheFaces) {
    const Lattice cc = ccLattice({9, 12, 17}, {0.5, 2, 1e-3}, {3, -1, 0.25});
    const auto linear = [](glm::dvec3 p) { return 2 + 3 * p.x - 0.25 * p.y + 700 * p.z; };
    const Lattice bcc = bccFor(cc);
    const Box box = test::boxOf(cc);
    const Field source = sampled<float>(cc, linear);
    for (const ResampleFilter filter : {ResampleFilter::Linear, ResampleFilter::Cubic}) {
        const Field out = resample(source, bcc, filter);
        for (int k = 0; k < bcc.size.z; ++k)
            for (int j = 0; j < bcc.size.y; ++j)
                for (int i = 0; i < bcc.size.x; ++i) {
                    const glm::dvec3 inside = glm::clamp(bcc.position({i, j, k}), box.lo, box.hi);
                    EXPECT_NEAR(out.value(bcc.index({i, j, k})), linear(inside), 2e-5);
                }
    }
}

TEST(Resample, CatmullRomReproducesQuadraticsInside) {
    const Lattice cc = ccLattice({12, 12, 12}), target = ccLattice({10, 9, 11}, {0.7, 0.8, 0.63}, {2.2, 2.1, 2.3});
    const auto quadratic = [](glm::dvec3 p) { return p.x * p.x - 0.5 * p.y * p.y + p.x * p.z + p.y; };
    const Field out = resample(sampled<float>(cc, quadratic), target, ResampleFilter::Cubic);
    for (int k = 0; k < target.size.z; ++k)
        for (int j = 0; j < target.size.y; ++j)
            for (int i = 0; i < target.size.x; ++i)
                EXPECT_NEAR(out.value(target.index({i, j, k})), quadratic(target.position({i, j, k})), 1e-4);
}

TEST(Resample, BccToCcReproducesLinearFunctionsInside) {
    const Lattice cc = ccLattice({16, 14, 18});
    const auto linear = [](glm::dvec3 p) { return 1 + 2 * p.x + 3 * p.y - p.z; };
    const Field back = resample(sampled<float>(bccFor(cc), linear), cc, ResampleFilter::Cubic);
    for (int k = 3; k < cc.size.z - 3; ++k)
        for (int j = 3; j < cc.size.y - 3; ++j)
            for (int i = 3; i < cc.size.x - 3; ++i)
                EXPECT_NEAR(back.value(cc.index({i, j, k})), linear(glm::dvec3(i, j, k)), 1e-4);
}

TEST(Resample, RoundTripOfASmoothFieldIsClose) {
    const Lattice cc = ccLattice({24, 24, 24});
    const auto wave = [](glm::dvec3 p) { return std::sin(0.4 * p.x) * std::cos(0.3 * p.y) + std::sin(0.35 * p.z); };
    const Field source = sampled<float>(cc, wave);
    const Field back = resample(toBcc(source, false), cc, ResampleFilter::Cubic);
    double worst = 0;
    for (int k = 3; k < 21; ++k)
        for (int j = 3; j < 21; ++j)
            for (int i = 3; i < 21; ++i) {
                const std::size_t at = cc.index({i, j, k});
                worst = std::max(worst, std::abs(back.value(at) - source.value(at)));
            }
    EXPECT_LT(worst, 0.012);
}

// Two regions of different constants with a gap of absent samples between them, whose bytes are far away from both.
TEST(Resample, NothingBleedsOverAMask) {
    for (const int gap : {1, 2, 3})
        for (int axis = 0; axis < 3; ++axis)
            for (int begin = 3; begin < 8; ++begin) {
                const Lattice cc = ccLattice({13, 14, 15});
                Field field = sampled<std::uint8_t>(cc, [&](glm::dvec3 p) {
                    return p[axis] < begin ? 20 : p[axis] < begin + gap ? 255 : 200;
                });
                test::removeWhere(field, [&](glm::dvec3 p) { return p[axis] >= begin && p[axis] < begin + gap; });
                const auto check = [&](const Field& out, double cells) {
                    ASSERT_TRUE(out.mask);
                    double left = 0, right = 0;
                    for (std::size_t i = 0; i < out.count(); ++i) {
                        if (!out.present(i)) continue;
                        ASSERT_TRUE(out.value(i) == 20 || out.value(i) == 200) << out.value(i);
                        (out.value(i) == 20 ? left : right) += 1;
                    }
                    // No side loses more than a cell.
                    EXPECT_GT(left / double(out.count()), (begin - cells) / cc.size[axis]);
                    EXPECT_GT(right / double(out.count()), (cc.size[axis] - begin - gap - cells) / cc.size[axis]);
                };
                for (const ResampleFilter filter :
                     {ResampleFilter::Nearest, ResampleFilter::Linear, ResampleFilter::Cubic}) {
                    const Field bcc = resample(field, bccFor(cc), filter);
                    check(bcc, 1);
                    check(resample(bcc, cc, ResampleFilter::Cubic), 1.5);
                    check(resample(field, ccLattice({20, 20, 20}, {0.6, 0.65, 0.7}), filter), 1);
                }
            }
}

TEST(Resample, TargetIsAbsentWhereTheNearestSourceSampleIs) {
    std::mt19937 random(7);
    const Lattice cc = ccLattice({9, 10, 11});
    Field field = noise(cc.size, 8);
    test::removeWhere(field, [&](glm::dvec3) { return random() % 6 == 0; });
    for (const Lattice& target : {bccFor(cc), ccLattice({7, 19, 5}, {1.3, 0.47, 2.1}, {0.1, 0.2, 0.3})})
        for (const ResampleFilter filter : {ResampleFilter::Nearest, ResampleFilter::Linear, ResampleFilter::Cubic}) {
            const Field out = resample(field, target, filter);
            std::size_t more = 0;
            for (int k = 0; k < target.size.z; ++k)
                for (int j = 0; j < target.size.y; ++j)
                    for (int i = 0; i < target.size.x; ++i) {
                        const bool there = field.present(cc.index(cc.nearest(target.position({i, j, k}))));
                        const bool present = out.present(target.index({i, j, k}));
                        EXPECT_TRUE(there || !present);
                        more += there && !present ? 1 : 0;
                    }
            // Gaps kept open cost a few samples of BCC, and none of CC.
            EXPECT_LE(more, target.kind == LatticeKind::BCC ? target.count() / 5 : 0);
        }
}

TEST(Resample, AbsentNansDoNotSpread) {
    Field field = sampled<float>(ccLattice({8, 8, 8}), [](glm::dvec3 p) { return p.x > 4 ? NAN : 3.0; });
    test::removeWhere(field, [](glm::dvec3 p) { return p.x > 4; });
    const Field out = toBcc(field, false);
    for (std::size_t i = 0; i < out.count(); ++i) EXPECT_TRUE(!out.present(i) || out.value(i) == 3);
}

TEST(Resample, IntegersRoundAndClamp) {
    // A step of the full range overshoots with Catmull-Rom.
    const Field step = sampled<std::uint8_t>(ccLattice({8, 8, 8}), [](glm::dvec3 p) { return p.x < 4 ? 0 : 255; });
    const auto stepped = toBcc(step, false);
    for (std::size_t i = 1; i < std::size_t(stepped.lattice.size.x); ++i)
        EXPECT_GE(stepped.as<std::uint8_t>()[i], stepped.as<std::uint8_t>()[i - 1]); // no wrap around
    const Field large = sampled<std::int32_t>(ccLattice({4, 4, 4}), [](glm::dvec3) { return 2147483647.0; });
    const Field resampled = toBcc(large, false);
    for (const std::int32_t value : resampled.as<std::int32_t>()) EXPECT_EQ(value, 2147483647);
    const Field low =
        sampled<std::int16_t>(ccLattice({6, 6, 6}), [](glm::dvec3 p) { return p.x < 3 ? -32768 : 32767; });
    const Field clamped = toBcc(low, false);
    for (std::size_t i = 1; i < std::size_t(clamped.lattice.size.x); ++i)
        EXPECT_GE(clamped.as<std::int16_t>()[i], clamped.as<std::int16_t>()[i - 1]); // no wrap around
}

TEST(Resample, ResultsStayInTheRangeOfWhatIsPresent) {
    Field step = sampled<float>(ccLattice({12, 12, 12}), [](glm::dvec3 p) {
        return p.x < 3 ? -50 : p.x < 7 ? 0 : 2.5;
    });
    test::removeWhere(step, [](glm::dvec3 p) { return p.x < 3; });
    const Field bcc = toBcc(step, false);
    const Field back = resample(bcc, step.lattice, ResampleFilter::Cubic);
    for (const Field* field : {&bcc, &back})
        for (std::size_t i = 0; i < field->count(); ++i)
            EXPECT_TRUE(!field->present(i) || (field->value(i) >= 0 && field->value(i) <= 2.5));
}

TEST(Resample, LabelsStayLabels) {
    const Field labels = sampled<std::uint8_t>(ccLattice({15, 13, 11}), [](glm::dvec3 p) {
        return p.x < 5 ? 1 : p.y < 6 ? 3 : 7;
    });
    const Field out = toBcc(labels, true);
    for (const std::uint8_t value : out.as<std::uint8_t>()) EXPECT_TRUE(value == 1 || value == 3 || value == 7);
}

TEST(Resample, TinySizes) {
    for (const glm::ivec3 size : {glm::ivec3(1), glm::ivec3(2), glm::ivec3(1, 3, 2), glm::ivec3(17, 1, 3)}) {
        const Field field = sampled<float>(ccLattice(size), [](glm::dvec3) { return 4.0; });
        const Field bcc = toBcc(field, false);
        const Field back = resample(bcc, field.lattice, ResampleFilter::Cubic);
        for (std::size_t i = 0; i < bcc.count(); ++i) EXPECT_FLOAT_EQ(float(bcc.value(i)), 4);
        for (std::size_t i = 0; i < back.count(); ++i) EXPECT_FLOAT_EQ(float(back.value(i)), 4);
    }
    const Lattice slice{LatticeKind::BCC, {3, 2, 1}, glm::dvec3(1), glm::dvec3(0)};
    const Field flat =
        resample(sampled<float>(slice, [](glm::dvec3) { return 4.0; }), ccLattice({2, 2, 2}), ResampleFilter::Cubic);
    for (std::size_t i = 0; i < flat.count(); ++i) EXPECT_FLOAT_EQ(float(flat.value(i)), 4);
}

TEST(Resample, StopsWhenAsked) {
    std::stop_source source;
    source.request_stop();
    EXPECT_THROW(toBcc(noise({8, 8, 8}, 3), false, Progress{{}, source.get_token()}), Cancelled);
}

} // namespace
} // namespace tessera::volume
