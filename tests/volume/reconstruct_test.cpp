#include "volume/reconstruct/reconstruct.h"

#include "tests/volume/fields.h"
#include "volume/analysis/lattice_error.h"
#include "volume/reconstruct/gradient.h"
#include "volume/sources/memory_source.h"
#include "volume/synthetic/marschner_lobb.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace tessera::volume {
namespace {

using test::ccLattice;
using test::sampled;

constexpr LatticeKind kKinds[] = {LatticeKind::CC, LatticeKind::BCC};

glm::dvec3 randomPoint(std::mt19937& random, double lo, double hi) {
    std::uniform_real_distribution<double> uniform(lo, hi);
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return {x, y, z};
}

/// An endless lattice with cells of edge 1 that carries a function of position.
template <class Function> auto endless(LatticeKind kind, const Function& f) {
    return [kind, f](glm::ivec3 at) {
        if (kind == LatticeKind::CC) return Sample{f(glm::dvec3(at)), true};
        const double half = at.z & 1 ? 0.5 : 0;
        return Sample{f(glm::dvec3(at.x + half, at.y + half, at.z * 0.5)), true};
    };
}

TEST(Reconstruct, LinearFunctionsAreExact) {
    std::mt19937 random(1);
    const auto f = [](glm::dvec3 p) { return 0.5 + 2 * p.x - 3 * p.y + 0.25 * p.z; };
    for (const LatticeKind kind : kKinds) {
        const LevelGeometry geometry{kind, 1, 0};
        const auto samples = endless(kind, f);
        const Prefiltered filtered(samples, geometry);
        for (int n = 0; n < 1000; ++n) {
            const glm::dvec3 p = randomPoint(random, -5, 5);
            EXPECT_NEAR(linear(geometry, samples, p).value().value(), f(p), 1e-12);
            EXPECT_NEAR(linear(geometry, filtered, p).value().value(), f(p), 1e-12);
            EXPECT_NEAR(tetrahedral(geometry, samples, p).value().value(), f(p), 1e-12);
            EXPECT_NEAR(cosineWeighted(geometry, samples, p).value().value(), f(p), 1e-12);
            EXPECT_NEAR(quinticBox(geometry, filtered, p).value().value(), f(p), 1e-11);
            const auto value = [&](glm::dvec3 at) { return linear(geometry, filtered, at).value(); };
            for (const GradientSpan span : {GradientSpan::Neighbours, GradientSpan::Wide}) {
                const glm::dvec3 slope = gradient(value, p, gradientStencil(kind, span));
                EXPECT_NEAR(slope.x, 2, 1e-11);
                EXPECT_NEAR(slope.y, -3, 1e-11);
                EXPECT_NEAR(slope.z, 0.25, 1e-11);
            }
        }
    }
}

// What makes the prefilter one: with it the linear filters have no error of second order on average over a cell.
TEST(Reconstruct, PrefilterRemovesTheMeanErrorOnQuadratics) {
    const auto f = [](glm::dvec3 p) { return p.x * p.x + p.y * p.z - 2 * p.z * p.z; };
    for (const LatticeKind kind : kKinds) {
        const LevelGeometry geometry{kind, 1, 0};
        const auto samples = endless(kind, f);
        const Prefiltered filtered(samples, geometry);
        double mean = 0, plain = 0;
        const int n = 16;
        for (int k = 0; k < n; ++k)
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) {
                    const glm::dvec3 p = (glm::dvec3(i, j, k) + 0.5) / double(n);
                    mean += linear(geometry, filtered, p).value().value() - f(p);
                    plain += linear(geometry, samples, p).value().value() - f(p);
                }
        EXPECT_NEAR(mean / (n * n * n), 0, 1e-3);
        EXPECT_GT(std::abs(plain / (n * n * n)), 0.1);
    }
}

