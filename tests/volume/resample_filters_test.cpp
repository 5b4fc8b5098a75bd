#include "volume/resample/resample.h"
#include "volume/resample/resample_taps.h"
#include "volume/resample/spline_prefilter.h"

#include "tests/volume/fields.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <random>

namespace tessera::volume {
namespace {

using test::ccLattice;
using test::sampled;

std::vector<ResampleOptions> everyFilter() {
    std::vector<ResampleOptions> all;
    for (const ResampleFilter filter : {ResampleFilter::Nearest, ResampleFilter::Linear, ResampleFilter::Cubic,
                                        ResampleFilter::BSpline3, ResampleFilter::BSpline5})
        all.push_back({.filter = filter});
    for (int order = kLeastOrder; order <= kMostOrder; ++order) {
        all.push_back({.filter = ResampleFilter::Lagrange, .order = order});
        all.push_back({.filter = ResampleFilter::Sinc, .order = order});
    }
    return all;
}

std::string nameOf(const ResampleOptions& options) {
    return std::string(kResampleFilterNames[std::size_t(options.filter)]) + " " + std::to_string(options.order);
}

/// The line as the filter weighs it.
std::vector<double> weighed(std::vector<double> line, const ResampleOptions& options) {
    if (const int degree = splineDegree(options.filter)) splinePrefilter(line, degree);
    return line;
}

double valueAt(const std::vector<double>& weighed, double cells, const ResampleOptions& options) {
    const Tap tap = tapAt(cells, int(weighed.size()), options);
    double sum = 0;
    for (int k = 0; k < tap.count; ++k) sum += tap.weight[std::size_t(k)] * weighed[std::size_t(tap.first + k)];
    return sum;
}

TEST(ResampleFilters, WeightsSumToOneAndStayInside) {
    std::mt19937 random(1);
    for (const ResampleOptions& options : everyFilter())
        for (int count = 1; count < 24; ++count)
            for (int trial = 0; trial < 20; ++trial) {
                const double cells = std::uniform_real_distribution(-1.0, count + 1.0)(random);
                const Tap tap = tapAt(cells, count, options);
                ASSERT_EQ(tap.count, tapCount(options, count));
                ASSERT_GE(tap.first, 0);
                ASSERT_LE(tap.first + tap.count, count);
                double sum = 0;
                for (const double weight : tap.weight) sum += weight;
                ASSERT_NEAR(sum, 1, 1e-12) << nameOf(options) << " at " << cells << " of " << count;
            }
}

TEST(ResampleFilters, AllButNearestReproduceLinesEverywhere) {
    std::vector<double> line(20);
    for (std::size_t i = 0; i < line.size(); ++i) line[i] = 3 - 0.5 * double(i);
    for (const ResampleOptions& options : everyFilter()) {
        if (options.filter == ResampleFilter::Nearest) continue;
        // A windowed sinc keeps constants; lines only as far as the window lets it.
        const double allowed = options.filter == ResampleFilter::Sinc ? 0.08 : 1e-11;
        const auto ready = weighed(line, options);
        for (double cells = 0; cells <= 19; cells += 0.13)
            ASSERT_NEAR(valueAt(ready, cells, options), 3 - 0.5 * cells, allowed) << nameOf(options) << " at " << cells;
    }
}

TEST(ResampleFilters, SamplesAreKept) {
    std::mt19937 random(2);
    std::vector<double> line(17);
    for (double& value : line) value = std::uniform_real_distribution(-1.0, 1.0)(random);
    for (const ResampleOptions& options : everyFilter()) {
        const auto ready = weighed(line, options);
        for (std::size_t i = 0; i < line.size(); ++i)
            ASSERT_NEAR(valueAt(ready, double(i), options), line[i], 1e-12) << nameOf(options) << " at " << i;
    }
}

/// Largest error at a polynomial of a degree between samples `margin` from the ends.
double polynomialError(int degree, const ResampleOptions& options, int margin) {
    constexpr int kCount = 81;
    const auto polynomial = [&](double x) { return std::pow((x - 40) / 20, degree); };
    std::vector<double> line;
    for (int i = 0; i < kCount; ++i) line.push_back(polynomial(i));
    const auto ready = weighed(line, options);
    double worst = 0;
    for (double x = margin; x <= kCount - 1 - margin; x += 0.0937)
        worst = std::max(worst, std::abs(valueAt(ready, x, options) - polynomial(x)));
    return worst;
}

TEST(ResampleFilters, PolynomialsOfTheirDegreeAreReproducedAndNoOthers) {
    for (const ResampleOptions& options : everyFilter()) {
        if (options.filter == ResampleFilter::Nearest || options.filter == ResampleFilter::Sinc) continue;
        const int spline = splineDegree(options.filter);
        const int degree = spline > 0                                   ? spline
                           : options.filter == ResampleFilter::Lagrange ? options.order
                           : options.filter == ResampleFilter::Cubic    ? 2
                                                                        : 1;
        // Splines know of the end for as long as their pole rings, the cubic kernel for one sample.
        const int margin = spline > 0 ? 32 : options.filter == ResampleFilter::Cubic ? 2 : 0;
        for (int d = 0; d <= degree; ++d)
            EXPECT_LT(polynomialError(d, options, margin), spline > 0 ? 1e-11 : 1e-9) << nameOf(options) << " " << d;
        EXPECT_GT(polynomialError(degree + 1, options, margin), spline == 5 ? 1e-10 : 1e-9) << nameOf(options);
    }
}

TEST(ResampleFilters, HigherOrdersComeCloserToAWave) {
    std::vector<double> line;
    for (int i = 0; i < 64; ++i) line.push_back(std::sin(0.9 * i));
    const auto error = [&](const ResampleOptions& options) {
        const auto ready = weighed(line, options);
        double sum = 0;
        for (double x = 20; x < 44; x += 0.0571) {
            const double apart = valueAt(ready, x, options) - std::sin(0.9 * x);
            sum += apart * apart;
        }
        return std::sqrt(sum);
    };
    const double linear = error({.filter = ResampleFilter::Linear}), cubic = error({.filter = ResampleFilter::Cubic}),
                 spline3 = error({.filter = ResampleFilter::BSpline3}),
                 spline5 = error({.filter = ResampleFilter::BSpline5}),
                 lagrange7 = error({.filter = ResampleFilter::Lagrange, .order = 7}),
                 sinc6 = error({.filter = ResampleFilter::Sinc, .order = 6});
    EXPECT_LT(cubic, 0.4 * linear);
    EXPECT_LT(spline3, 0.5 * cubic);
    EXPECT_LT(spline5, 0.5 * spline3);
    EXPECT_LT(lagrange7, spline3);
    EXPECT_LT(sinc6, 0.6 * cubic);
}

TEST(ResampleFilters, SplineCoefficientsSolveTheInterpolationProblem) {
    std::mt19937 random(3);
    for (const std::size_t n : {3, 4, 5, 9, 40}) {
        std::vector<double> line(n);
        for (double& value : line) value = std::uniform_real_distribution(-1.0, 1.0)(random);
        for (const int degree : {3, 5}) {
            std::vector<double> c = line;
            splinePrefilter(c, degree);
            const auto at = [&](int i) { // point reflection at both ends, as often as needed
                double sign = 1, base = 0;
                const int last = int(n) - 1;
                while (i < 0 || i > last) {
                    const int face = i < 0 ? 0 : last;
                    base += sign * 2 * c[std::size_t(face)];
                    sign = -sign;
                    i = 2 * face - i;
                }
                return base + sign * c[std::size_t(i)];
            };
            for (int i = 0; i < int(n); ++i) {
                const double sum = degree == 3
                                       ? (at(i - 1) + 4 * at(i) + at(i + 1)) / 6
                                       : (at(i - 2) + 26 * at(i - 1) + 66 * at(i) + 26 * at(i + 1) + at(i + 2)) / 120;
                EXPECT_NEAR(sum, line[std::size_t(i)], 1e-12) << n << " " << degree << " " << i;
            }
        }
    }
}

TEST(ResampleFilters, EveryFilterRespectsMasks) {
    // Two constant regions with absent samples far away from both between them, across the diagonal.
    const Lattice cc = ccLattice({13, 12, 11});
    const auto side = [](glm::dvec3 p) { return p.x + p.y - 12; };
    Field field = sampled<float>(cc, [&](glm::dvec3 p) { return side(p) < 0 ? 20 : side(p) > 1 ? 200 : 1e6; });
    test::removeWhere(field, [&](glm::dvec3 p) { return side(p) >= 0 && side(p) <= 1; });
    for (const ResampleOptions& options : everyFilter())
        for (const Lattice& target : {bccFor(cc), ccLattice({20, 18, 17}, {0.63, 0.62, 0.6})}) {
            const Field out = resample(field, target, options);
            std::size_t present = 0;
            for (std::size_t i = 0; i < out.count(); ++i) {
                if (!out.present(i)) continue;
                ++present;
                const double value = out.value(i);
                ASSERT_TRUE(std::abs(value - 20) < 1e-3 || std::abs(value - 200) < 1e-3)
                    << nameOf(options) << " " << value;
            }
            EXPECT_GT(double(present), 0.6 * double(out.count()));
        }
}

TEST(ResampleFilters, FieldsAgreeWithTheTapsAlongALine) {
    std::mt19937 random(4);
    const Field line = sampled<std::uint8_t>(ccLattice({19, 1, 1}), [&](glm::dvec3) { return double(random() % 256); });
    std::vector<double> values;
    for (std::size_t i = 0; i < line.count(); ++i) values.push_back(line.value(i));
    const auto [lo, hi] = std::minmax_element(values.begin(), values.end());
    const Lattice target = ccLattice({30, 1, 1}, {0.61, 1, 1});
    for (const ResampleOptions& options : everyFilter()) {
        const Field out = resample(line, target, options);
        const auto ready = weighed(values, options);
        for (int i = 0; i < 30; ++i) {
            const double wanted = std::clamp(valueAt(ready, 0.61 * i, options), *lo, *hi);
            ASSERT_NEAR(out.value(std::size_t(i)), wanted, 0.51) << nameOf(options) << " " << i;
        }
    }
}

TEST(ResampleFilters, SharpeningRaisesEdgesAndKeepsConstants) {
    for (const bool bcc : {false, true}) {
        const Lattice cc = ccLattice({14, 12, 12});
        const Lattice lattice = bcc ? bccFor(cc) : cc;
        const Field flat = sampled<float>(lattice, [](glm::dvec3) { return 7.0; });
        EXPECT_EQ(sharpened(flat, 2).samples, flat.samples);
        // Lines are kept inside; a slope that bends gains contrast on both sides.
        const auto slope = [](glm::dvec3 p) { return std::tanh(p.x - 6.5); };
        const Field edge = sampled<float>(lattice, slope), more = sharpened(edge, 1);
        double raised = 0;
        for (int i = 2; i < lattice.size.x - 2; ++i) {
            const std::size_t at = lattice.index({i, 4, 4});
            const double x = lattice.position({i, 4, 4}).x - 6.5, gain = more.value(at) - edge.value(at);
            if (std::abs(x) > 0.3 && std::abs(x) < 2) {
                EXPECT_GT(gain * x, 0) << x;
            }
            raised = std::max(raised, std::abs(gain));
        }
        EXPECT_GT(raised, 0.05);
    }
    // Before and after differ, and both differ from none.
    const Lattice cc = ccLattice({14, 12, 12});
    const Field edge = sampled<float>(cc, [](glm::dvec3 p) { return std::tanh(p.x + 0.3 * p.y - 8); });
    const Field none = toBcc(edge, false), before = toBcc(edge, false, {.sharpen = 0.5}),
                after = toBcc(edge, false, {.sharpen = 0.5, .sharpenWhen = SharpenWhen::After});
    EXPECT_NE(none.samples, before.samples);
    EXPECT_NE(none.samples, after.samples);
    EXPECT_NE(before.samples, after.samples);
}

} // namespace
} // namespace tessera::volume
