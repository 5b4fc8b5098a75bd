#include "tests/vis/uneven_view.h"
#include "tests/vis/wavy_data.h"
#include "tests/volume/uneven.h"
#include "vis/optics/brush_tests.h"
#include "vis/optics/ray_setup.h"
#include "vis/optics/visibility.h"
#include "vis/scene/clipping.h"
#include "vis/shapes/cloud4.h"
#include "vis/shapes/flow_geometry.h"
#include "volume/mesh/isosurface.h"
#include "volume/sources/sheet_source.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <random>

/// Places in space of what is drawn by cells: cursor, clips, lenses, brushes, geometry.
namespace tessera::vis {
namespace {

using volume::AxisMap;
using volume::LatticeKind;
using volume::test::layeredLattice;
using volume::test::sampled;

struct UnevenRandom {
    std::mt19937 engine{11};
    double operator()(double lo, double hi) { return std::uniform_real_distribution(lo, hi)(engine); }
    glm::dvec3 in(const volume::Box& box) {
        return {(*this)(box.lo.x, box.hi.x), (*this)(box.lo.y, box.hi.y), (*this)(box.lo.z, box.hi.z)};
    }
};

volume::DatasetInfo layeredInfo(AxisMap::Of of, LatticeKind kind) {
    const volume::Lattice cc = layeredLattice(of);
    volume::DatasetInfo info;
    info.lattice = layeredLattice(of, kind);
    info.bounds = volume::test::unevenBox(cc);
    return info;
}

TEST(UnevenWorld, SharesOfTheBoxAreThoseOfSpace) {
    const volume::DatasetInfo info = layeredInfo(AxisMap::Of::Cells, LatticeKind::CC);
    const WorldFrame frame = worldFrame(info, {1, 2, 5});
    UnevenRandom random;
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 share(random(0, 1), random(0, 1), random(0, 1));
        const glm::dvec3 place = info.bounds.lo + share * info.bounds.size();
        const glm::dvec3 world = frame.atShare(share);
        EXPECT_LT(glm::distance(frame.toPhysical(world), place), 1e-12);
        EXPECT_LT(glm::distance(frame.shareOf(world), share), 1e-9);
        // A clip and a slice at that share.
        const PlacedClip clip =
            placeClips({{.kind = ClipKind::Sphere, .center = glm::vec3(share), .radius = 0.1f}}, frame).front();
        EXPECT_LT(glm::distance(frame.toPhysical(clip.center), place), 1e-6 * glm::length(info.bounds.size()));
        SliceLayer slice{.channel = "", .orientation = SliceOrientation::Z, .atCursor = false, .position = share.z};
        EXPECT_NEAR(frame.toPhysical({0, 0, slicePlane(slice, frame, {}).offset}).z, place.z, 1e-12);
        slice.atCursor = true;
        EXPECT_NEAR(frame.toPhysical({0, 0, slicePlane(slice, frame, place).offset}).z, place.z, 1e-12);
    }
    // The membrane, 25 um of 1735, is drawn as thick as two cells of twenty.
    const double z = frame.toWorld({0, 0, 1e-3 + 25e-6}).z;
    EXPECT_NEAR(z, frame.halfSize.z * (2 * 2 / 20.0 - 1), 1e-9);
}

TEST(UnevenWorld, EvenAxesKeepTheirSharesToTheLastBit) {
    const volume::Box box{{1, 2, 3}, {4, 9, 3.5}};
    const WorldFrame frame = worldFrame(box, {1, 2, 3});
    UnevenRandom random;
    for (int i = 0; i < 100; ++i) {
        const glm::dvec3 share(random(-0.5, 1.5), random(0, 1), random(0, 1));
        EXPECT_EQ(frame.atShare(share), (2.0 * share - 1.0) * frame.halfSize);
    }
}

/// What a shader or a packet makes of a test of a region in space, at a place in cells.
double testedInterest(const BrushTest& test, glm::dvec3 cells) {
    const glm::dvec3 away = (cells - glm::dvec3(test.place)) * glm::dvec3(test.inverseRadius);
    const glm::dvec3 size = glm::abs(away);
    return radialDoi(test.kind == BrushTestKind::Sphere ? glm::length(away) : std::max({size.x, size.y, size.z}),
                     double(test.soft));
}

TEST(UnevenBrushes, SelectTheSameSamplesInPicturesAndNumbers) {
    UnevenRandom random;
    for (const auto of : {AxisMap::Of::Cells, AxisMap::Of::Points})
        for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
            const volume::DatasetInfo info = layeredInfo(of, kind);
            int inside = 0;
            for (int i = 0; i < 400; ++i) {
                const glm::dvec3 center = random.in(info.bounds), to = random.in(info.bounds);
                Selection selection;
                selection.brushes.resize(1);
                if (i % 2)
                    selection.brushes[0].region = BoxRegion{center, glm::abs(to - center) + 1e-6, i % 4 == 1 ? 0.3 : 0};
                else
                    selection.brushes[0].region =
                        SphereRegion{center, info.bounds.size() * random(0.1, 0.4), i % 4 == 0 ? 0.3 : 0};
                LensSpace space;
                space.frame = worldFrame(info, glm::dvec3(1));
                const DoiFunction interest(selection, space);
                const BrushTests tests = brushTests(selection, info, {}, {});
                ASSERT_EQ(tests.tests.size(), 1u);
                for (int k = 0; k < 20; ++k) {
                    const glm::dvec3 place = random.in(info.bounds);
                    const double shown = testedInterest(tests.tests[0], info.lattice.toCells(place));
                    EXPECT_NEAR(interest({}, place), shown, 1e-4);
                    inside += shown > 0.5;
                    // A box is that of space, to the last sample.
                    if (const auto* box = std::get_if<BoxRegion>(&selection.brushes[0].region)) {
                        const glm::dvec3 away = glm::abs(place - box->center) / box->radius;
                        const double most = std::max({away.x, away.y, away.z});
                        if (std::abs(most - 1) > 1e-9) {
                            EXPECT_EQ(shown >= 1, most < 1);
                        }
                    }
                }
            }
            EXPECT_GT(inside, 200);
        }
}

