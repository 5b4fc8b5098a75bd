#include "tests/volume/uneven.h"
#include "volume/analysis/contours.h"
#include "volume/analysis/region_statistics.h"
#include "volume/analysis/statistics.h"
#include "volume/bricks/sample_cells.h"
#include "volume/derived/derived.h"
#include "volume/derived/other_source.h"
#include "volume/flow/flow.h"
#include "volume/flow/sections.h"
#include "volume/reconstruct/probe.h"
#include "volume/reconstruct/sample_grid.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <random>

/// Numbers of data on axes of uneven spacing: layers of a fuel cell, as cells and as points.
namespace tessera::volume {
namespace {

using Of = AxisMap::Of;
using test::layeredLattice;
using test::unevenBox;
using test::unevenSource;

constexpr Of kBoth[] = {Of::Cells, Of::Points};

double linearAt(glm::dvec3 p) {
    return 300 + 2e3 * p.x - 1e4 * p.y + 4e4 * p.z;
}

/// Places between the first and the last sample of a lattice.
std::vector<glm::dvec3> placesWithin(const Lattice& lattice, int count) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> share(0, 1);
    const glm::dvec3 lo = lattice.position(glm::ivec3(0)), hi = lattice.position(lattice.size - 1);
    std::vector<glm::dvec3> out;
    for (int i = 0; i < count; ++i) {
        // As many in thin layers as in thick ones.
        const glm::dvec3 cells = glm::dvec3(lattice.size - 1) * glm::dvec3(share(random), share(random), share(random));
        out.push_back(glm::clamp(lattice.fromCells(cells), lo, hi));
    }
    return out;
}

Field linearField(const Lattice& lattice) {
    return test::sampled<float>(lattice, linearAt);
}

} // namespace

TEST(UnevenCells, TileTheBoxAndItsLayers) {
    for (const Of of : kBoth) {
        const Lattice lattice = layeredLattice(of);
        const Box box = unevenBox(lattice);
        for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
            for (const int level : {0, 1, 2}) {
                const BrickGrid grid{kind == LatticeKind::CC ? lattice : bccFor(lattice), 8, 3, 0.5};
                const SampleCells cells(grid, box, level);
                for (int s = 0; s < cells.sublattices(); ++s)
                    for (int axis = 0; axis < 3; ++axis) {
                        double sum = 0;
                        for (int i = 0; i < cells.count(s, axis); ++i) {
                            EXPECT_GE(cells.length(s, axis, i), 0);
                            sum += cells.length(s, axis, i);
                        }
                        EXPECT_NEAR(sum, box.hi[axis] - box.lo[axis], 1e-12 * (box.hi[axis] - box.lo[axis]));
                    }
            }
        const BrickGrid grid{lattice, 8, 3, 0.5};
        const SampleCells cells(grid, box, 0);
        for (int z = 0; z < lattice.size.z; ++z) {
            const AxisMap& map = *lattice.axes[2];
            EXPECT_NEAR(cells.length(0, 2, z), map.length(z), 1e-12 * map.length(z));
            EXPECT_NEAR(cells.border(0, 2, z), map.border(z), 1e-15);
        }
    }
}

TEST(UnevenProbe, ALinearFieldIsExactEverywhere) {
    for (const Of of : kBoth) {
        const Lattice lattice = layeredLattice(of);
        const auto source = unevenSource({linearField(lattice)});
        const std::vector<glm::dvec3> places = placesWithin(lattice, 10000);
        const std::vector<ProbeValue> values = probeAlong(*source, 0, places, 0);
        for (std::size_t i = 0; i < places.size(); ++i) {
            ASSERT_TRUE(values[i].interpolated);
            ASSERT_NEAR(*values[i].interpolated, linearAt(places[i]), 1e-4); // floats of 300
            const glm::ivec3 own = lattice.nearest(places[i]);
            ASSERT_NEAR(*values[i].nearest, linearAt(lattice.position(own)), 1e-4);
            const AxisMap& map = *lattice.axes[2];
            ASSERT_LE(map.border(own.z), places[i].z);
            ASSERT_GE(map.border(own.z + 1), places[i].z);
        }
        // A profile through all layers is straight.
        const Box box{lattice.position(glm::ivec3(0)), lattice.position(lattice.size - 1)};
        const std::vector<glm::dvec3> line = alongPolyline(std::array{box.lo, box.hi}, 501);
        const std::vector<ProbeValue> profile = probeAlong(*source, 0, line, 0);
        for (std::size_t i = 0; i < line.size(); ++i) ASSERT_NEAR(*profile[i].interpolated, linearAt(line[i]), 1e-4);
    }
}

