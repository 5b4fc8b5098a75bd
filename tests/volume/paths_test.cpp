#include "volume/flow/paths.h"

#include "tests/volume/fields.h"
#include "volume/flow/even_lines.h"
#include "volume/flow/flow.h"
#include "volume/flow/flow_channels.h"
#include "volume/flow/seeds.h"
#include "volume/flow/streaks.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace tessera::volume {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// The way of the classical Runge-Kutta method with even steps, far finer than those under test.
glm::dvec3 classical(const ChangingField& field, glm::dvec3 place, double from, double to, int steps) {
    const double h = (to - from) / steps;
    for (int i = 0; i < steps; ++i) {
        const double t = from + i * h;
        const glm::dvec3 a = *field(place, t), b = *field(place + a * (h / 2), t + h / 2),
                         c = *field(place + b * (h / 2), t + h / 2), d = *field(place + c * h, t + h);
        place += (a + b * 2.0 + c * 2.0 + d) * (h / 6);
    }
    return place;
}

std::optional<glm::dvec3> helix(glm::dvec3 p, double) {
    return glm::dvec3(-p.y, p.x, 0.5);
}

/// A core of radius 2 that turns as a whole, a free vortex around it.
std::optional<glm::dvec3> rankine(glm::dvec3 p, double) {
    const double r = std::hypot(p.x, p.y), turn = r < 2 ? 1 : 4 / (r * r);
    return glm::dvec3(-p.y * turn, p.x * turn, 0.1);
}

/// Arnold, Beltrami and Childress.
std::optional<glm::dvec3> abc(glm::dvec3 p, double) {
    const double a = std::sqrt(3.0), b = std::sqrt(2.0), c = 1;
    return glm::dvec3(a * std::sin(p.z) + c * std::cos(p.y), b * std::sin(p.x) + a * std::cos(p.z),
                      c * std::sin(p.y) + b * std::cos(p.x));
}

double lengthOfPath(const std::vector<glm::dvec3>& line) {
    double sum = 0;
    for (std::size_t i = 1; i < line.size(); ++i) sum += glm::distance(line[i - 1], line[i]);
    return sum;
}

TEST(Paths, AgreeWithAnotherIntegrator) {
    for (const ChangingField& field : {ChangingField(helix), ChangingField(rankine), ChangingField(abc)})
        for (const glm::dvec3 seed : {glm::dvec3(1, 0, 0), glm::dvec3(1.9, 0.4, 1), glm::dvec3(-3, 2, 0.5)}) {
            const PathSettings settings{.cell = glm::dvec3(0.25)};
            const Pathline line = pathline(field, seed, 2, 0, 8, settings);
            ASSERT_EQ(line.times.front(), 0);
            ASSERT_EQ(line.times.back(), 8);
            const double bound = 1e-4 * lengthOfPath(line.places);
            EXPECT_LT(glm::distance(line.places.back(), classical(field, seed, 2, 8, 20000)), bound);
            EXPECT_LT(glm::distance(line.places.front(), classical(field, seed, 2, 0, 20000)), bound);
            // A streamline is the same curve: each of its vertices lies on the path.
            const auto stream =
                streamline([&](glm::dvec3 p) { return field(p, 0); }, seed, {.cell = glm::dvec3(0.25), .longest = 4});
            double time = 2;
            const auto at = std::size_t(std::ranges::find(stream, seed) - stream.begin());
            for (std::size_t i = at + 1; i < stream.size(); ++i) {
                const glm::dvec3 from = classical(field, seed, 2, time, 400);
                time += glm::distance(stream[i], from) / glm::length(*field(from, 0));
                for (int k = 0; k < 3; ++k) { // nearest point of the path
                    const glm::dvec3 p = classical(field, seed, 2, time, 400), u = *field(p, 0);
                    time += glm::dot(stream[i] - p, u) / glm::dot(u, u);
                }
                EXPECT_LT(glm::distance(stream[i], classical(field, seed, 2, time, 400)), 4e-4);
            }
        }
}

/// u = (cos t, 0, 0) stored at times so close that their straight lines are within 1e-6 of it.
std::shared_ptr<const BrickSource> oscillation(int stored) {
    const Lattice lattice = test::ccLattice({9, 5, 5}, glm::dvec3(1));
    Dataset dataset;
    dataset.info.lattice = lattice;
    dataset.info.bounds = test::boxOf(lattice);
    dataset.info.times.clear();
    for (int i = 0; i < stored; ++i) dataset.info.times.push_back(2 * kTurn * i / (stored - 1));
    dataset.info.parameters.resize(1);
    dataset.info.parameters[0].components = 3;
    dataset.read = [lattice, times = dataset.info.times](int, int component, int time) {
        return test::sampled<float>(
            lattice, [&](glm::dvec3) { return component > 0 ? 0.0 : std::cos(times[std::size_t(time)]); });
    };
    return makeMemorySource(std::move(dataset), {});
}