TEST(UnevenBrushes, BallsAreRoundInTheDrawing) {
    const volume::DatasetInfo info = layeredInfo(AxisMap::Of::Cells, LatticeKind::CC);
    const WorldFrame frame = worldFrame(info, glm::dvec3(1));
    LensSpace space;
    space.frame = frame;
    Selection selection;
    selection.brushes.resize(1);
    const SphereRegion own{{1.5e-3, 1.3e-3, 1.03e-3}, glm::dvec3(3e-4), 0};
    selection.brushes[0].region = own;
    const DoiFunction interest(selection, space);
    const glm::dvec3 middle = frame.toWorld(own.center);
    const double radius = 3e-4 * frame.scale.x;
    UnevenRandom random;
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 way = glm::normalize(glm::dvec3(random(-1, 1), random(-1, 1), random(-1, 1)));
        for (const double away : {0.98, 1.02})
            EXPECT_EQ(interest({}, frame.toPhysical(middle + way * radius * away)), away < 1 ? 1 : 0);
    }
}

TEST(UnevenLenses, LieAtTheirPlaceInSpace) {
    const volume::DatasetInfo info = layeredInfo(AxisMap::Of::Points, LatticeKind::CC);
    const WorldFrame frame = worldFrame(info, {1, 1, 3});
    std::vector<Lens> lenses(2);
    lenses[0].center = {1.2e-3, 1.1e-3, 1.01e-3};
    lenses[1].followsCursor = true;
    const glm::dvec3 cursor(2.5e-3, 1e-3, 1.028e-3);
    const std::vector<PlacedLens> placed = placeLenses(lenses, frame, {}, cursor);
    ASSERT_EQ(placed.size(), 2u);
    EXPECT_LT(glm::distance(frame.toPhysical(placed[0].center), lenses[0].center), 1e-12);
    EXPECT_LT(glm::distance(frame.toPhysical(placed[1].center), cursor), 1e-12);
    LensSpace a{placed, frame}, b = a;
    EXPECT_TRUE(a == b);
    b.frame.axes = {};
    EXPECT_FALSE(a == b);
}