// Cells along one axis, points along another.
TEST(UnevenProbe, AxesAreEachOfTheirKind) {
    const Lattice cells = layeredLattice(Of::Cells), points = layeredLattice(Of::Points);
    const Lattice lattice = withAxes(cells, {{points.axes.of[0], nullptr, cells.axes.of[2]}});
    const auto source = unevenSource({linearField(lattice)});
    for (const glm::dvec3 place : placesWithin(lattice, 2000))
        ASSERT_NEAR(*probeChannel(*source, 0, place, 0).interpolated, linearAt(place), 1e-4);
    StatisticsQuery query;
    query.channels = {0};
    const Box box = unevenBox(lattice);
    const double volume = (box.hi.x - box.lo.x) * (box.hi.y - box.lo.y) * (box.hi.z - box.lo.z);
    EXPECT_NEAR(computeStatistics(*source, query).channels[0].all.volume, volume, 1e-12 * volume);
    // Samples in the middle of cells: midpoints give the integral of a linear field in z and y; points in x do, too.
    const glm::dvec3 middle = 0.5 * (box.lo + box.hi);
    EXPECT_NEAR(computeStatistics(*source, query).channels[0].all.mean, linearAt(middle), 1e-3);
}

// A region ends where its last cell does, however thin the next one is: its values reach to the wall, for all who ask.
TEST(UnevenProbe, ValuesReachToTheWallOfTheirCells) {
    const Lattice lattice = layeredLattice(Of::Cells);
    const double wall = lattice.axes[2]->border(4); // cells of 5 um below, of 20 um and more above
    for (const bool above : {true, false}) {
        Field field = linearField(lattice);
        test::removeWhere(field, [&](glm::dvec3 p) { return (p.z > wall) != above; });
        const auto source = unevenSource({field});
        const SampleGrid grid = readSamples(*source, 0, 0, 0);
        for (const double beside : {1e-8, 1e-6, 2e-6, 4e-6, 8e-6}) {
            for (const double sign : {1.0, -1.0}) {
                const glm::dvec3 place(2e-3, 1e-3, wall + sign * beside);
                const bool there = (sign > 0) == above;
                EXPECT_EQ(probeChannel(*source, 0, place, 0).interpolated.has_value(), there) << above << beside * sign;
                EXPECT_EQ(valueAt(grid, place).has_value(), there) << above << beside * sign;
            }
        }
    }
}

// Coarser levels of a source lie on the same sheet: values between their samples are linear in space.
TEST(UnevenProbe, CoarseSamplesLieAtTheirPlacesInSpace) {
    const Lattice fine = layeredLattice(Of::Cells);
    Lattice coarse = fine;
    coarse.size = (fine.size + 1) / 2;
    coarse.spacing = 2.0 * fine.spacing;
    coarse.origin = fine.sheetOfCells(glm::dvec3(0.5));
    for (int z = 0; z < coarse.size.z; ++z) EXPECT_NEAR(coarse.between(coarse.position({1, 1, z})).z, z, 1e-9);
    for (const glm::dvec3 place : placesWithin(coarse, 500)) {
        const glm::dvec3 at = coarse.between(place);
        const int z = std::clamp(int(at.z), 0, coarse.size.z - 2);
        const double a = coarse.position({0, 0, z}).z, b = coarse.position({0, 0, z + 1}).z;
        EXPECT_NEAR(a + (at.z - z) * (b - a), place.z, 1e-12);
    }
}

TEST(UnevenProbe, PartsGoOnInAStraightLineBeyondTheirBorder) {
    for (const Of of : kBoth) {
        const Lattice lattice = layeredLattice(of);
        const double border = of == Of::Cells ? 1.035e-3 : lattice.axes[2]->border(4);
        const auto valueOf = [&](glm::dvec3 p) { return p.z < border ? linearAt(p) : 5000 - 3 * linearAt(p); };
        Dataset data = test::unevenDataset(
            {test::sampled<float>(lattice, valueOf),
             test::sampled<std::uint8_t>(lattice, [&](glm::dvec3 p) { return p.z < border ? 1 : 3; })});
        data.info.parameters[0].parts = {"p1", {{1}, {3}}};
        data.info.parameters[1].categorical = true;
        const auto source = makeMemorySource(data, {.brickSize = 8});
        const std::vector<glm::dvec3> places = placesWithin(lattice, 4000);
        const std::vector<ProbeValue> values = probeAlong(*source, 0, places, 0);
        int beside = 0;
        for (std::size_t i = 0; i < places.size(); ++i) {
            ASSERT_NEAR(*values[i].interpolated, valueOf(places[i]), 1e-3);
            beside += std::abs(places[i].z - border) < 3e-6 ? 1 : 0;
        }
        EXPECT_GT(beside, 50);
    }
}

