#include "vis/shapes/flow_data.h"
#include "vis/shapes/flow_geometry.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <map>
#include <numbers>

namespace tessera::vis {
namespace {

constexpr int kSamples = 21;

/// A box of 20 x 20 x 20 lengths; U(t) = (u(t), 0, 0) everywhere, f = the time.
std::shared_ptr<const volume::BrickSource> windAt(std::vector<double> times, const std::function<double(double)>& u,
                                                  const std::string& unit = "", const std::string& length = "m") {
    volume::Dataset data;
    data.info.lattice.size = glm::ivec3(kSamples);
    data.info.bounds = {glm::dvec3(0), glm::dvec3(kSamples - 1)};
    data.info.lengthUnit = length;
    data.info.times = times;
    data.info.parameters.resize(2);
    data.info.parameters[0].name = "U";
    data.info.parameters[0].unit = unit;
    data.info.parameters[0].components = 3;
    double most = 0;
    for (const double time : times) most = std::max(most, std::abs(u(time)));
    data.info.parameters[0].ranges = {{-most, most}, {0, 0}, {0, 0}, {0, most}};
    data.info.parameters[1].name = "f";
    data.info.parameters[1].ranges = {{times.front(), times.back()}};
    data.read = [lattice = data.info.lattice, times, u](int parameter, int component, int time) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::F32);
        const double now = times[std::size_t(time)];
        for (std::size_t i = 0; i < field.count(); ++i)
            field.as<float>()[i] = float(parameter == 1 ? now : component == 0 ? u(now) : 0);
        return field;
    };
    return volume::makeMemorySource(std::move(data), {});
}

FlowLayer particlesOf(FlowKind kind) {
    FlowLayer layer{.vector = "U", .channel = "f"};
    layer.kind = kind;
    layer.seeds = volume::SeedShape::Line;
    layer.from = layer.to = glm::vec3(0.25f, 0.5f, 0.5f);
    layer.count = 1;
    layer.radius = 0.01f;
    return layer;
}

Range extentAlongX(const volume::SurfaceMesh& mesh) {
    Range range{1e9, -1e9};
    for (const glm::vec3& p : mesh.positions)
        range = {std::min(range.lo, double(p.x)), std::max(range.hi, double(p.x))};
    return range;
}

// 0.01 m/s over 1 s are 10 mm; without units, and where they are ignored, 0.01 lengths.
TEST(FlowParticles, MoveByTheUnitsOfTheData) {
    const auto constant = [](double) { return 0.01; };
    FlowLayer layer = particlesOf(FlowKind::Pathlines);
    const auto reach = [&](const std::string& unit, const std::string& length) {
        const auto geometry = makeFlow(*windAt({0, 1}, constant, unit, length), layer, 0, glm::dvec3(1));
        return geometry->mesh.positions.empty() ? 0.0 : extentAlongX(geometry->mesh).hi - 5;
    };
    EXPECT_NEAR(reach("m/s", "mm"), 10, 1e-3);
    EXPECT_NEAR(reach("mm/s", "mm"), 0, 0.02);
    EXPECT_NEAR(reach("km/h", "mm"), 10 / 3.6, 1e-3);
    EXPECT_NEAR(reach("", "mm"), 0, 0.02) << "1 length per time is assumed";
    layer.speed = 0.5f;
    EXPECT_NEAR(reach("m/s", "mm"), 5, 1e-3) << "a factor";
    layer.speed = 1000;
    layer.ignoreUnits = true;
    EXPECT_NEAR(reach("m/s", "mm"), 10, 1e-3) << "as in sessions of earlier versions";
    EXPECT_NEAR(reach("m/s", "m"), 10, 1e-3);
}