TEST(Reconstruct, TetrahedralInterpolatesAndIsContinuous) {
    std::mt19937 random(2);
    const LevelGeometry geometry{LatticeKind::BCC, 1, 0};
    const auto hash = [](glm::ivec3 at) {
        const unsigned h = unsigned(at.x) * 73856093u ^ unsigned(at.y) * 19349663u ^ unsigned(at.z) * 83492791u;
        return Sample{double((h * 2654435761u) >> 8) / (1 << 24), true};
    };
    for (int k = -5; k < 5; ++k)
        for (int j = -4; j < 4; ++j)
            for (int i = -4; i < 4; ++i) {
                const double half = k & 1 ? 0.5 : 0;
                EXPECT_EQ(tetrahedral(geometry, hash, {i + half, j + half, k * 0.5}).value(), hash({i, j, k}).value);
            }
    for (int n = 0; n < 2000; ++n) {
        const glm::dvec3 p = randomPoint(random, -3, 3), q = p + randomPoint(random, -1e-6, 1e-6);
        const Blend blend = tetrahedral(geometry, hash, p);
        EXPECT_NEAR(blend.coverage, 1, 1e-12);
        EXPECT_NEAR(blend.sum, tetrahedral(geometry, hash, q).sum, 2e-5);
    }
}

TEST(Reconstruct, NearestAgreesWithTheLattice) {
    std::mt19937 random(4);
    for (const LatticeKind kind : kKinds) {
        Lattice lattice = ccLattice({7, 6, 9}, {1, 0.1, 30});
        if (kind == LatticeKind::BCC) lattice = bccFor(lattice);
        Field field = makeField(lattice, ScalarType::I32);
        for (std::size_t i = 0; i < field.count(); ++i) field.as<std::int32_t>()[i] = std::int32_t(i);
        for (int n = 0; n < 1000; ++n) {
            const glm::dvec3 cells = randomPoint(random, 0, 2.9); // of at least 3.5
            const glm::ivec3 at = lattice.nearest(lattice.fromCells(cells));
            EXPECT_EQ(nearest({kind, 1, 0}, FieldSamples{field}, cells).value, double(lattice.index(at)));
        }
    }
}

// A constant stays that constant through every filter, whatever is absent around it; absence follows the coverage.
TEST(Reconstruct, AbsentSamplesTakeNoPart) {
    std::mt19937 random(5);
    for (const LatticeKind kind : kKinds) {
        Lattice lattice = ccLattice({9, 9, 9});
        if (kind == LatticeKind::BCC) lattice = bccFor(lattice);
        Field field = sampled<float>(lattice, [](glm::dvec3) { return 7.5; });
        test::removeWhere(field, [&](glm::dvec3) { return random() % 2 == 0; });
        for (std::size_t i = 0; i < field.count(); ++i)
            if (!field.present(i)) field.as<float>()[i] = NAN;
        const LevelGeometry geometry{kind, 1, 0};
        const FieldSamples samples{field};
        const Prefiltered filtered(samples, geometry);
        const auto presence = [&](glm::ivec3 at) { return Sample{samples(at).present ? 1.0 : 0.0, true}; };
        int absent = 0;
        for (int n = 0; n < 1000; ++n) {
            const glm::dvec3 p = randomPoint(random, 0, 5);
            const double coverage = linear(geometry, presence, p).sum;
            for (const std::optional<double>& value :
                 {linear(geometry, samples, p).value(), linear(geometry, filtered, p).value()}) {
                ASSERT_EQ(value.has_value(), coverage >= kPresentCoverage);
                if (value) {
                    EXPECT_DOUBLE_EQ(*value, 7.5);
                }
                absent += value ? 0 : 1;
            }
            const double corners = tetrahedral(geometry, presence, p).sum;
            const std::optional<double> four = tetrahedral(geometry, samples, p).value();
            ASSERT_EQ(four.has_value(), corners >= kPresentCoverage);
            if (four) {
                EXPECT_DOUBLE_EQ(*four, 7.5);
            }
        }
        EXPECT_GT(absent, 100);
    }
}