TEST(UnevenContours, OfALinearFieldLieWhereItsLevelIs) {
    for (const Of of : kBoth) {
        const Lattice lattice = layeredLattice(of);
        std::vector<double> x, z;
        for (int i = 0; i < lattice.size.x; ++i) x.push_back(lattice.position({i, 0, 0}).x);
        for (int k = 0; k < lattice.size.z; ++k) z.push_back(lattice.position({0, 0, k}).z);
        PlaneValues plane{{lattice.size.x, lattice.size.z}, {}, {}};
        for (const double up : z)
            for (const double right : x) plane.values.push_back(linearAt({right, 0, up}));
        const double level = 371;
        std::size_t points = 0;
        for (const ContourLine& line : contourLines(plane, std::array{level}))
            for (const glm::dvec2 at : line.points) {
                EXPECT_NEAR(linearAt({placeOfNode(x, at.x), 0, placeOfNode(z, at.y)}), level, 1e-9);
                ++points;
            }
        EXPECT_GT(points, 10u);
    }
}

TEST(UnevenStatistics, AreOfVolume) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
        for (const Of of : kBoth) {
            const Lattice grid = layeredLattice(of), lattice = kind == LatticeKind::CC ? grid : bccFor(grid);
            const Box box = unevenBox(grid);
            Dataset data = test::unevenDataset(
                {test::sampled<float>(lattice, [](glm::dvec3) { return 4.0; }),
                 test::sampled<float>(lattice, [](glm::dvec3 p) { return linearAt(p) + 1e7 * p.z * p.z; }),
                 test::sampled<std::uint8_t>(lattice, [](glm::dvec3 p) {
                     return p.z < 1.025e-3 ? 1 : p.z < 1.035e-3 ? 2 : 3;
                 })});
            data.info.bounds = box;
            data.info.parameters[0].ranges = {{0, 8}};
            data.info.parameters[1].ranges = {{0, 500}};
            data.info.parameters[2].categorical = true;
            const auto source = makeMemorySource(data, {.lattice = kind, .brickSize = 8});
            const double volume = (box.hi.x - box.lo.x) * (box.hi.y - box.lo.y) * (box.hi.z - box.lo.z);
            StatisticsQuery query;
            query.channels = {0, 1};
            query.pairs = {{0, 1}};
            query.binsByVolume = true;
            const Statistics got = computeStatistics(*source, query);
            EXPECT_NEAR(got.channels[0].all.volume, volume, 1e-12 * volume);
            EXPECT_NEAR(got.channels[0].all.integral, 4 * volume, 1e-12 * volume);
            EXPECT_NEAR(got.channels[0].all.mean, 4, 1e-12);
            EXPECT_NEAR(got.channels[0].all.deviation, 0, 1e-6);
            EXPECT_EQ(got.channels[0].all.samples, double(lattice.count()));
            const Summary& all = got.channels[1].all;
            EXPECT_NEAR(all.mean, all.integral / all.volume, 1e-9);
            // Against sums over cells, written anew for CC.
            double sum = 0, squares = 0, byVolume = 0;
            if (kind == LatticeKind::CC) {
                const Field field = data.read(1, 0, 0);
                const auto length = [&](int axis, int i) {
                    const AxisMap* map = lattice.axes[axis];
                    const double half = i == 0 || i + 1 == lattice.size[axis] ? 0.5 : 1;
                    return map ? map->length(i) : lattice.spacing[axis] * half;
                };
                for (int z = 0; z < lattice.size.z; ++z)
                    for (int y = 0; y < lattice.size.y; ++y)
                        for (int x = 0; x < lattice.size.x; ++x) {
                            const double cell = length(0, x) * length(1, y) * length(2, z);
                            const double v = field.value(lattice.index({x, y, z}));
                            sum += cell * v;
                            squares += cell * v * v;
                        }
                EXPECT_NEAR(all.mean, sum / volume, 1e-9 * all.mean);
                EXPECT_NEAR(all.deviation, std::sqrt(squares / volume - sum / volume * sum / volume), 1e-6);
            }
            for (const double bin : got.channels[1].histogram.volume) byVolume += bin;
            EXPECT_NEAR(byVolume, volume, 1e-9 * volume);
            byVolume = 0;
            for (const double bin : got.joint[0].volume) byVolume += bin;
            EXPECT_NEAR(byVolume, volume, 1e-9 * volume);
            if (kind != LatticeKind::CC || of != Of::Cells) continue;
            const RegionStatistics regions = computeRegionStatistics(*source, {{1}, 2, {1, 2, 3}, 0, 0});
            const double area = (box.hi.x - box.lo.x) * (box.hi.y - box.lo.y);
            const double thickness[] = {25e-6, 10e-6, 1.7e-3};
            for (std::size_t r = 0; r < 3; ++r) {
                EXPECT_NEAR(regions.volume[r], area * thickness[r], 1e-12 * area * thickness[r]) << r;
                EXPECT_NEAR(regions.summary[r][0].mean, regions.summary[r][0].integral / regions.volume[r], 1e-9);
            }
        }
}