TEST(UnevenSurfaces, AreThoseOfTheSameSamplesOnAnEvenLattice) {
    const auto value = [](glm::dvec3 p) { return 1e3 * p.x + 4e3 * p.z + std::sin(3e3 * p.y); };
    for (const auto of : {AxisMap::Of::Cells, AxisMap::Of::Points})
        for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
            const volume::Lattice lattice = layeredLattice(of, kind);
            volume::Dataset uneven = volume::test::datasetOf({sampled<float>(lattice, value)});
            uneven.info.bounds = volume::test::unevenBox(layeredLattice(of));
            volume::Field same = sampled<float>(lattice, value);
            same.lattice.axes = {};
            volume::Dataset even = volume::test::datasetOf({same});
            even.info.bounds = uneven.info.bounds;
            const volume::MemorySourceOptions options{.lattice = kind, .brickSize = 8};
            const auto drawn = volume::sheetSource(volume::makeMemorySource(uneven, options));
            EXPECT_TRUE(drawn->info().lattice.isEven() && drawn->grid().lattice.isEven());
            const auto beside = volume::makeMemorySource(even, options);
            const volume::SurfaceMesh mesh = volume::extractIsosurface(*drawn, 0, 0, 6.5, 0);
            ASSERT_GT(mesh.triangles.size(), 50u);
            EXPECT_TRUE(mesh == volume::extractIsosurface(*beside, 0, 0, 6.5, 0));
            EXPECT_EQ(volume::sheetSource(beside), beside);
        }
}

/// A uniform flow on the layered grid.
std::shared_ptr<const volume::BrickSource> uniformFlow(glm::dvec3 velocity) {
    const volume::Lattice lattice = layeredLattice(AxisMap::Of::Cells);
    std::vector<volume::Field> fields;
    for (int c = 0; c < 3; ++c) fields.push_back(sampled<float>(lattice, [&](glm::dvec3) { return velocity[c]; }));
    volume::Dataset dataset = volume::test::unevenDataset(std::move(fields));
    volume::Parameter vector = dataset.info.parameters.front();
    vector.name = "u";
    vector.components = 3;
    vector.ranges.clear();
    dataset.info.parameters = {vector};
    const auto read = dataset.read;
    dataset.read = [read](int, int component, int time) { return read(component, 0, time); };
    return volume::makeMemorySource(std::move(dataset), {.brickSize = 8});
}

TEST(UnevenFlow, LinesLieInSpaceWhereTheyAreTraced) {
    const glm::dvec3 velocity(1, 0.2, 0.8);
    const auto source = uniformFlow(velocity);
    const volume::DatasetInfo& info = source->info();
    FlowLayer layer;
    layer.kind = FlowKind::Streamlines;
    layer.vector = "u";
    layer.seeds = volume::SeedShape::Line;
    layer.from = {0.2f, 0.2f, 0.3f};
    layer.to = {0.8f, 0.8f, 0.6f};
    layer.count = 5;
    const std::vector<glm::dvec3> seeds = flowSeeds(*source, layer, 0, glm::dvec3(1));
    ASSERT_EQ(seeds.size(), 5u);
    const glm::dvec3 span = seeds.back() - seeds.front();
    for (std::size_t i = 0; i < seeds.size(); ++i)
        EXPECT_LT(glm::distance(seeds[i], seeds.front() + span * (double(i) / 4)), 1e-9) << "straight in space";
    const auto geometry = makeFlow(*source, layer, 0, glm::dvec3(1));
    ASSERT_TRUE(geometry);
    ASSERT_GT(geometry->lines.positions.size(), 40u);
    const glm::dvec3 way = glm::normalize(velocity);
    std::uint32_t begin = 0;
    for (const std::uint32_t end : geometry->lines.ends) {
        const auto place = [&](std::uint32_t i) {
            return info.lattice.axes.toSpace(geometry->lines.origin + glm::dvec3(geometry->lines.positions[i]));
        };
        double nearest = 1;
        for (std::uint32_t i = begin; i < end; ++i) {
            const glm::dvec3 from = place(i) - place(begin);
            EXPECT_LT(glm::length(from - way * glm::dot(from, way)), 1e-8) << "a straight line in space";
        }
        for (const glm::dvec3& seed : seeds) {
            const glm::dvec3 from = seed - place(begin);
            nearest = std::min(nearest, glm::length(from - way * glm::dot(from, way)));
        }
        EXPECT_LT(nearest, 1e-8) << "through its seed";
        begin = end;
    }
}