// A place of a flat box that is stretched and shrunk again lies beside it by rounding.
TEST(FlowParticles, FlatDataHaveSeedsWhateverTheStretch) {
    volume::Dataset data;
    data.info.lattice.size = {9, 9, 1};
    data.info.lattice.origin = {0, 0, 0.1};
    data.info.bounds = {{0, 0, 0.1}, {8, 8, 0.1}};
    data.info.times = {0};
    data.info.parameters.resize(1);
    data.info.parameters[0].name = "U";
    data.info.parameters[0].components = 3;
    data.info.parameters[0].ranges = {{0, 1}, {0, 0}, {0, 0}, {0, 1}};
    data.read = [lattice = data.info.lattice](int, int component, int) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::F32);
        for (std::size_t i = 0; i < field.count(); ++i) field.as<float>()[i] = component == 0 ? 1.0f : 0.0f;
        return field;
    };
    const auto source = volume::makeMemorySource(std::move(data), {});
    ASSERT_NE(0.1 * 1.5 / 1.5, 0.1);
    for (const FlowKind kind : {FlowKind::Tubes, FlowKind::Arrows, FlowKind::Speedlines}) {
        FlowLayer layer{.vector = "U", .channel = "|U|"};
        layer.kind = kind;
        layer.seeds = volume::SeedShape::Even;
        layer.separation = 0.2f;
        EXPECT_GT(makeFlow(*source, layer, 0, {1, 1, 1.5})->mesh.positions.size(), 100u) << int(kind);
    }
}

TEST(FlowParticles, PathsGoThereAndBackFromSeedsAtRest) {
    std::vector<double> times;
    for (int i = 0; i <= 60; ++i) times.push_back(i * 2 * std::numbers::pi / 60);
    const auto source = windAt(times, [](double t) { return 4 * std::cos(t); });
    FlowLayer layer = particlesOf(FlowKind::Pathlines);
    layer.from = layer.to = glm::vec3(0.5f);
    for (const int time : {0, 15, 30, 45}) { // at 15 and 45 the flow rests
        const auto geometry = makeFlow(*source, layer, time, glm::dvec3(1));
        ASSERT_FALSE(geometry->mesh.positions.empty()) << time;
        const Range x = extentAlongX(geometry->mesh);
        const double now = 4 * std::sin(times[std::size_t(time)]);
        EXPECT_NEAR(x.hi, 10 + 4 - now, 0.02) << time;
        EXPECT_NEAR(x.lo, 10 - 4 - now, 0.02) << time;
    }
    for (const FlowKind kind : {FlowKind::Streaklines, FlowKind::Speedlines}) {
        layer.kind = kind;
        EXPECT_FALSE(makeFlow(*source, layer, 15, glm::dvec3(1))->mesh.positions.empty());
    }
}

// What was released at r is at the integral of the wind since then; its colour is that of now.
TEST(FlowParticles, StreaklinesReachTheOldestParticle) {
    const auto source = windAt({0, 1, 2, 3, 4}, [](double t) { return 1 + t; });
    FlowLayer layer = particlesOf(FlowKind::Streaklines);
    const auto whole = makeParticles(*source, layer, 2.5, glm::dvec3(1));
    EXPECT_NEAR(extentAlongX(whole->mesh).hi, 5 + 2.5 + 2.5 * 2.5 / 2, 1e-3);
    for (const float scalar : whole->mesh.scalars) EXPECT_FLOAT_EQ(scalar, 2.5f);
    layer.span = 1;
    EXPECT_NEAR(extentAlongX(makeParticles(*source, layer, 2.5, glm::dvec3(1))->mesh).hi,
                5 + 1 + (2.5 * 2.5 - 1.5 * 1.5) / 2, 1e-3);
}