TEST(Reconstruct, GradientIsOneSidedAtABorder) {
    const auto value = [](glm::dvec3 p) -> std::optional<double> {
        if (p.x > 1) return std::nullopt;
        return 3 * p.x + p.y;
    };
    for (const LatticeKind kind : kKinds)
        for (const GradientSpan span : {GradientSpan::Neighbours, GradientSpan::Wide}) {
            const GradientStencil stencil = gradientStencil(kind, span);
            const glm::dvec3 slope = gradient(value, {0.9, 0, 0}, stencil);
            EXPECT_NEAR(slope.x, 3, 1e-12);
            EXPECT_NEAR(slope.y, 1, 1e-12);
            EXPECT_NEAR(slope.z, 0, 1e-12);
            EXPECT_EQ(gradient(value, {5, 0, 0}, stencil), glm::dvec3(0));
        }
}

// The prefilter of gathered bricks is the prefilter of the whole field: bricks, levels, masks, borders of the lattice.
TEST(Prefilter, OfABrickEqualsThatOfTheLattice) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (const LatticeKind kind : kKinds)
        for (const bool holes : {false, true})
            for (const glm::ivec3 size : {glm::ivec3(1), glm::ivec3(2, 3, 5), glm::ivec3(17, 9, 21)}) {
                Lattice lattice = ccLattice(size);
                if (kind == LatticeKind::BCC) lattice = bccFor(lattice);
                Field field = sampled<float>(lattice, [&](glm::dvec3) { return uniform(random); });
                if (holes) test::removeWhere(field, [&](glm::dvec3) { return random() % 3 == 0; });
                const auto source = makeMemorySource(test::datasetOf({field}), {kind, 8, 1 << 30});
                const BrickGrid& grid = source->grid();
                const FieldSamples samples{field};
                const Prefiltered whole(samples, levelGeometry(grid, 0));
                const glm::ivec3 count = grid.count(), halo(1, 1, kind == LatticeKind::BCC ? 2 : 1);
                for (int n = 0; n < count.x * count.y * count.z; ++n) {
                    const BrickKey key{0, 0, 0, {n % count.x, n / count.x % count.y, n / (count.x * count.y)}};
                    const BrickSamples gathered =
                        gather(grid, key, 2, [&](const BrickKey& k) { return source->read(k); });
                    const BrickSamples brick = prefilter(gathered, levelGeometry(grid, 0));
                    ASSERT_EQ(brick.size, gathered.size - 2 * halo);
                    const glm::ivec3 first = grid.levelBegin(key.index, 0) - halo;
                    std::size_t i = 0;
                    for (int z = 0; z < brick.size.z; ++z)
                        for (int y = 0; y < brick.size.y; ++y)
                            for (int x = 0; x < brick.size.x; ++x, ++i) {
                                const Sample expected = whole(first + glm::ivec3(x, y, z));
                                ASSERT_EQ(brick.isPresent(i), expected.present);
                                ASSERT_FLOAT_EQ(brick.values[i], float(expected.value));
                            }
                }
            }
}

TEST(Reconstruct, CosineWeightsKeepTheSamples) {
    std::mt19937 random(11);
    const auto samples = endless(LatticeKind::BCC, [](glm::dvec3 p) { return std::sin(3 * p.x + p.y) + p.z * p.z; });
    const LevelGeometry geometry{LatticeKind::BCC, 1, 0};
    for (int n = 0; n < 200; ++n) {
        const glm::ivec3 at(random() % 9, random() % 9, random() % 9);
        const double half = at.z & 1 ? 0.5 : 0;
        const glm::dvec3 cells(at.x + half, at.y + half, at.z * 0.5);
        EXPECT_NEAR(cosineWeighted(geometry, samples, cells).value().value(), samples(at).value, 1e-12);
    }
}