// Four times the flow comes to rest; seeds are placed then, too.
TEST(Paths, WaitWhereTheFlowRests) {
    const ChangingField swing = [](glm::dvec3, double t) -> std::optional<glm::dvec3> {
        return glm::dvec3(std::cos(t), 0, 0);
    };
    for (int i = 0; i < 200; ++i) {
        const double time = 2 * kTurn * i / 199;
        const Pathline line = pathline(swing, {4, 2, 2}, time, 0, 2 * kTurn, {});
        ASSERT_EQ(line.times.front(), 0) << i;
        ASSERT_EQ(line.times.back(), 2 * kTurn) << i;
        for (std::size_t v = 0; v < line.places.size(); ++v)
            EXPECT_NEAR(line.places[v].x, 4 + std::sin(line.times[v]) - std::sin(time), 1e-4) << i;
    }
    const Pathline atRest = pathline(swing, {4, 2, 2}, kTurn / 4, 0, 2 * kTurn, {});
    EXPECT_NEAR(lengthOfPath(atRest.places), 8, 0.05) << "there and back again";
}

TEST(Paths, NoStepCrossesAStoredTime) {
    const auto source = oscillation(81);
    const VectorSeries series(*source, 0, 0);
    const ChangingField field = [&](glm::dvec3 p, double t) { return series.at(p, t); };
    const std::vector<double>& times = source->info().times;
    const Pathline line = pathline(field, {4, 2, 2}, times[13], 0, times.back(), {.times = times});
    for (const double time : times) EXPECT_TRUE(std::ranges::binary_search(line.times, time)) << time;
    // What is stored is integrated exactly: by the trapezoids of the stored values.
    double x = 4;
    for (std::size_t i = 0; i < 13; ++i)
        x -= (times[i + 1] - times[i]) * (std::cos(times[i]) + std::cos(times[i + 1])) / 2;
    EXPECT_NEAR(line.places.front().x, x, 1e-5);
}

TEST(Paths, EndWhereTheFieldDoes) {
    // Absent beyond a wall, and, at rest, from a time on.
    const ChangingField field = [](glm::dvec3 p, double t) -> std::optional<glm::dvec3> {
        if (p.x > 6.25 || t > 7) return std::nullopt;
        return glm::dvec3(p.y > 0 ? 1 : 0, 0, 0);
    };
    const Pathline moving = pathline(field, {4, 1, 0}, 0, 0, 100, {});
    EXPECT_NEAR(moving.places.back().x, 6.25, 1.0 / 256);
    EXPECT_LE(moving.places.back().x, 6.25);
    const Pathline resting = pathline(field, {4, 0, 0}, 0, 0, 100, {});
    EXPECT_NEAR(resting.times.back(), 7, 0.05);
    EXPECT_FALSE(carried(field, {4, 1, 0}, 0, 3, {}));
    EXPECT_NEAR(carried(field, {4, 1, 0}, 0, 2, {})->x, 6, 1e-9);
    EXPECT_FALSE(carried(field, {7, 1, 0}, 0, 0, {})) << "nothing is there";
}

TEST(Paths, CountWhatStopsForTheNumberOfItsSteps) {
    const ChangingField turning = [](glm::dvec3 p, double) -> std::optional<glm::dvec3> {
        return glm::dvec3(-p.y, p.x, 0);
    };
    std::atomic<std::size_t> stopped = 0;
    PathSettings paths{.stopped = &stopped};
    StreamlineSettings lines{.longest = 60, .stopped = &stopped};
    const auto streamlineOf = [&] { return streamline([&](glm::dvec3 p) { return turning(p, 0); }, {4, 0, 0}, lines); };
    EXPECT_EQ(pathline(turning, {4, 0, 0}, 5, 0, 10, paths).times.back(), 10);
    EXPECT_GT(streamlineOf().size(), 100u);
    EXPECT_EQ(stopped, 0u);
    paths.mostSteps = 10;
    EXPECT_LT(pathline(turning, {4, 0, 0}, 5, 0, 10, paths).times.back(), 10);
    EXPECT_EQ(stopped, 2u) << "both ways";
    EXPECT_FALSE(carried(turning, {4, 0, 0}, 0, 10, paths));
    EXPECT_EQ(stopped, 3u);
    lines.mostSteps = 10;
    EXPECT_EQ(streamlineOf().size(), 21u);
    EXPECT_EQ(stopped, 5u);
}