TEST(UnevenFlow, GlyphsPointTheWayTheFlowIsDrawn) {
    const glm::dvec3 velocity(1, 0, 1), stretch(1, 1, 2);
    const auto source = uniformFlow(velocity);
    const volume::Lattice& lattice = source->info().lattice;
    FlowLayer layer;
    layer.kind = FlowKind::Hedgehogs;
    layer.vector = "u";
    layer.seeds = volume::SeedShape::Random;
    layer.count = 60;
    const std::vector<glm::dvec3> seeds = flowSeeds(*source, layer, 0, stretch);
    const auto geometry = makeFlow(*source, layer, 0, stretch);
    ASSERT_EQ(geometry->lines.positions.size(), 2 * seeds.size());
    int thin = 0; // evenly over the drawing: 4 of 20 cells are thin, 2 % of the length
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        const glm::dvec3 foot = geometry->lines.origin + glm::dvec3(geometry->lines.positions[2 * i]),
                         tip = geometry->lines.origin + glm::dvec3(geometry->lines.positions[2 * i + 1]);
        EXPECT_LT(glm::distance(lattice.axes.toSpace(foot), seeds[i]), 1e-8);
        // A short step along the flow, as the drawing has it; the cell on both sides of a border has another length.
        const glm::dvec3 cell = lattice.lengthsAt(seeds[i]);
        const glm::dvec3 seen = glm::normalize(velocity / cell * lattice.spacing * stretch);
        EXPECT_LT(glm::distance(glm::normalize((tip - foot) * stretch), seen), 1e-3);
        thin += seeds[i].z < 1e-3 + 35e-6;
    }
    EXPECT_GT(thin, 4);
    EXPECT_LT(thin, 24);
}

TEST(UnevenCloud, PointsLieAsTheirCellsAreDrawn) {
    const volume::DatasetInfo info = layeredInfo(AxisMap::Of::Cells, LatticeKind::CC);
    volume::Samples4 samples;
    samples.channels = 1;
    for (int k = 0; k < info.lattice.size.z; ++k) {
        samples.positions.emplace_back(info.lattice.position({3, 4, k}));
        samples.times.push_back(0);
        samples.values.push_back(1);
    }
    CloudStyle style;
    style.bounds = info.bounds;
    style.axes = info.lattice.axes;
    style.transfer.opacity = {{0, 1}, {1, 1}};
    const std::vector<CloudPoint> points = makeCloud(samples, style);
    ASSERT_EQ(points.size(), std::size_t(info.lattice.size.z));
    for (std::size_t k = 0; k < points.size(); ++k)
        EXPECT_NEAR(points[k].position.z, (double(k) + 0.5) / double(points.size()) - 0.5, 1e-4);
}

TEST(UnevenVisibility, IsThatOfThePicture) {
    const auto even = wavySource(LatticeKind::CC, {wavyA(false)});
    const auto uneven = std::make_shared<UnevenView>(even, gradedAxes(even->info().bounds));
    VisibilityQuery query;
    query.range = {225, 375};
    query.function.opacity = {{0, 0}, {1, 0.4f}};
    const auto of = [&](const std::shared_ptr<const volume::BrickSource>& source) {
        return visibilityHistogram(volume::readSamples(*volume::sheetSource(source), 0, 0, 0), even->info().bounds,
                                   query);
    };
    EXPECT_EQ(of(even), of(uneven));
}

} // namespace
} // namespace tessera::vis