// A mean of point data counts half cells at the faces half, on even axes too.
TEST(UnevenStatistics, TheMeanOfPointsIsThatOfTheBox) {
    const Lattice lattice = test::ccLattice({5, 5, 5}, glm::dvec3(1));
    const auto source = makeMemorySource(
        test::datasetOf({test::sampled<float>(lattice, [](glm::dvec3 p) { return p.x == 0 ? 8.0 : 0.0; })}),
        {.brickSize = 8});
    StatisticsQuery query;
    query.channels = {0};
    EXPECT_NEAR(computeStatistics(*source, query).channels[0].all.mean, 8 * 0.5 / 4, 1e-12);
}

TEST(UnevenDerivatives, OfLinearAndQuadraticFieldsAreExact) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
        for (const Of of : kBoth) {
            const Lattice grid = layeredLattice(of), lattice = kind == LatticeKind::CC ? grid : bccFor(grid);
            const auto quadratic = [](glm::dvec3 p) {
                return 1e6 * (p.x - 2e-3) * (p.x - 2e-3) + 2e6 * (p.z - 2e-3) * (p.z - 2e-3);
            };
            Dataset data =
                test::unevenDataset({test::sampled<float>(lattice, [](glm::dvec3 p) { return linearAt(p) - 300; }),
                                     test::sampled<float>(lattice, quadratic)});
            data.info.bounds = unevenBox(grid);
            std::vector<std::string> messages;
            const auto source = deriveAll(makeMemorySource(data, {.lattice = kind, .brickSize = 8}),
                                          {{"g", "", GradientRecipe{"p0"}}, {"q", "", GradientRecipe{"p1"}}}, messages);
            ASSERT_TRUE(messages.empty());
            const auto at = [&](const char* name) {
                return readSamples(*source, *source->info().findChannel(name), 0, 0);
            };
            const SampleGrid gx = at("g.x"), gy = at("g.y"), gz = at("g.z"), qx = at("q.x"), qz = at("q.z");
            EXPECT_TRUE(gx.present.empty());
            const glm::ivec3 size = lattice.size;
            const int step = kind == LatticeKind::BCC ? 2 : 1;
            for (int z = 0; z < size.z; ++z)
                for (int y = 0; y < size.y; ++y)
                    for (int x = 0; x < size.x; ++x) {
                        const std::size_t i = lattice.index({x, y, z});
                        const glm::dvec3 p = lattice.position({x, y, z});
                        // Floats of up to 100 at distances of 5 um.
                        ASSERT_NEAR(gx.values[i], 2e3, 2);
                        ASSERT_NEAR(gy.values[i], -1e4, 2);
                        ASSERT_NEAR(gz.values[i], 4e4, 40) << z;
                        if (x > 0 && x + 1 < size.x) {
                            ASSERT_NEAR(qx.values[i], 2e6 * (p.x - 2e-3), 2);
                        }
                        if (z >= step && z + step < size.z) {
                            ASSERT_NEAR(qz.values[i], 4e6 * (p.z - 2e-3), 4);
                        }
                    }
        }
}

