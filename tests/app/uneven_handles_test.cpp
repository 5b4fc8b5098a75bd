#include "app/data/picture_lattice.h"
#include "app/data/sources.h"
#include "app/history/session_file.h"
#include "app/pane/view_parts.h"
#include "app/planes/plane_picture.h"
#include "app/queries/statistics_query.h"
#include "app/tools/space_handles.h"
#include "app/views/shadow_cube/cube_legends.h"
#include "tests/app/ui_fixture.h"
#include "tests/app/uneven_layers.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

/// What is edited in data with uneven axes, kept in sessions and counted: places in space.
namespace tessera::app {
namespace {

using volume::AxisMap;

class UnevenHandles : public UiTest {};

/// A dot moved to a place in space is there afterwards, and so is what it moves.
TEST_F(UnevenHandles, StorePlacesInSpace) {
    const auto source = unevenLayers(AxisMap::Of::Cells);
    const volume::DatasetInfo& info = source->info();
    Session session = defaultSession(info, {});
    session.clips.resize(3);
    session.clips[1].kind = vis::ClipKind::Sphere;
    session.clips[2].kind = vis::ClipKind::Cylinder;
    vis::Brush ball, box;
    ball.region = vis::SphereRegion{info.bounds.center(), info.bounds.size() * 0.1, 0};
    box.region = vis::BoxRegion{info.bounds.center(), info.bounds.size() * 0.1, 0};
    session.selection.brushes = {ball, box};
    vis::SliceLayer fixed;
    fixed.channel = "T";
    fixed.orientation = vis::SliceOrientation::Z;
    fixed.atCursor = false;
    vis::SliceLayer tilted = fixed;
    tilted.orientation = vis::SliceOrientation::Oblique;
    tilted.normal = {1, 0, 1};
    vis::FlowLayer seeds;
    seeds.seeds = volume::SeedShape::Sphere;
    seeds.from = {0.2f, 0.2f, 0.2f};
    seeds.to = {0.6f, 0.6f, 0.6f};
    session.layers = {{"fixed", true, fixed}, {"tilted", true, tilted}, {"seeds", true, seeds}};
    UnevenPlaces random;
    const std::vector<HandledObject> objects = handledObjects(session, info);
    ASSERT_GE(objects.size(), 8u);
    int moved = 0;
    for (const HandledObject& object : objects)
        for (int round = 0; round < 5; ++round) {
            if (!object.handles.front().whole) continue;
            const glm::dvec3 to = random.drawn(info);
            Session edited = session;
            object.move(edited, 0, to);
            const std::vector<HandledObject> after = handledObjects(edited, info);
            const auto own = std::ranges::find(after, object.key, &HandledObject::key);
            ASSERT_NE(own, after.end()) << object.key;
            const glm::dvec3 at = own->handles.front().at;
            if (object.key.starts_with("rake")) continue; // stays in the box, and so does not reach every place
            if (object.key == "slice 0") {
                EXPECT_NEAR(at.z, to.z, 1e-9) << object.key;
            } else if (object.plane) { // through the place
                const glm::dvec3 sheet = info.lattice.axes.toSheet(to);
                EXPECT_LT(std::abs(own->plane->distance(sheet)), 1e-7) << object.key;
            } else {
                EXPECT_LT(glm::length((at - to) / info.lattice.lengthsAt(to)), 0.01) << object.key;
            }
            ++moved;
        }
    EXPECT_GT(moved, 20);
}

TEST_F(UnevenHandles, OutlinesLieOnWhatTheyOutline) {
    const auto source = unevenLayers(AxisMap::Of::Cells);
    const volume::DatasetInfo& info = source->info();
    Session session = defaultSession(info, {});
    session.stretch = {1, 2, 3};
    session.clips.resize(1);
    session.clips[0].kind = vis::ClipKind::Sphere;
    session.clips[0].center = {0.3f, 0.4f, 0.1f};
    const vis::WorldFrame world = vis::worldFrame(info, session.stretch);
    const vis::PlacedClip placed = vis::placeClips(session.clips, world).front();
    const std::vector<HandledObject> objects = handledObjects(session, info);
    const auto clip = std::ranges::find(objects, std::string("clip 0"), &HandledObject::key);
    ASSERT_NE(clip, objects.end());
    EXPECT_GT(clip->lines.size(), 100u);
    for (const auto& [from, to] : clip->lines)
        EXPECT_NEAR(glm::distance(world.toWorld(from), placed.center), placed.half.x, 1e-6);
    const PlanePicture plane = axisPlane(session, info, {0, 2, 1}, world.toPhysical(placed.center).y, {.channel = 0});
    const std::vector<SpaceLine> section = clip->section(plane.plane);
    ASSERT_GT(section.size(), 20u);
    for (const auto& [from, to] : section)
        EXPECT_NEAR(glm::distance(world.toWorld(from), placed.center), placed.half.x, 1e-6);
}

TEST(UnevenWalls, ReadTheirLineOverTheDrawing) {
    const auto source = unevenLayers(AxisMap::Of::Cells);
    const volume::DatasetInfo& info = source->info();
    const Session session = defaultSession(info, {});
    const CubeFace face = kCubeFaces[5];
    ASSERT_EQ(face.axis, 2);
    const glm::dvec3 at = info.lattice.position({5, 4, 0});
    const auto mean = readWall(*source, session, 0, {.kind = WallKind::Mean}, face, at, 0);
    double sum = 0;
    for (int k = 0; k < info.lattice.size.z; ++k) sum += unevenLinear(info.lattice.position({5, 4, k}));
    ASSERT_TRUE(mean);
    EXPECT_NEAR(*mean, sum / info.lattice.size.z, 0.02 * 2e4 * info.bounds.size().z);
}

TEST(UnevenWalls, AndRaysSayThatTheyGoOverTheDrawing) {
    const volume::DatasetInfo info = unevenLayers(AxisMap::Of::Cells)->info();
    EXPECT_EQ(kindText(WallKind::Mean, info, 2, "T"), "mean T over the drawing");
    EXPECT_EQ(kindText(WallKind::Mean, info, 1, "T"), "mean T") << "y is even";
    EXPECT_EQ(kindText(WallKind::Maximum, info, 2, "T"), "maximum T");
    Session session = defaultSession(info, {});
    const auto titled = [&](vis::RayStyle style, const volume::DatasetInfo& of) {
        session.layers = {{"", true, vis::VolumeLayer{.channel = "T", .style = style}}};
        const std::vector<LegendEntry> entries = sceneLegends(session, of, false);
        return entries.empty() ? std::string() : entries.front().title;
    };
    EXPECT_EQ(titled(vis::RayStyle::Average, info), "mean T over the drawing");
    EXPECT_EQ(titled(vis::RayStyle::XRay, info), "absorption by T over the drawing");
    EXPECT_EQ(titled(vis::RayStyle::Composite, info), "T");
    volume::DatasetInfo even = info;
    even.lattice.axes = {};
    EXPECT_EQ(titled(vis::RayStyle::Average, even), "T");
    EXPECT_EQ(titled(vis::RayStyle::XRay, even), "absorption by T");
}

TEST(UnevenLattices, PicturesAreOnTheGridUnlessChosenOtherwise) {
    const auto source = unevenLayers(AxisMap::Of::Cells);
    volume::DatasetInfo even = source->info();
    even.lattice.axes = {};
    EXPECT_EQ(firstLattice(PictureLattice::BodyCentred, source->info()), PictureLattice::Grid);
    EXPECT_EQ(firstLattice(PictureLattice::BodyCentred, even), PictureLattice::BodyCentred);
    EXPECT_EQ(firstLattice(PictureLattice::Grid, even), PictureLattice::Grid);
    const Sources sources{source, source, {}};
    const auto chosen = drawnOn(PictureLattice::BodyCentred, sources).pictures;
    EXPECT_EQ(chosen->info().lattice.kind, volume::LatticeKind::BCC);
    EXPECT_TRUE(chosen->info().lattice.axes == source->info().lattice.axes);
    EXPECT_EQ(drawnOn(PictureLattice::Grid, sources).pictures, source);
}

TEST(UnevenSessions, KeepTheirPlacesInSpace) {
    const auto source = unevenLayers(AxisMap::Of::Points);
    const volume::DatasetInfo& info = source->info();
    Session session = defaultSession(info, {});
    UnevenPlaces random;
    session.cursor = random.drawn(info);
    session.lenses.resize(1);
    session.lenses[0].center = random.drawn(info);
    session.clips.resize(1);
    session.clips[0].center = {0.25f, 0.5f, 0.0125f};
    vis::Brush ball;
    ball.region = vis::SphereRegion{random.drawn(info), info.bounds.size() * 0.1, 0.2};
    session.selection.brushes = {ball};
    SessionDocument document;
    document.session = session;
    const SessionDocument saved = parseSession(printSession(document, "/tmp/saved.json"), "saved");
    EXPECT_EQ(saved.session.cursor, session.cursor);
    EXPECT_EQ(saved.session.lenses[0].center, session.lenses[0].center);
    EXPECT_EQ(saved.session.clips[0].center, session.clips[0].center);
    EXPECT_EQ(saved.session.selection.brushes[0].region, session.selection.brushes[0].region);
}

TEST(UnevenBrushed, NumbersKnowTheAxes) {
    const auto source = unevenLayers(AxisMap::Of::Cells);
    const volume::DatasetInfo& info = source->info();
    Session session = defaultSession(info, {});
    vis::Brush ball;
    ball.region = vis::SphereRegion{info.lattice.position({6, 4, 2}), info.bounds.size() * 0.15, 0};
    session.selection.brushes = {ball};
    const BrushedQuery query = brushedQuery(session, info, {0}, {info.channelRange(info.channel(0))}, 8, false);
    EXPECT_TRUE(query.lenses.frame.axes == info.lattice.axes);
    const volume::Statistics numbers = readStatistics(source, query, 0, {});
    // Counted by the drawing: samples within an ellipsoid of 0.15 edges around the sample.
    double expected = 0;
    for (int k = 0; k < info.lattice.size.z; ++k)
        for (int j = 0; j < info.lattice.size.y; ++j)
            for (int i = 0; i < info.lattice.size.x; ++i) {
                const glm::dvec3 sheet = info.lattice.sheetPosition({i, j, k});
                const glm::dvec3 away = (sheet - info.lattice.sheetPosition({6, 4, 2})) / (info.bounds.size() * 0.15);
                expected += glm::length(away) <= 1;
            }
    ASSERT_GT(expected, 20);
    ASSERT_FALSE(numbers.channels.empty());
    EXPECT_EQ(numbers.channels[0].inside.samples, expected);
    EXPECT_TRUE(brushSpace(session, volume::DatasetInfo{}) == vis::LensSpace{}) << "of even axes nothing";
}

} // namespace
} // namespace tessera::app