// Smoke in a wind that turns with time: what was released at r is at the difference of the integrals.
TEST(Streaklines, OfATurningWindAreTheClosedForm) {
    const ChangingField wind = [](glm::dvec3, double t) -> std::optional<glm::dvec3> {
        return glm::dvec3(4 * std::cos(t), 4 * std::sin(t), 0.5);
    };
    const glm::dvec3 seed(1, 2, 3);
    const double now = 5;
    const auto pieces = streakline(wind, seed, 0, now, {});
    ASSERT_EQ(pieces.size(), 1u);
    const ParticleLine& line = pieces[0];
    EXPECT_EQ(line.marks.front(), 0);
    EXPECT_EQ(line.marks.back(), now);
    EXPECT_EQ(line.rows[0].back(), seed);
    for (std::size_t i = 0; i < line.marks.size(); ++i) {
        const double r = line.marks[i];
        const glm::dvec3 wanted =
            seed + glm::dvec3(4 * (std::sin(now) - std::sin(r)), 4 * (std::cos(r) - std::cos(now)), 0.5 * (now - r));
        EXPECT_LT(glm::distance(line.rows[0][i], wanted), 1e-4);
        if (i > 0) {
            EXPECT_LE(glm::distance(line.rows[0][i], line.rows[0][i - 1]), 1 + 1e-9) << "filled to a cell";
        }
    }
}

// A wall with a hole: what went through it is there, what did not is not, and nothing joins both sides.
TEST(Streaklines, FallApartWhereParticlesLeave) {
    const ChangingField field = [](glm::dvec3 p, double t) -> std::optional<glm::dvec3> {
        if (p.y > 2) return std::nullopt;
        return glm::dvec3(1, t > 4 && t < 5 && p.x < 1 ? 3 : 0, 0); // blown out of the field for a while
    };
    const auto pieces = streakline(field, {0, 0, 0}, 0, 10, {.path = {.times = {4, 5}}});
    ASSERT_EQ(pieces.size(), 2u);
    EXPECT_EQ(pieces[0].marks.front(), 0);
    EXPECT_EQ(pieces[1].marks.back(), 10);
    for (const ParticleLine& piece : pieces)
        for (std::size_t i = 0; i < piece.marks.size(); ++i) EXPECT_NEAR(piece.rows[0][i].x, 10 - piece.marks[i], 1e-4);
    // Blown for 2/3 of the time at least: released between 3.667 and 4.333.
    EXPECT_NEAR(pieces[0].marks.back(), 4 + 2.0 / 3 - 1, 0.26);
    EXPECT_NEAR(pieces[1].marks.front(), 5 - 2.0 / 3, 0.26);
}

TEST(Timelines, OfARotationTurnAsAWhole) {
    const ChangingField turning = [](glm::dvec3 p, double) -> std::optional<glm::dvec3> {
        return glm::dvec3(-p.y, p.x, 0);
    };
    const std::vector<double> moments{1, 1.5, 2};
    const auto pieces = timeline(turning, {1, 0, 0}, {40, 0, 0}, 1, moments, {});
    ASSERT_EQ(pieces.size(), 1u);
    for (std::size_t row = 0; row < moments.size(); ++row)
        for (std::size_t i = 0; i < pieces[0].marks.size(); ++i) {
            const double r = 1 + 39 * pieces[0].marks[i], angle = moments[row] - 1;
            EXPECT_LT(glm::distance(pieces[0].rows[row][i], r * glm::dvec3(std::cos(angle), std::sin(angle), 0)),
                      2e-4 * r);
        }
}

// A shear draws a line of seeds out; particles are inserted where they part.
TEST(Timelines, GetMoreParticlesWhereTheyPart) {
    const ChangingField shear = [](glm::dvec3 p, double t) -> std::optional<glm::dvec3> {
        return glm::dvec3(20 * p.y * p.y * std::cos(t), 0, 0);
    };
    const auto pieces = timeline(shear, {0, 0, 0}, {0, 3, 0}, 0, {kTurn / 4}, {});
    ASSERT_EQ(pieces.size(), 1u);
    const std::vector<glm::dvec3>& row = pieces[0].rows[0];
    EXPECT_GT(row.size(), 180u);
    EXPECT_LT(row.size(), 800u);
    for (std::size_t i = 0; i < row.size(); ++i) {
        const double y = 3 * pieces[0].marks[i];
        EXPECT_NEAR(row[i].x, 20 * y * y, 1e-2);
        if (i > 0) {
            EXPECT_LE(glm::distance(row[i], row[i - 1]), 1 + 1e-9);
        }
    }
}

TEST(FlowUnits, ConvertOrSayThatTheyDoNot) {
    DatasetInfo info;
    info.lengthUnit = "mm";
    info.timeUnit = "s";
    Parameter vector;
    vector.name = "U";
    vector.unit = "m/s";
    vector.components = 3;
    EXPECT_DOUBLE_EQ(flowUnits(info, vector).perTime, 1000);
    EXPECT_EQ(flowUnitsText(info, vector), "1 m/s = 1000 mm per s");
    info.timeUnit = "min";
    EXPECT_DOUBLE_EQ(flowUnits(info, vector).perTime, 60000);
    vector.unit = "";
    EXPECT_FALSE(flowUnits(info, vector).stated);
    EXPECT_EQ(flowUnits(info, vector).perTime, 1);
    EXPECT_EQ(flowUnitsText(info, vector),
              "U has no unit, lengths have mm, times min: a vector of 1 is taken as 1 mm per min");
    vector.unit = "kg/s";
    EXPECT_FALSE(flowUnits(info, vector).stated) << "no speed";
}