TEST(FlowParticles, TimelinesMoveOnFromTheirReleases) {
    const auto source = windAt({0, 10}, [](double) { return 2.0; });
    FlowLayer layer = particlesOf(FlowKind::Timelines);
    layer.from = {0.25f, 0.25f, 0.5f};
    layer.to = {0.25f, 0.75f, 0.5f};
    layer.span = 4;
    layer.steps = 5; // one each second
    const auto placesAt = [&](double moment) {
        std::map<long, int> places; // of the middles of tubes
        const auto geometry = makeParticles(*source, layer, moment, glm::dvec3(1));
        for (const glm::vec3& p : geometry->mesh.positions) ++places[std::lround(p.x)];
        std::vector<long> out;
        for (const auto& [x, count] : places) out.push_back(x);
        return out;
    };
    EXPECT_EQ(placesAt(6), (std::vector<long>{5, 7, 9, 11, 13}));
    EXPECT_EQ(placesAt(6.5), (std::vector<long>{6, 8, 10, 12, 14})) << "released at whole seconds";
    EXPECT_EQ(placesAt(1.5), (std::vector<long>{6, 8})) << "none before the first time";
    layer.together = true;
    EXPECT_EQ(placesAt(6), (std::vector<long>{5, 7, 9, 11, 13}));
    EXPECT_EQ(placesAt(8), (std::vector<long>{5, 7, 9})) << "none after the last time";
    layer.together = false;
    layer.band = 0.5f;
    const auto geometry = makeParticles(*source, layer, 6.5, glm::dvec3(1));
    double area = 0;
    for (const glm::uvec3& t : geometry->mesh.triangles) {
        const glm::vec3 a = geometry->mesh.positions[t.x], b = geometry->mesh.positions[t.y],
                        c = geometry->mesh.positions[t.z];
        const bool strip = std::max({std::abs(a.z - 10), std::abs(b.z - 10), std::abs(c.z - 10)}) < 1e-4;
        if (strip) area += double(glm::length(glm::cross(b - a, c - a))) / 2;
    }
    EXPECT_NEAR(area, 5 * 1 * 10, 0.5) << "five bands of half a second, 1 wide and 10 long";
}

TEST(FlowParticles, SpeedlinesMoveWithTheTimeAndAreTheSameAgain) {
    const auto source = windAt({0, 100}, [](double) { return 2.0; });
    FlowLayer layer = particlesOf(FlowKind::Speedlines);
    layer.span = 3;
    layer.tail = 0.5f;
    const auto headAt = [&](double moment) {
        return extentAlongX(makeParticles(*source, layer, moment, glm::dvec3(1))->mesh).hi - 0.2; // its radius
    };
    EXPECT_NEAR(headAt(30), 5, 1e-3) << "born again each 3 s";
    EXPECT_NEAR(headAt(31), 7, 1e-3);
    EXPECT_NEAR(headAt(32.5), 10, 1e-3);
    EXPECT_NEAR(headAt(33), 5, 1e-3);
    const auto one = makeParticles(*source, layer, 31, glm::dvec3(1));
    EXPECT_NEAR(extentAlongX(one->mesh).lo, 7 - 0.5 * 3 * 2, 1e-3) << "the tail";
    EXPECT_EQ(one->mesh, makeParticles(*source, layer, 31, glm::dvec3(1))->mesh);
    layer.phase = 0.5f;
    EXPECT_NEAR(headAt(30), 8, 1e-3);
}

// One stored time: a steady flow.
TEST(FlowParticles, OfASingleTimeAreThoseOfASteadyFlow) {
    const auto source = windAt({0}, [](double) { return 2.0; });
    for (const FlowKind kind :
         {FlowKind::Pathlines, FlowKind::Streaklines, FlowKind::Timelines, FlowKind::Speedlines}) {
        FlowLayer layer = particlesOf(kind);
        layer.to.y = kind == FlowKind::Timelines ? 0.7f : layer.from.y;
        const auto geometry = makeFlow(*source, layer, 0, glm::dvec3(1));
        ASSERT_FALSE(geometry->mesh.positions.empty()) << int(kind);
        if (kind == FlowKind::Pathlines) {
            EXPECT_NEAR(extentAlongX(geometry->mesh).lo, 0, 0.01);
            EXPECT_NEAR(extentAlongX(geometry->mesh).hi, 20, 0.01);
        }
    }
}

