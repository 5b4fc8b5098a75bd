#include "volume/resample/series.h"

#include "tests/volume/fields.h"
#include "volume/analysis/lattice_error.h"
#include "volume/resample/hyperplane.h"
#include "volume/resample/series_dataset.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <gtest/gtest.h>
#include <random>

namespace tessera::volume {
namespace {

using Function4 = std::function<double(glm::dvec4)>;

Lattice4 ccLattice4(glm::ivec4 size) {
    return {LatticeKind4::CC, size, glm::dvec4(1), glm::dvec4(0)};
}

template <class T> Series seriesOf(const Lattice4& lattice, const Function4& value) {
    return {lattice, false, [=](int frame) {
                return std::make_shared<const Field>(test::sampled<T>(
                    lattice.grid(frame), [&](glm::dvec3 p) { return value(glm::dvec4(p, lattice.time(frame))); }));
            }};
}

/// Every sample of a field inside the box of `cc`, with its position.
template <class Visit> void forInside(const Field& field, const Lattice4& cc, double margin, const Visit& visit) {
    const glm::dvec3 last(cc.size - 1);
    for (int k = 0; k < field.lattice.size.z; ++k)
        for (int j = 0; j < field.lattice.size.y; ++j)
            for (int i = 0; i < field.lattice.size.x; ++i) {
                const glm::dvec3 p = field.lattice.position({i, j, k});
                if (glm::any(glm::lessThan(p, glm::dvec3(margin))) ||
                    glm::any(glm::greaterThan(p, last - glm::dvec3(margin))))
                    continue;
                visit(p, field.value(field.lattice.index({i, j, k})));
            }
}

TEST(Lattice4, SizesAreThoseOfTheKidney) {
    const Lattice4 d4 = d4For(ccLattice4({90, 90, 80, 64}));
    EXPECT_EQ(d4.size, glm::ivec4(63, 63, 56, 93));
    EXPECT_NEAR(double(d4.count()) / (90.0 * 90 * 80 * 64), 0.5, 0.01);
    EXPECT_EQ(d4For(ccLattice4({1, 2, 3, 1})).size, glm::ivec4(1, 1, 2, 3));
    for (const int times : {2, 3, 8, 24, 64}) { // both grids of frames reach from the first time to the last
        const Lattice4 of = d4For(ccLattice4({4, 4, 4, times}));
        EXPECT_DOUBLE_EQ(of.time(1), 0);
        EXPECT_LT(of.time(0), 0);
        EXPECT_GE(of.time(of.size.w - 2), times - 1);
        EXPECT_LT(of.time(of.size.w - 3), times - 1);
    }
}

TEST(Lattice4, FramesFormTheStoredBcc) {
    const Lattice4 d4 = d4For({LatticeKind4::CC, {20, 17, 23, 9}, {0.5, 2, 1, 0.1}, {3, -1, 0, 5}});
    const Lattice bcc = d4.atOneTime();
    for (const int frame : {2, 3}) {
        const Lattice grid = d4.grid(frame);
        for (const glm::ivec3 at : {glm::ivec3(0), glm::ivec3(3, 5, 7)}) {
            const glm::dvec3 apart = grid.position(at) - bcc.position({at.x, at.y, 2 * at.z + frame % 2});
            EXPECT_LT(glm::length(apart), 1e-12);
        }
    }
    // Centred in the box of the grid it replaces.
    const glm::dvec3 first = bcc.position({0, 0, 0}),
                     last = bcc.position({bcc.size.x - 1, bcc.size.y - 1, bcc.size.z - 1});
    EXPECT_LT(glm::length(first + last - glm::dvec3(6 + 9.5, -2 + 32, 22)), 1e-9);
}

TEST(Series, LinearFunctionsSurviveD4AndComeBackAtAnyTime) {
    const Lattice4 cc = ccLattice4({14, 13, 12, 11});
    const Function4 plane = [](glm::dvec4 p) { return 1 + 2 * p.x - p.y + 0.5 * p.z + 3 * p.w; };
    const Series source = seriesOf<float>(cc, plane);
    const Lattice4 d4 = d4For(cc);
    for (const ResampleFilter filter : {ResampleFilter::Linear, ResampleFilter::Cubic, ResampleFilter::BSpline5}) {
        const Series stored{d4, false, [&](int frame) {
                                return std::make_shared<const Field>(toD4Frame(source, d4, frame, {.filter = filter}));
                            }};
        for (const int frame : {0, 1, 5}) {
            const auto field = stored.frame(frame);
            ASSERT_EQ(field->lattice, d4.grid(frame));
            forInside(*field, cc, 0, [&](glm::dvec3 p, double value) {
                ASSERT_NEAR(value, plane(glm::dvec4(p, d4.time(frame))), 1e-4);
            });
        }
        const double first = d4.time(1), last = d4.time(d4.size.w - 2);
        for (const TimeFilter time : {TimeFilter::Linear, TimeFilter::Cubic})
            for (double t = first; t <= last; t += 0.377) {
                const Field bcc = atTime(stored, t, time);
                ASSERT_EQ(bcc.lattice, d4.atOneTime());
                forInside(bcc, cc, 0,
                          [&](glm::dvec3 p, double value) { ASSERT_NEAR(value, plane(glm::dvec4(p, t)), 1e-4); });
                const Lattice any = test::ccLattice({7, 9, 8}, {1.1, 0.8, 0.9}, {2.5, 2.5, 2.5});
                const Field back = resample(bcc, any, ResampleFilter::Cubic);
                forInside(back, cc, 2.5,
                          [&](glm::dvec3 p, double value) { ASSERT_NEAR(value, plane(glm::dvec4(p, t)), 2e-4); });
            }
    }
}

TEST(Series, AFrameAtItsOwnTimeIsStoredBitForBit) {
    std::mt19937 random(5);
    const Lattice4 d4 = d4For(ccLattice4({9, 8, 7, 6}));
    std::vector<std::shared_ptr<const Field>> frames;
    for (int k = 0; k < d4.size.w; ++k)
        frames.push_back(std::make_shared<const Field>(
            test::sampled<std::uint16_t>(d4.grid(k), [&](glm::dvec3) { return double(random() % 65536); })));
    const Series series{d4, false, [&](int k) { return frames[std::size_t(k)]; }};
    const Field bcc = atTime(series, d4.time(3), TimeFilter::Cubic);
    for (int z = 0; z < d4.size.z; ++z)
        for (int x = 0; x < d4.size.x; ++x) {
            EXPECT_EQ(bcc.value(bcc.lattice.index({x, 2, 2 * z + 1})),
                      frames[3]->value(frames[3]->lattice.index({x, 2, z})));
            const std::size_t at = frames[2]->lattice.index({x, 2, z});
            const Field linear = atTime(series, d4.time(3), TimeFilter::Linear);
            EXPECT_NEAR(linear.value(linear.lattice.index({x, 2, 2 * z})),
                        0.5 * (frames[2]->value(at) + frames[4]->value(at)), 0.01);
        }
}

TEST(Series, TimeFiltersAreContinuousAndTheCubicOneCloser) {
    const Lattice4 d4 = d4For(ccLattice4({6, 6, 6, 40}));
    const Series series = seriesOf<float>(d4, [](glm::dvec4 p) { return std::sin(0.5 * p.w) + 0.1 * p.x; });
    double errors[2] = {0, 0};
    for (const TimeFilter filter : {TimeFilter::Linear, TimeFilter::Cubic}) {
        float before = 0;
        for (double t = 5; t < 35; t += 0.01) {
            const Field field = atTime(series, t, filter);
            const float value = field.as<float>()[field.lattice.index({2, 2, 4})];
            if (t > 5) {
                ASSERT_LT(std::abs(value - before), 0.0075);
            }
            before = value;
            const double truth = std::sin(0.5 * t) + 0.1 * field.lattice.position({2, 2, 4}).x;
            errors[int(filter)] = std::max(errors[int(filter)], std::abs(value - truth));
        }
    }
    EXPECT_LT(errors[1], 0.3 * errors[0]);
}

TEST(Series, NothingBleedsOverAMaskInTime) {
    // A region that is absent at some times; where it is, its bytes are far away.
    const Lattice4 cc = ccLattice4({10, 10, 10, 12});
    Series source = seriesOf<float>(cc, [](glm::dvec4 p) { return p.x < 4 ? 5 : p.w < 6 ? 1e6 : 50; });
    source.frame = [load = source.frame](int frame) {
        Field field = *load(frame);
        test::removeWhere(field, [&](glm::dvec3 p) { return frame < 6 && p.x >= 4; });
        return std::make_shared<const Field>(std::move(field));
    };
    const Lattice4 d4 = d4For(cc);
    const Series stored = remembering(
        {d4, false, [&](int frame) { return std::make_shared<const Field>(toD4Frame(source, d4, frame, {})); }}, 8);
    std::size_t early = 0, late = 0;
    for (double t = 0; t <= 11; t += 0.31)
        for (const TimeFilter filter : {TimeFilter::Linear, TimeFilter::Cubic}) {
            const Field field = atTime(stored, t, filter);
            for (std::size_t i = 0; i < field.count(); ++i) {
                if (!field.present(i)) continue;
                ASSERT_GE(field.value(i), 5 - 1e-3);
                ASSERT_LE(field.value(i), 50 + 1e-3);
                (t < 4.2 ? early : late) += field.value(i) > 6 ? 1 : 0;
            }
            ASSERT_TRUE(t > 5 || field.mask) << t;
            ASSERT_TRUE(t < 7.5 || !field.mask) << t;
        }
    EXPECT_EQ(early, 0u);
    EXPECT_GT(late, 1000u);
}

TEST(Series, LabelsStayLabels) {
    const Lattice4 cc = ccLattice4({10, 10, 10, 8});
    Series source = seriesOf<std::uint8_t>(cc, [](glm::dvec4 p) { return p.x < p.w ? 1 : 7; });
    source.categorical = true;
    const Lattice4 d4 = d4For(cc);
    Series stored{d4, true, [&](int frame) { return std::make_shared<const Field>(toD4Frame(source, d4, frame, {})); }};
    const Field field = atTime(stored, 3.3, TimeFilter::Cubic);
    EXPECT_EQ(field.type, ScalarType::U8);
    for (const std::uint8_t label : field.as<std::uint8_t>()) ASSERT_TRUE(label == 1 || label == 7);
}

TEST(Series, PrefilterReproducesLinesAndWeighsSixteenNeighbours) {
    const Lattice4 d4{LatticeKind4::D4, {6, 6, 6, 8}, glm::dvec4(1), glm::dvec4(0)};
    const Series lines = prefiltered(seriesOf<float>(d4, [](glm::dvec4 p) { return p.x - 2 * p.y + p.z + 3 * p.w; }));
    const auto frame = lines.frame(3);
    for (const glm::ivec3 at : {glm::ivec3(2), glm::ivec3(1, 3, 4)}) {
        const glm::dvec3 p = frame->lattice.position(at);
        EXPECT_NEAR(frame->value(frame->lattice.index(at)), p.x - 2 * p.y + p.z + 3 * 1.5, 1e-5);
    }
    // The answer to a single sample of one: 5/3 there, -1/24 on sixteen others.
    const Series impulse =
        prefiltered(seriesOf<float>(d4, [](glm::dvec4 p) { return p == glm::dvec4(3, 3, 3, 2) ? 1.0 : 0.0; }));
    int centres = 0, neighbours = 0;
    for (int k = 0; k < 8; ++k) {
        const auto answer = impulse.frame(k);
        for (const float value : answer->as<float>()) {
            if (value == 0) continue;
            if (value > 0) {
                EXPECT_NEAR(value, 5.0 / 3, 1e-6);
                ++centres;
            } else {
                EXPECT_NEAR(value, -1.0 / 24, 1e-6);
                ++neighbours;
            }
        }
    }
    EXPECT_EQ(centres, 1);
    EXPECT_EQ(neighbours, 16);
}

TEST(Series, PrefilteredD4BeatsCcAtHalfTheSamples) {
    // A blob that moves: about six samples of CC across it.
    const Function4 blob = [](glm::dvec4 p) {
        const glm::dvec3 apart = glm::dvec3(p) - glm::dvec3(0.3 + 0.4 * p.w, 0.5, 0.6 - 0.2 * p.w);
        return std::exp(-glm::dot(apart, apart) / (2 * 0.14 * 0.14));
    };
    const double cell = 1.0 / 20;
    const auto errorOfD4 = [&](LatticeFilter4 filter) {
        return latticeError4(blob, LatticeKind4::D4, cell * kBccSpacing, filter, 20000);
    };
    const auto cc = latticeError4(blob, LatticeKind4::CC, cell, LatticeFilter4::Linear, 20000),
               plain = errorOfD4(LatticeFilter4::Linear), quasi = errorOfD4(LatticeFilter4::Quasi),
               drawn = errorOfD4(LatticeFilter4::Drawn);
    EXPECT_NEAR(quasi.samples / cc.samples, 0.5, 1e-9);
    EXPECT_GT(plain.rms, cc.rms);
    EXPECT_LT(quasi.rms, 0.35 * cc.rms) << cc.rms << " " << plain.rms << " " << quasi.rms;
    EXPECT_LT(drawn.rms, 1.1 * quasi.rms) << drawn.rms;
}

TEST(Hyperplane, SlicesLinearFunctionsInAnyDirection) {
    const Function4 value = [](glm::dvec4 p) { return 2 + p.x - 0.5 * p.y + 0.25 * p.z + 2 * p.w; };
    const Lattice4 cc = ccLattice4({11, 10, 9, 12});
    Lattice4 inner = d4For(cc);
    for (const Lattice4& lattice : {cc, inner}) {
        const Series series = seriesOf<float>(lattice, value);
        for (const Hyperplane& plane : {Hyperplane{{0, 0, 0, 1}, -4.3}, Hyperplane{{1, 0, 0, 0}, -5},
                                        Hyperplane{{1, -1, 0.5, 2}, -9}, Hyperplane{{0.2, 3, -0.4, 0.3}, -12}}) {
            const HyperplaneSlice slice = sliceBy(series, plane);
            const Lattice& grid = slice.field.lattice;
            std::size_t seen = 0;
            for (int k = 0; k < grid.size.z; ++k)
                for (int j = 0; j < grid.size.y; ++j)
                    for (int i = 0; i < grid.size.x; ++i) {
                        const std::size_t index = grid.index({i, j, k});
                        glm::dvec4 p(0);
                        for (int a = 0; a < 3; ++a) p[slice.axes[std::size_t(a)]] = grid.position({i, j, k})[a];
                        p[slice.solved] = -(glm::dot(plane.normal, p) + plane.e) / plane.normal[slice.solved];
                        const double last = lattice.size[slice.solved] - 1;
                        const bool inside = lattice.kind == LatticeKind4::D4 ||
                                            (p[slice.solved] >= -1e-9 && p[slice.solved] <= last + 1e-9);
                        if (lattice.kind == LatticeKind4::CC) {
                            ASSERT_EQ(slice.field.present(index), inside);
                        }
                        // On D4* the grids repeat their border samples within a cell of the faces.
                        if (lattice.kind == LatticeKind4::D4 &&
                            (glm::any(glm::lessThan(p, glm::dvec4(1.5))) ||
                             glm::any(glm::greaterThan(p, glm::dvec4(cc.size) - 2.5))))
                            continue;
                        if (!slice.field.present(index)) continue;
                        ++seen;
                        ASSERT_NEAR(slice.field.value(index), value(p), 1e-4);
                    }
            EXPECT_GT(seen, 50u);
        }
    }
    EXPECT_THROW(sliceBy(seriesOf<float>(cc, value), {{0, 0, 0, 0}, 1}), Error);
    EXPECT_THROW(sliceBy(seriesOf<float>(cc, value), {{0, 0, 0, 1}, 50}), Error);
}

// Frames at uneven times: a plane in times cuts between those around, on CC and on D4*, whose frames lie between.
TEST(Hyperplane, HeedsUnevenTimes) {
    const std::vector<double> uneven = {0, 1, 10, 11, 30, 32};
    const Lattice4 cc = ccLattice4({4, 3, 5, int(uneven.size())});
    const auto atFrame = [&](glm::dvec4 p) { return timeAt(uneven, p.w) + 100 * p.x; };
    const Series series = seriesOf<float>(cc, atFrame);
    for (const double time : {0.0, 0.3, 1.0, 4.0, 10.5, 29.0, 32.0}) {
        const HyperplaneSlice slice = sliceBy(series, {{0, 0, 0, 1}, -time}, uneven);
        ASSERT_EQ(slice.solved, 3);
        for (int x = 0; x < 4; ++x)
            EXPECT_NEAR(slice.field.value(slice.field.lattice.index({x, 1, 2})), time + 100 * x, 1e-4) << time;
    }
    // Along t: even steps from the first to the last time.
    const HyperplaneSlice along = sliceBy(series, {{1, 0, 0, 0}, -1.5}, uneven);
    EXPECT_EQ(along.axes, (std::array{1, 2, 3}));
    const Lattice& grid = along.field.lattice;
    EXPECT_EQ(grid.size.z, 6);
    EXPECT_NEAR(grid.origin.z, 0, 1e-12);
    EXPECT_NEAR(grid.spacing.z, 6.4, 1e-12);
    for (int k = 0; k < 6; ++k) EXPECT_NEAR(along.field.value(grid.index({1, 1, k})), 6.4 * k + 150, 1e-4);
    // A plane that moves 2 along x in a unit of time.
    const HyperplaneSlice moving = sliceBy(series, {{-1, 0, 0, 2}, 1}, uneven);
    for (int x = 0; x < 4; ++x)
        if (moving.solved == 3) {
            EXPECT_EQ(moving.field.present(moving.field.lattice.index({x, 0, 0})), x >= 1);
            if (x >= 1) {
                EXPECT_NEAR(moving.field.value(moving.field.lattice.index({x, 0, 0})), 0.5 * (x - 1) + 100 * x, 1e-4);
            }
        }
    EXPECT_EQ(moving.solved, 3);
    EXPECT_THROW(sliceBy(series, {{0, 0, 0, 1}, -33}, uneven), Error);

    const Lattice4 d4 = d4For(ccLattice4({12, 12, 12, 12}));
    std::vector<double> frames;
    for (int frame = 0; frame < d4.size.w; ++frame) frames.push_back(std::pow(1.2, frame));
    const Series both = seriesOf<float>(
        d4, [&](glm::dvec4 p) { return timeAt(frames, (p.w - d4.time(0)) / (d4.time(1) - d4.time(0))); });
    for (int frame = 2; frame + 2 < d4.size.w; ++frame) {
        const HyperplaneSlice slice = sliceBy(both, {{0, 0, 0, 1}, -frames[std::size_t(frame)]}, frames);
        const double neighbours = 0.5 * (frames[std::size_t(frame) - 1] + frames[std::size_t(frame) + 1]);
        EXPECT_NEAR(slice.field.value(slice.field.lattice.index({5, 5, 5})),
                    0.5 * (frames[std::size_t(frame)] + neighbours), 1e-4)
            << "the frame itself, and those of the other grid around it";
    }
}

} // namespace
} // namespace tessera::volume