TEST(Reconstruct, TheQuinticBoxSplineIsThirtyTwoSmoothWeights) {
    std::mt19937 random(12);
    for (int n = 0; n < 200; ++n) {
        const glm::dvec3 p = randomPoint(random, -2, 2);
        double sum = 0;
        int used = 0;
        for (int z = -7; z <= 7; ++z)
            for (int y = -7; y <= 7; ++y)
                for (int x = -7; x <= 7; ++x) {
                    if (((x ^ z) & 1) != 0 || ((y ^ z) & 1) != 0) continue;
                    const double weight = quinticBoxSpline(p - glm::dvec3(x, y, z));
                    EXPECT_GE(weight, -1e-12);
                    sum += weight;
                    used += weight > 1e-12 ? 1 : 0;
                }
        EXPECT_NEAR(sum, 1, 1e-12);
        EXPECT_LE(used, 32);
        EXPECT_GE(used, 15);
        EXPECT_NEAR(quinticBoxSpline(p), quinticBoxSpline({-p.y, p.z, p.x}), 1e-12); // as symmetric as the lattice
        const auto along = [&](double t) { return quinticBoxSpline(p + t * glm::dvec3(0.3, -0.8, 0.5)); };
        const double h = 1e-3, before = (along(0) - 2 * along(-h) + along(-2 * h)) / (h * h),
                     after = (along(2 * h) - 2 * along(h) + along(0)) / (h * h);
        EXPECT_NEAR(before, after, 0.02); // the second derivative does not jump
    }
}

TEST(Reconstruct, ThePrefilteredQuinticBoxSplineReproducesCubics) {
    std::mt19937 random(13);
    const LevelGeometry geometry{LatticeKind::BCC, 1, 0};
    const auto cubic = [](glm::dvec3 p) {
        return p.x * p.x * p.x - 2 * p.x * p.y * p.z + p.y * p.z * p.z + 3 * p.x * p.x - p.y * p.z + p.z;
    };
    const auto samples = endless(LatticeKind::BCC, cubic);
    const Prefiltered filtered(samples, geometry);
    for (int n = 0; n < 300; ++n) {
        const glm::dvec3 p = randomPoint(random, -2, 2);
        EXPECT_NEAR(quinticBox(geometry, filtered, p).value().value(), cubic(p), 1e-10);
    }
    const auto quartic = [](glm::dvec3 p) { return p.x * p.x * p.x * p.x; };
    const auto more = endless(LatticeKind::BCC, quartic);
    const Prefiltered moreFiltered(more, geometry);
    double worst = 0;
    for (int n = 0; n < 100; ++n) {
        const glm::dvec3 p = randomPoint(random, -2, 2);
        worst = std::max(worst, std::abs(quinticBox(geometry, moreFiltered, p).value().value() - quartic(p)));
    }
    EXPECT_GT(worst, 0.01);
}

// Errors measured with a program of its own: 41^3 CC against BCC with 70.7 % of the samples, in |x|, |y|, |z| <= 0.8
// (outside, in the corners, the rings pass the Nyquist frequency).
TEST(LatticeError, FiguresOfMarschnerLobb) {
    const double cc = 2.0 / 40, bcc = kBccSpacing * cc;
    const Box box{glm::dvec3(-0.8), glm::dvec3(0.8)};
    struct Row {
        double fM;
        LatticeKind kind;
        LatticeFilter filter;
        double rms;
    };
    const Row rows[] = {{3, LatticeKind::CC, LatticeFilter::Linear, 0.00927},
                        {3, LatticeKind::CC, LatticeFilter::Quasi, 0.00417},
                        {3, LatticeKind::BCC, LatticeFilter::Linear, 0.01618},
                        {3, LatticeKind::BCC, LatticeFilter::Quasi, 0.00470},
                        {3, LatticeKind::BCC, LatticeFilter::Tetrahedral, 0.00967},
                        {6, LatticeKind::CC, LatticeFilter::Linear, 0.0317},
                        {6, LatticeKind::BCC, LatticeFilter::Linear, 0.0450},
                        {6, LatticeKind::BCC, LatticeFilter::Quasi, 0.0328},
                        {3, LatticeKind::CC, LatticeFilter::Cubic, 0.00034},
                        {3, LatticeKind::BCC, LatticeFilter::Cubic, 0.00021},
                        {6, LatticeKind::CC, LatticeFilter::Cubic, 0.0168},
                        {6, LatticeKind::BCC, LatticeFilter::Cubic, 0.0279},
                        {3, LatticeKind::BCC, LatticeFilter::Resampled, 0.00601},
                        {3, LatticeKind::BCC, LatticeFilter::Corrected, 0.00233},
                        {6, LatticeKind::BCC, LatticeFilter::Resampled, 0.0402},
                        {6, LatticeKind::BCC, LatticeFilter::Corrected, 0.0303}};
    for (const Row& row : rows) {
        const MarschnerLobb signal{0.25, row.fM};
        const LatticeError error = latticeError([&](glm::dvec3 p) { return signal(p); }, row.kind,
                                                row.kind == LatticeKind::CC ? cc : bcc, row.filter, box, 20000);
        EXPECT_NEAR(error.rms, row.rms, 0.03 * row.rms)
            << row.fM << " " << kLatticeNames[int(row.kind)] << " " << kLatticeFilterNames[int(row.filter)];
        EXPECT_GT(error.max, error.rms);
    }
}

