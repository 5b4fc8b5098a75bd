#include "app/callouts/callout_layout.h"
#include "app/callouts/callout_place.h"
#include "app/callouts/callout_plots.h"
#include "app/data/open.h"
#include "app/edits/add_callout.h"
#include "app/session/session_json.h"
#include "app/tools/lens_list.h"
#include "tests/app/cell_info.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <limits>
#include <random>

/// Where callouts stand, what they are cut to, and how they go with their placeholders.
namespace tessera::app {
namespace {

CalloutRoom wideRoom() {
    return calloutRoom({10, 20}, {1010, 720}, {}, 14);
}

/// Crossing as a definition: both lines have a point in common that is an end of neither.
bool crossAt(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, glm::dvec2 d) {
    const glm::dvec2 r = b - a, s = d - c;
    const double across = r.x * s.y - r.y * s.x;
    if (std::abs(across) < 1e-9) return false;
    const glm::dvec2 between = c - a;
    const double t = (between.x * s.y - between.y * s.x) / across, u = (between.x * r.y - between.y * r.x) / across;
    constexpr double kEnd = 1e-6;
    return t > kEnd && t < 1 - kEnd && u > kEnd && u < 1 - kEnd;
}

void expectApart(const CalloutLayout& layout, const std::vector<glm::vec2>& anchors) {
    for (std::size_t i = 0; i < layout.boxes.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) {
            const CalloutBox &a = layout.boxes[i], &b = layout.boxes[k];
            const bool apart = a.max.x <= b.min.x || b.max.x <= a.min.x || a.max.y <= b.min.y || b.max.y <= a.min.y;
            EXPECT_TRUE(apart) << "boxes " << i << " and " << k;
            EXPECT_FALSE(crossAt(layout.port(i), anchors[i], layout.port(k), anchors[k]))
                << "lines " << i << " and " << k;
        }
}

std::vector<glm::vec2> randomAnchors(std::mt19937& random, std::size_t count) {
    std::uniform_real_distribution<float> x(0, 1020), y(0, 740);
    std::vector<glm::vec2> anchors;
    for (std::size_t i = 0; i < count; ++i) {
        const bool again = i > 0 && random() % 4 == 0; // several of one placeholder
        anchors.push_back(again ? anchors[random() % i] : glm::vec2(x(random), y(random)));
    }
    return anchors;
}

TEST(CalloutLayout, LinesNeverCrossAndBoxesNeverOverlap) {
    std::mt19937 random(7);
    for (int run = 0; run < 400; ++run) {
        const std::vector<glm::vec2> anchors = randomAnchors(random, 1 + random() % kMostCallouts);
        const CalloutLayout layout = placeCallouts(anchors, wideRoom());
        ASSERT_EQ(layout.boxes.size(), anchors.size());
        expectApart(layout, anchors);
        for (std::size_t i = 0; i < anchors.size(); ++i)
            for (std::size_t k = 0; k < i; ++k)
                if (anchors[i] == anchors[k] && layout.slots[i].right == layout.slots[k].right) {
                    EXPECT_GT(layout.slots[i].row, layout.slots[k].row) << "those of one placeholder keep their order";
                }
    }
}

TEST(CalloutLayout, StaysWhileTheCameraMovesUnlessLinesWouldCross) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> step(-6, 6);
    int changes = 0, frames = 0;
    for (int run = 0; run < 20; ++run) {
        std::vector<glm::vec2> anchors = randomAnchors(random, 6);
        CalloutLayout layout = placeCallouts(anchors, wideRoom());
        for (int frame = 0; frame < 60; ++frame, ++frames) {
            for (glm::vec2& anchor : anchors) anchor += glm::vec2(step(random), step(random));
            const CalloutLayout next = placeCallouts(anchors, wideRoom(), layout.slots, true);
            expectApart(next, anchors);
            bool crosses = false;
            for (std::size_t i = 0; i < anchors.size(); ++i)
                for (std::size_t k = 0; k < i; ++k)
                    crosses = crosses || crossAt(layout.port(i), anchors[i], layout.port(k), anchors[k]);
            EXPECT_EQ(next.slots != layout.slots, crosses);
            changes += next.slots != layout.slots;
            layout = next;
        }
    }
    EXPECT_LT(changes, frames / 10);
    // And back over the place where two lines would cross: the order that was taken there stays.
    std::vector<glm::vec2> pair{{500, 300}, {500, 420}};
    CalloutRoom left = wideRoom();
    left.right = {};
    CalloutLayout layout = placeCallouts(pair, left);
    int turns = 0;
    for (const float y : {340.f, 380.f, 430.f, 425.f, 430.f, 425.f, 430.f}) {
        pair[0].y = y;
        const CalloutLayout next = placeCallouts(pair, left, layout.slots, true);
        turns += next.slots != layout.slots;
        layout = next;
    }
    EXPECT_LE(turns, 1);
}

TEST(CalloutLayout, KeepsClearOfWhatIsTakenAndGivesWayInSmallPictures) {
    const std::vector<CalloutBox> taken{{{10, 20}, {120, 60}}, {{900, 500}, {1010, 720}}};
    const std::vector<glm::vec2> anchors(6, glm::vec2(500, 300));
    const CalloutLayout layout = placeCallouts(anchors, calloutRoom({10, 20}, {1010, 720}, taken, 14));
    EXPECT_EQ(layout.boxes.size(), anchors.size());
    for (const CalloutBox& box : layout.boxes)
        for (const CalloutBox& other : taken)
            EXPECT_TRUE(box.max.x <= other.min.x || other.max.x <= box.min.x || box.max.y <= other.min.y ||
                        other.max.y <= box.min.y);
    const CalloutLayout small = placeCallouts(anchors, calloutRoom({0, 0}, {300, 200}, {}, 14));
    EXPECT_GT(small.boxes.size(), 0u);
    EXPECT_LT(small.boxes.size(), anchors.size()) << "the rest has no room";
    expectApart(small, anchors);
    EXPECT_TRUE(placeCallouts(anchors, calloutRoom({0, 0}, {120, 90}, {}, 14)).boxes.empty());
}

TEST(CalloutLayout, EndsForAnchorsThatLieNowhere) {
    const float far = std::numeric_limits<float>::infinity();
    EXPECT_LE(placeCallouts({{far, 3}, {500, 300}, {far, -far}}, wideRoom()).boxes.size(), 3u);
}

/// Whether a scene draws a place: no clip cuts it away, and no lens hides all layers there.
bool drawnAt(const vis::Scene& scene, const vis::WorldFrame& world, glm::dvec3 place) {
    return vis::kept(vis::placeClips(scene.clips, world), place) &&
           vis::lensAction(vis::placeLenses(scene, world), -1, place).opacity > 0.5;
}

TEST(CalloutScene, IsCutToThePlaceholder) {
    Session session = defaultSession(cellInfo(), {});
    session.stretch = {2, 3, 1};
    const vis::WorldFrame world = vis::worldFrame(cellInfo(), session.stretch);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (const vis::LensShape shape : {vis::LensShape::Sphere, vis::LensShape::Box, vis::LensShape::Cylinder})
        for (const bool tilted : {false, true}) {
            vis::Lens lens;
            lens.name = "here";
            lens.shape = shape;
            lens.effect = vis::LensEffect::Enhance;
            lens.strength = 0;
            lens.center = cellInfo().bounds.center();
            lens.size = tilted ? glm::vec3(0.2f, 0.1f, 0.15f) : glm::vec3(0.15f);
            if (tilted) lens.rotation = {20, 40, 60};
            session.lenses = {lens};
            const Callout callout{.placeholder = "here"};
            const auto place = calloutPlace(session, cellInfo(), callout);
            ASSERT_TRUE(place.has_value());
            const vis::Scene scene = calloutScene(sceneOf(session), callout, *place, world, 1.3);
            const vis::PlacedLens placed = vis::placeLenses({lens}, world, session.camera, session.cursor).front();
            int inside = 0;
            for (int i = 0; i < 500; ++i) {
                const glm::dvec3 at = place->center + 0.3 * glm::dvec3(unit(random), unit(random), unit(random));
                const double radius = placed.radius(at);
                if (std::abs(radius - 1) < 1e-3) continue;
                EXPECT_EQ(drawnAt(scene, world, at), radius < 1) << int(shape) << tilted;
                inside += radius < 1;
            }
            EXPECT_GT(inside, 10);
            EXPECT_EQ(glm::dvec3(scene.camera.target), glm::dvec3(glm::vec3(place->center)));
        }
}

TEST(CalloutScene, FillsItsPictureAndTurnsWithTheView) {
    Session session = defaultSession(cellInfo(), {});
    session.selection.brushes = {{.name = "ball", .region = vis::SphereRegion{}}};
    const vis::WorldFrame world = vis::worldFrame(cellInfo(), session.stretch);
    auto& ball = std::get<vis::SphereRegion>(session.selection.brushes[0].region);
    ball.center = cellInfo().bounds.center();
    ball.radius = glm::dvec3(0.1) / world.scale;
    Callout callout{.of = CalloutOf::Brush, .placeholder = "ball"};
    const auto place = calloutPlace(session, cellInfo(), callout);
    ASSERT_TRUE(place && place->ball);
    for (const vis::Projection projection : {vis::Projection::Perspective, vis::Projection::Orthographic})
        for (const double aspect : {0.6, 1.0, 2.0}) {
            session.camera.projection = projection;
            const vis::Camera camera = calloutCamera(session.camera, callout, *place, aspect);
            // The rim of the ball, seen from the side: within the picture, but not by much.
            const glm::dmat4 clip = vis::projectionMatrix(camera, aspect) * vis::viewMatrix(camera);
            double most = 0;
            for (int i = 0; i < 64; ++i)
                for (int k = 0; k < 32; ++k) {
                    const double turn = i * 0.0982, up = k * 0.0982;
                    const glm::dvec3 on(std::sin(up) * std::cos(turn), std::sin(up) * std::sin(turn), std::cos(up));
                    const glm::dvec4 at = clip * glm::dvec4(place->center + 0.1 * on, 1);
                    most = std::max({most, std::abs(at.x / at.w), std::abs(at.y / at.w)});
                }
            EXPECT_LT(most, 1);
            EXPECT_GT(most, 0.9);
        }
    callout.turn = glm::angleAxis(0.5f, glm::vec3(0, 1, 0));
    const glm::quat before = calloutCamera(session.camera, callout, *place, 1).orientation;
    session.camera.orientation = glm::angleAxis(0.3f, glm::vec3(1, 0, 0)) * session.camera.orientation;
    const glm::quat after = calloutCamera(session.camera, callout, *place, 1).orientation;
    EXPECT_LT(std::abs(glm::dot(before, after)), 0.999f) << "the view's turn turns it";
    EXPECT_NEAR(std::abs(glm::dot(after, callout.turn * session.camera.orientation)), 1, 1e-5);
}

TEST(CalloutNumbers, AreOfTheLayerNearestToAPlane) {
    volume::DatasetInfo info = cellInfo();
    info.lattice.size = {2, 5, 4}; // samples in the middle of cells: the first is not at the face of the box
    info.lattice.spacing = {0.5, 0.4, 25};
    info.lattice.origin = {0.25, 0.2, 12.5};
    Session session = defaultSession(info, {});
    for (const auto& [cursor, nearest] : {std::pair{0.74, 0.6}, {0.0, 0.2}, {1.3, 1.4}, {2.0, 1.8}}) {
        session.cursor = {0.5, cursor, 50};
        const auto place = calloutPlace(session, info, {.of = CalloutOf::Plane, .placeholder = "y"});
        ASSERT_TRUE(place.has_value());
        const auto region = samplesOfPlace(*place, info, session.cursor);
        ASSERT_TRUE(region.has_value());
        const auto& layer = std::get<vis::BoxRegion>(*region);
        std::vector<double> inside;
        for (int k = 0; k < 5; ++k)
            if (const double y = 0.2 + 0.4 * k; std::abs(y - layer.center.y) <= layer.radius.y) inside.push_back(y);
        ASSERT_EQ(inside.size(), 1u);
        EXPECT_NEAR(inside[0], nearest, 1e-9);
    }
    session.views["oblique"] = ObliqueView{};
    const auto tilted = calloutPlace(session, info, {.of = CalloutOf::Plane, .placeholder = "oblique"});
    ASSERT_TRUE(tilted.has_value());
    EXPECT_FALSE(samplesOfPlace(*tilted, info, session.cursor).has_value());
}

TEST(CalloutNumbers, LayersOfBccLieHalfACellApart) {
    volume::DatasetInfo info = cellInfo();
    info.lattice = {.kind = volume::LatticeKind::BCC, .size = {3, 3, 8}, .spacing = {1, 1, 1}, .origin = {0, 0, 0}};
    const Session session = defaultSession(info, {});
    for (const int axis : {0, 1, 2})
        for (const double cursor : {0.1, 0.4, 1.6, 9.0}) {
            CalloutPlace place{.name = "plane"};
            place.normal = glm::dvec3(0);
            place.axis = static_cast<volume::SpaceAxis>(axis);
            const auto layer = std::get<vis::BoxRegion>(*samplesOfPlace(place, info, glm::dvec3(cursor)));
            double nearest = 1e9;
            std::size_t inside = 0;
            for (int z = 0; z < 8; ++z)
                for (int i = 0; i < 3; ++i) {
                    const double at = info.lattice.position({i, i, z})[axis];
                    if (std::abs(at - cursor) < std::abs(nearest - cursor)) nearest = at;
                    inside += std::abs(at - layer.center[axis]) <= layer.radius[axis];
                }
            EXPECT_NEAR(layer.center[axis], nearest, 1e-9) << axis << " " << cursor;
            EXPECT_GT(inside, 0u);
        }
}

TEST(CalloutEdits, FollowABrushWhoseNameIsTypedAnew) {
    const volume::DatasetInfo& info = cellInfo();
    Session session = defaultSession(info, {});
    addCallout(session, info, CalloutOf::Brush, "hot");
    renameCallouts(session, CalloutOf::Brush, "hot", "");
    renameCallouts(session, CalloutOf::Brush, "", "warm");
    EXPECT_EQ(session.callouts[0].placeholder, "warm");
}

TEST(CalloutEdits, KeepTheirTimeOnAnotherTimeAxis) {
    volume::DatasetInfo from = cellInfo();
    from.times = {0, 1, 2};
    from.timeName = "time";
    from.quantities = {{"voltage", "V", {0.8, 0.7, 0.5}}};
    volume::DatasetInfo to = from;
    to.times = {0.5, 0.7, 0.8};
    to.timeName = "voltage";
    Session session = defaultSession(from, {});
    session.callouts = {{.of = CalloutOf::Plane, .placeholder = "z", .time = 1.0}};
    session.lenses.push_back({.name = "late", .fromTime = 1.0});
    History history;
    history.reset(session);
    std::vector<std::string> messages;
    moveTo(session, history, &from, to, session.data, messages);
    EXPECT_NEAR(session.callouts[0].time.value_or(0), 0.7, 1e-9);
    EXPECT_NEAR(session.lenses[0].fromTime.value_or(0), 0.7, 1e-9);
}

TEST(CalloutEdits, ComparesParametersOfOnePlaceholderAndGoWithIt) {
    const volume::DatasetInfo& info = cellInfo();
    Session session = defaultSession(info, {});
    addLens(session, info, vis::LensEffect::Enhance);
    const std::string name = session.lenses[0].name;
    for (int i = 0; i < 3; ++i) addCallout(session, info, CalloutOf::Lens, name);
    addCallout(session, info, CalloutOf::Plane, "x");
    EXPECT_EQ(session.callouts[0].kind, CalloutKind::Scene);
    EXPECT_EQ(session.callouts[3].kind, CalloutKind::Slice);
    EXPECT_EQ(session.callouts[1].kind, CalloutKind::Slice);
    EXPECT_NE(session.callouts[1].channel, session.callouts[2].channel);
    renameLens(session, 0, "inlet");
    EXPECT_EQ(session.callouts[2].placeholder, "inlet");
    EXPECT_TRUE(calloutPlace(session, info, session.callouts[2]).has_value());
    session.callouts[0].layers = session.layers;
    session.callouts[0].time = 0.5;
    session.callouts[0].turn = glm::angleAxis(0.7f, glm::normalize(glm::vec3(1, 2, 3)));
    EXPECT_TRUE(sessionFromJson(toJson(session), "here") == session);
    removeLens(session, 0);
    ASSERT_EQ(session.callouts.size(), 1u);
    EXPECT_EQ(session.callouts[0].of, CalloutOf::Plane);
}

TEST(CalloutEdits, LendTheirLayersAndTimeToTheSession) {
    Session session = defaultSession(cellInfo(), {});
    const Session before = session;
    Callout callout{.placeholder = "x"};
    callout.layers = {{.name = "own", .technique = vis::VolumeLayer{.channel = "own"}}};
    callout.time = 17;
    const Callout as = callout;
    {
        const ShownCallout shown(session, callout);
        EXPECT_EQ(session.time, 17);
        EXPECT_EQ(session.layers.size(), 1u);
    }
    EXPECT_TRUE(session == before);
    EXPECT_TRUE(callout == as);
}

} // namespace
} // namespace tessera::app