TEST(FlowNotes, SayWhatIsCoarseOrEndsEarly) {
    const auto source = windAt({0}, [](double) { return 2.0; });
    FlowLayer layer{.vector = "U", .channel = "f"};
    FlowData data;
    EXPECT_TRUE(flowNotes(source->info(), layer, data).empty());
    EXPECT_TRUE(makeFlow(*source, layer, 0, glm::dvec3(1))->notes.empty());
    data.level = 1;
    *data.stopped = 3;
    const std::vector<std::string> lines = flowNotes(source->info(), layer, data);
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_EQ(lines[0], "flow of U: from every 2nd sample along each axis");
    EXPECT_EQ(lines[1], "flow of U: 3 ends of lines lie where they were cut off, after 5000 steps");
    layer.kind = FlowKind::Pathlines;
    data.level = 0;
    *data.stopped = 1;
    EXPECT_EQ(flowNotes(source->info(), layer, data).at(0), "flow of U: 1 particle stops early, after 50000 steps");
}

TEST(FlowBlur, CopiesStandWhereGlyphsCameFrom) {
    const auto source = windAt({0}, [](double) { return 2.0; });
    FlowLayer layer{.vector = "U", .channel = "f"};
    layer.kind = FlowKind::Cones;
    layer.seeds = volume::SeedShape::Line;
    layer.from = layer.to = glm::vec3(0.5f);
    layer.count = 1;
    layer.size = 0.1f; // 2
    const auto sharp = makeFlow(*source, layer, 0, glm::dvec3(1));
    EXPECT_TRUE(sharp->tints.empty());
    layer.blur = 4;
    const auto geometry = makeFlow(*source, layer, 0, glm::dvec3(1));
    const std::size_t each = sharp->mesh.positions.size();
    ASSERT_EQ(geometry->mesh.positions.size(), 5 * each);
    ASSERT_EQ(geometry->tints.size(), 5 * each);
    for (std::size_t v = 0; v < 5 * each; ++v) {
        const double copy = double(v / each);
        EXPECT_NEAR(geometry->mesh.positions[v].x, sharp->mesh.positions[v % each].x - 0.5 * copy, 1e-4);
        EXPECT_LT(geometry->tints[v].r, 0) << "coloured by the parameter";
        if (v >= each) {
            EXPECT_LT(geometry->tints[v].a, geometry->tints[v - each].a) << "fading";
        }
    }
}

TEST(BentArrows, AreClosedAndEndAtTheirTip) {
    LineSet lines;
    for (int i = 0; i <= 100; ++i) {
        const double angle = std::numbers::pi / 2 * i / 100;
        lines.positions.emplace_back(10 * std::sin(angle), 10 - 10 * std::cos(angle), 0);
        lines.scalars.push_back(float(i));
    }
    lines.ends = {101};
    for (const bool flat : {false, true}) {
        const volume::SurfaceMesh mesh = bentArrows(lines, 0.5, flat, glm::dvec3(1));
        double thick = 0, wide = 0, tip = 0, volumeInside = 0;
        for (const glm::vec3& p : mesh.positions) {
            thick = std::max(thick, std::abs(double(p.z)));
            wide = std::max(wide, std::abs(std::hypot(double(p.x), double(p.y) - 10) - 10));
            tip = std::max(tip, double(p.y));
        }
        for (const glm::uvec3& t : mesh.triangles)
            volumeInside += glm::dot(glm::dvec3(mesh.positions[t.x]),
                                     glm::cross(glm::dvec3(mesh.positions[t.y]), glm::dvec3(mesh.positions[t.z]))) /
                            6;
        EXPECT_GT(volumeInside, 0) << "faces outwards";
        EXPECT_NEAR(wide, 1.3, 0.1) << "the head, in the plane in which it bends";
        EXPECT_NEAR(thick, flat ? 1.3 * 0.16 : 1.3, 0.1);
        EXPECT_NEAR(tip, 10, 0.05);
        for (const glm::vec3& normal : mesh.normals) EXPECT_NEAR(glm::length(normal), 1, 1e-5);
    }
}

} // namespace
} // namespace tessera::vis