// k dT/dz on both sides of the membrane, whose border is that of a part: one-sided and exact.
TEST(UnevenDerivatives, AreOneSidedBesideOtherPartsAndAbsentWithoutNeighbours) {
    const Lattice lattice = layeredLattice(Of::Cells);
    const double border = 1.025e-3; // two cells of 12.5 um lie below
    const auto temperature = [&](glm::dvec3 p) { return (p.z - border) * (p.z < border ? 4e5 : 1e4); };
    Dataset data =
        test::unevenDataset({test::sampled<float>(lattice, temperature),
                             test::sampled<std::uint8_t>(lattice, [&](glm::dvec3 p) { return p.z < border ? 1 : 3; }),
                             test::sampled<float>(lattice, temperature)});
    data.info.parameters[0].parts = {"p1", {{1}, {3}}};
    data.info.parameters[1].categorical = true;
    // A membrane of one cell: nothing on either side.
    data.read = [read = data.read](int parameter, int component, int time) {
        Field field = read(parameter, component, time);
        if (parameter == 2)
            test::removeWhere(field, [](glm::dvec3 p) { return p.z < 1.02e-3 || (p.z > 1.03e-3 && p.z < 1.05e-3); });
        return field;
    };
    std::vector<std::string> messages;
    const auto source = deriveAll(makeMemorySource(data, {.brickSize = 8}),
                                  {{"g", "", GradientRecipe{"p0"}}, {"alone", "", GradientRecipe{"p2"}}}, messages);
    ASSERT_TRUE(messages.empty());
    const SampleGrid g = readSamples(*source, *source->info().findChannel("g.z"), 0, 0);
    for (int z = 0; z < lattice.size.z; ++z)
        EXPECT_NEAR(g.values[lattice.index({3, 3, z})], z < 2 ? 4e5 : 1e4, z < 2 ? 0.1 : 0.01) << z;
    const SampleGrid alone = readSamples(*source, *source->info().findChannel("alone.z"), 0, 0);
    for (int z = 0; z < lattice.size.z; ++z) {
        const double place = lattice.position({3, 3, z}).z;
        const bool there = place > 1.05e-3;
        EXPECT_EQ(alone.isPresent(lattice.index({3, 3, z})), there) << place;
    }
}

TEST(UnevenOther, DataOnOtherAxesAreCompared) {
    const Lattice cells = layeredLattice(Of::Cells), points = layeredLattice(Of::Points);
    const auto a = unevenSource({linearField(cells)}), b = unevenSource({linearField(cells)}),
               c = unevenSource({linearField(points)});
    EXPECT_TRUE(samePlaces(*a, *b));
    EXPECT_FALSE(samePlaces(*a, *c));
    Lattice even = cells;
    even.axes = {};
    EXPECT_FALSE(samePlaces(*a, *unevenSource({linearField(even)}))) << "the sheet is the same, space is not";
    const auto both = withOther(a, c);
    const SampleGrid other = readSamples(*both, 1, 0, 0);
    for (int z = 1; z + 1 < cells.size.z; ++z)
        EXPECT_NEAR(other.values[cells.index({4, 4, z})], linearAt(cells.position({4, 4, z})), 1e-3);
}

TEST(UnevenSections, AreOfTheAreasAndThicknessesOfSpace) {
    for (const Of of : kBoth) {
        const Lattice lattice = layeredLattice(of);
        const Box box = unevenBox(lattice);
        const auto source = unevenSource({linearField(lattice)});
        SectionQuery query;
        query.channels = {0};
        const Sections across = computeSections(*source, query);
        const double area = (box.hi.x - box.lo.x) * (box.hi.y - box.lo.y);
        double integral = 0;
        for (std::size_t p = 0; p < across.place.size(); ++p) {
            EXPECT_NEAR(across.place[p], lattice.axes[2]->sample(int(p)), 1e-15);
            EXPECT_NEAR(across.thickness[p], lattice.axes[2]->length(int(p)), 1e-15);
            EXPECT_NEAR(across.values[0][0][p].area, area, 1e-12 * area);
            integral += across.values[0][0][p].integral * across.thickness[p];
        }
        StatisticsQuery all;
        all.channels = {0};
        const double wanted = computeStatistics(*source, all).channels[0].all.integral;
        EXPECT_NEAR(integral, wanted, 1e-12 * wanted);
        query.line = std::array{box.lo, box.hi};
        query.weight = SectionWeight::Volume;
        const Sections along = computeSections(*source, query);
        integral = 0;
        for (std::size_t p = 0; p < along.place.size(); ++p)
            if (along.values[0][0][p].area > 0) integral += along.values[0][0][p].integral * along.thickness[p];
        EXPECT_NEAR(integral, wanted, 0.25 * wanted) << "the line ends at the corners, planes across it beyond";
    }
}

} // namespace tessera::volume