/// The least distance between vertices of different lines.
double leastBetween(const EvenLines& even) {
    double least = 1e300;
    for (std::size_t a = 0; a < even.lines.size(); ++a)
        for (std::size_t b = a + 1; b < even.lines.size(); ++b)
            for (const glm::dvec3& p : even.lines[a])
                for (const glm::dvec3& q : even.lines[b]) least = std::min(least, glm::distance(p, q));
    return least;
}

TEST(EvenLines, KeepTheirDistances) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(-1, 1);
    for (int trial = 0; trial < 6; ++trial) {
        const bool flat = trial % 2 == 0;
        const double separation = flat ? 0.6 : 1.2;
        const glm::dvec3 wave(any(random), any(random), any(random));
        const VectorField field = [&](glm::dvec3 p) -> std::optional<glm::dvec3> {
            if (glm::any(glm::lessThan(p, glm::dvec3(0))) || glm::any(glm::greaterThan(p, glm::dvec3(6))))
                return std::nullopt;
            return glm::dvec3(std::cos(wave.x * p.y), std::sin(wave.y * p.x), flat ? 0 : 0.3 * std::cos(wave.z * p.x));
        };
        const auto trace = [&](glm::dvec3 seed) {
            return streamline(field, seed, {.cell = glm::dvec3(0.2), .longest = 12});
        };
        const auto right = [](glm::dvec3 p) { return p.x > 1; };
        const EvenSettings settings{.from = {0, 0, flat ? 3 : 0}, .to = {6, 6, flat ? 3 : 6}, .separation = separation};
        const EvenLines even = evenLines(trace, right, settings);
        ASSERT_GT(even.lines.size(), 4u);
        for (std::size_t i = 0; i < even.seeds.size(); ++i) {
            EXPECT_TRUE(right(even.seeds[i]));
            if (flat) {
                EXPECT_EQ(even.seeds[i].z, 3);
            }
            for (std::size_t j = 0; j < i; ++j) {
                EXPECT_GE(glm::distance(even.seeds[i], even.seeds[j]), separation * 0.99);
            }
        }
        EXPECT_GE(leastBetween(even), separation * 0.5 * 0.95);
        // No room is left: every place is nearer than the separation, but for its grid, to a line.
        for (int i = 0; i < 200; ++i) {
            glm::dvec3 place(3.5 + 2.5 * any(random), 3 + 3 * any(random), 3 + 3 * any(random));
            if (flat) place.z = 3;
            double nearest = 1e300;
            for (const auto& line : even.lines)
                for (const glm::dvec3& p : line) nearest = std::min(nearest, glm::distance(p, place));
            EXPECT_LT(nearest, separation * 1.9);
        }
        EXPECT_EQ(evenLines(trace, right, settings).seeds, even.seeds) << "the same each time";
    }
}

TEST(EvenLines, OfAVortexDoNotRunOverThemselves) {
    const auto trace = [](glm::dvec3 seed) {
        return streamline([](glm::dvec3 p) -> std::optional<glm::dvec3> { return glm::dvec3(-p.y, p.x, 0); }, seed,
                          {.cell = glm::dvec3(0.2), .longest = 200});
    };
    const EvenLines even =
        evenLines(trace, [](glm::dvec3) { return true; }, {.from = {-3, -3, 0}, .to = {3, 3, 0}, .separation = 0.7});
    for (const auto& line : even.lines) {
        EXPECT_LT(lengthOfPath(line), std::max(kTurn * glm::length(line.front()), 1.1) + 0.9) << "once around";
    }
}

TEST(Seeds, EvenOnesKeepTheDistanceAsDrawn) {
    const glm::dvec3 proportions(1, 4, 2);
    const SeedSettings settings{.shape = SeedShape::Even,
                                .from = {0, 0, 0},
                                .to = {8, 1, 3},
                                .proportions = proportions,
                                .count = 10000,
                                .separation = 0.9};
    const auto seeds = placeSeeds(settings, [](glm::dvec3 p) { return p.x > 2 ? 0.3 : 0.0; });
    EXPECT_GT(seeds.size(), 100u);
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        EXPECT_GT(seeds[i].x, 2);
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_GE(glm::distance(seeds[i] * proportions, seeds[j] * proportions), 0.9 * (1 - 1e-9));
    }
}

} // namespace
} // namespace tessera::volume