// Beside a border across which the signal jumps, nothing of the other region comes in, and one step is worth it there
// too.
TEST(LatticeError, BesideABorderOfRegions) {
    const double cc = 2.0 / 40;
    const MarschnerLobb signal{0.25, 3};
    const glm::dvec3 normal = glm::normalize(glm::dvec3(1, 0.6, 0.35));
    const auto error = [&](LatticeKind kind, LatticeFilter filter) {
        return latticeErrorOfRegions([&](glm::dvec3 p, int region) { return region == 0 ? signal(p) : 3 + signal(-p); },
                                     [&](glm::dvec3 p) { return glm::dot(normal, p) - 0.1; }, kind,
                                     kind == LatticeKind::CC ? cc : kBccSpacing * cc, filter,
                                     {glm::dvec3(-0.8), glm::dvec3(0.8)}, 2 * cc);
    };
    const LatticeError grid = error(LatticeKind::CC, LatticeFilter::Linear),
                       resampled = error(LatticeKind::BCC, LatticeFilter::Resampled),
                       corrected = error(LatticeKind::BCC, LatticeFilter::Corrected);
    EXPECT_LT(corrected.rms, 0.53 * grid.rms);
    EXPECT_LT(corrected.rms, 0.67 * resampled.rms);
    EXPECT_LT(corrected.max, 0.1); // the jump is 3
    EXPECT_GT(corrected.samples, 0.97 * grid.samples);
}

// Directions of gradients of the same signal: differences between the nearest neighbours bring them nearer to its own
// than ones over two cells, on BCC at 70.7 % of the samples as on CC.
TEST(LatticeError, DirectionsOfGradients) {
    const double cc = 2.0 / 56, bcc = kBccSpacing * cc;
    const Box box{glm::dvec3(-0.8), glm::dvec3(0.8)};
    const MarschnerLobb signal;
    const auto degrees = [&](LatticeKind kind, LatticeFilter filter, GradientSpan span) {
        return latticeGradientError([&](glm::dvec3 p) { return signal(p); },
                                    [&](glm::dvec3 p) { return signal.gradient(p); }, kind,
                                    kind == LatticeKind::CC ? cc : bcc, filter, span, box, 4000);
    };
    const double sharp = degrees(LatticeKind::BCC, LatticeFilter::Quasi, GradientSpan::Neighbours);
    EXPECT_LT(sharp, 0.6 * degrees(LatticeKind::BCC, LatticeFilter::Quasi, GradientSpan::Wide));
    EXPECT_LT(sharp, degrees(LatticeKind::CC, LatticeFilter::Quasi, GradientSpan::Neighbours));
    EXPECT_LT(degrees(LatticeKind::CC, LatticeFilter::Quasi, GradientSpan::Neighbours),
              0.8 * degrees(LatticeKind::CC, LatticeFilter::Quasi, GradientSpan::Wide));
    EXPECT_LT(degrees(LatticeKind::BCC, LatticeFilter::Tetrahedral, GradientSpan::Neighbours),
              degrees(LatticeKind::BCC, LatticeFilter::Tetrahedral, GradientSpan::Wide));
}

} // namespace
} // namespace tessera::volume
