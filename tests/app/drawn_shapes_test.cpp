#include "app/tools/lens_edit.h"
#include "app/ui/theme.h"
#include "app/views/shadow_cube/cube_faces.h"
#include "app/views/tesseract/tesseract_wire.h"
#include "app/views/transfer/region_edit.h"
#include "tests/app/drawn_text.h"
#include "tests/app/fed_imgui.h"

#include <cmath>

/// Shapes that views draw over their pictures, read back from the triangles of ImGui.
namespace tessera::app {
namespace {

class DrawnShapes : public FedImGui {
protected:
    DrawnShapes() : FedImGui({600, 500}) {}
    void SetUp() override {
        loadFonts(1);
        applyTheme(Theme::Dark, 1);
    }
    struct Box {
        ImVec2 min{1e9f, 1e9f}, max{-1e9f, -1e9f};
    };
    static Box around(const std::vector<ImVec2>& places) {
        Box box;
        for (const ImVec2& at : places) {
            box.min = {std::min(box.min.x, at.x), std::min(box.min.y, at.y)};
            box.max = {std::max(box.max.x, at.x), std::max(box.max.y, at.y)};
        }
        return box;
    }
};

TEST_F(DrawnShapes, RegionsHaveTheirOutlineAndTheSelectedOneItsCorners) {
    const PlotFrame plane{{50, 50}, {450, 350}, {0, 1}, {0, 1}};
    vis::TransferFunction function;
    vis::TransferRegion& region = function.regions.emplace_back();
    region.centre = {0.6f, 0.3f};
    region.size = {0.5f, 0.2f};
    region.ownColor = true;
    region.color = {1, 0, 0};
    const ImVec2 a = plane.pixel(0.35, 0.4), b = plane.pixel(0.85, 0.2), middle = plane.pixel(0.6, 0.3);
    const ImU32 line = toColor({1, 0, 0});
    const auto outline = [&](int selected) {
        feedWindow([&] { drawRegions(*ImGui::GetWindowDrawList(), function, plane, selected); });
        return drawnIn(line);
    };
    for (const vis::RegionShape shape :
         {vis::RegionShape::Rectangle, vis::RegionShape::Triangle, vis::RegionShape::Gaussian}) {
        SCOPED_TRACE(int(shape));
        region.shape = shape;
        const std::vector<ImVec2> corners = outline(-1);
        const Box box = around(corners);
        const float pen = 8; // pointed corners are wider than the line
        EXPECT_NEAR(box.min.x, a.x, pen);
        EXPECT_NEAR(box.max.x, b.x, pen);
        EXPECT_NEAR(box.min.y, a.y, pen);
        EXPECT_NEAR(box.max.y, b.y, pen);
        EXPECT_TRUE(drawnIn(plotColors().text).empty()) << "none is selected";
        for (const ImVec2& at : corners) {
            const double u = (at.x - middle.x) / (b.x - middle.x), v = (at.y - middle.y) / (b.y - middle.y);
            if (shape == vis::RegionShape::Gaussian) {
                EXPECT_NEAR(std::hypot(u, v), 1, 0.15) << at.x << ' ' << at.y;
            } else if (shape == vis::RegionShape::Triangle && v > 0.7) {
                EXPECT_LT(std::abs(u), 0.4) << "it stands on its tip";
            }
        }
        if (shape == vis::RegionShape::Gaussian) {
            EXPECT_GE(corners.size(), 2 * 48u) << "round";
        }
    }
    outline(0);
    std::vector<ImVec2> handles = drawnIn(plotColors().text);
    ASSERT_EQ(handles.size(), 16u) << "four squares";
    for (std::size_t i = 0; i < 4; ++i) {
        const Box square =
            around({handles.begin() + std::ptrdiff_t(4 * i), handles.begin() + std::ptrdiff_t(4 * i + 4)});
        EXPECT_NEAR((square.min.x + square.max.x) / 2, i == 0 || i == 3 ? a.x : b.x, 0.1);
        EXPECT_NEAR((square.min.y + square.max.y) / 2, i < 2 ? a.y : b.y, 0.1);
        EXPECT_LT(square.max.x - square.min.x, 12);
    }
}

TEST_F(DrawnShapes, CornersOfATesseractAreColouredByTheFourthAxis) {
    TesseractFrame frame;
    frame.min = {100, 50};
    frame.max = {500, 450};
    frame.fourth = fourthColors();
    feedWindow([&] { drawWire(*ImGui::GetWindowDrawList(), frame); });
    const auto nearest = [&](ImVec2 place) { // the colour of what is drawn last there
        ImU32 color = 0;
        const ImDrawData& data = *ImGui::GetDrawData();
        for (int list = 0; list < data.CmdListsCount; ++list)
            for (const ImDrawVert& corner : data.CmdLists[list]->VtxBuffer)
                if (std::hypot(corner.pos.x - place.x, corner.pos.y - place.y) < 5 &&
                    (corner.col >> IM_COL32_A_SHIFT & 255) > 0)
                    color = corner.col;
        return color & ~IM_COL32_A_MASK;
    };
    const auto end = [&](double share) {
        const glm::dvec4 c = vis::evaluate(frame.fourth, {0, 1}, share);
        return toColor({c.r, c.g, c.b}) & ~IM_COL32_A_MASK;
    };
    int seen = 0;
    for (int i = 0; i < 16; ++i) {
        const vis::PointN corner = vis::cornerOf(i, frame.half, 4);
        const ImVec2 at = frame.pixel(frame.project(corner).at);
        bool alone = true; // no other corner of the picture at the same place
        for (int j = 0; j < 16; ++j) {
            const ImVec2 other = frame.pixel(frame.project(vis::cornerOf(j, frame.half, 4)).at);
            if (j != i && std::hypot(other.x - at.x, other.y - at.y) < 12) alone = false;
        }
        if (!alone) continue;
        ++seen;
        EXPECT_EQ(nearest(at), end(corner[3] > 0 ? 1 : 0)) << i;
    }
    EXPECT_GE(seen, 4);
}

TEST_F(DrawnShapes, TheNameOfALensStandsAboveIt) {
    Session session;
    session.camera.orientation = glm::quat(1, 0, 0, 0);
    session.camera.projection = vis::Projection::Orthographic;
    session.lenses = {{.name = "inlet", .center = {1, 0.5, 0.5}, .size = {0.2f, 0.1f, 0.15f}}};
    LensDrag drag;
    const SpaceFrame space =
        spaceFrame({50, 50}, {450, 350}, session.camera, {glm::dvec3(0), {2, 1, 1}}, glm::dvec3(1));
    for (const bool narrow : {false, true}) {
        if (narrow) session.lenses[0].size = glm::vec3(0.01f); // without a handle to turn it by
        const vis::PlacedLens placed =
            vis::placeLenses(session.lenses, space.world, session.camera, session.cursor).back();
        const LensHandles handles = lensHandles(space, placed);
        ASSERT_TRUE(handles.middle);
        mouse = *handles.middle;
        for (int i = 0; i < 2; ++i)
            feedWindow([&] {
                surface({50, 50}, {450, 350});
                editLenses(drag, session, space, ImGui::IsItemHovered());
                drawLensHandles(*ImGui::GetWindowDrawList(), drag, space, session);
            });
        const std::vector<DrawnText> texts = drawnTexts();
        ASSERT_EQ(texts.size(), 1u);
        EXPECT_EQ(texts[0].text, "inlet");
        const ImVec2 below = handles.turn ? *handles.turn : *handles.middle;
        EXPECT_NEAR(texts[0].middle().x, below.x, 2);
        EXPECT_LT(texts[0].max.y, below.y);
        EXPECT_GT(texts[0].max.y, below.y - 40);
    }
}

TEST_F(DrawnShapes, AFaceOfTheShadowCubeCoversItsCorners) {
    volume::DatasetInfo info;
    info.bounds = {glm::dvec3(0), {2, 1, 1}};
    vis::Camera camera;
    CubeFrame frame{info, {50, 50}, {400, 400}, vis::worldFrame(info, glm::dvec3(1)), glm::dvec3(0.5), camera, {}};
    frame.space = spaceFrame(frame.min, frame.max(), camera, info.bounds, glm::dvec3(1));
    for (const CubeFace& face : kCubeFaces) {
        feedWindow([&] { drawFace(*ImGui::GetWindowDrawList(), frame, face, 0); });
        const std::vector<ImVec2> ground = drawnIn(IM_COL32(36, 39, 45, 255));
        for (const double s : {-1.0, 1.0})
            for (const double t : {-1.0, 1.0}) {
                const auto at = frame.pixel(face.at(s * 0.5, t * 0.5, frame.half));
                ASSERT_TRUE(at);
                EXPECT_TRUE(std::ranges::any_of(
                    ground, [&](ImVec2 corner) { return std::hypot(corner.x - at->x, corner.y - at->y) < 6; }))
                    << face.axis << face.upper << ' ' << s << ' ' << t;
            }
    }
}

/// Cube and titles in pictures of any proportions and from any side.
TEST_F(DrawnShapes, TheShadowCubeIsWholeWithItsTitles) {
    volume::DatasetInfo info;
    info.bounds = {glm::dvec3(0), {0.6, 1, 2.2}};
    const vis::WorldFrame world = vis::worldFrame(info, glm::dvec3(1));
    ShadowCubeView view;
    feedWindow([&] {
        for (const ImVec2 size : {ImVec2{446, 150}, ImVec2{150, 400}, ImVec2{600, 500}})
            for (const vis::Projection projection : {vis::Projection::Perspective, vis::Projection::Orthographic})
                for (int turn = 0; turn < 12; ++turn) {
                    SCOPED_TRACE(std::to_string(size.x) + ", turn " + std::to_string(turn));
                    vis::Camera camera;
                    camera.projection = projection;
                    camera.distance = 0.9f; // nearer than shows the box
                    for (int i = 0; i < turn; ++i) vis::orbit(camera, {0, 0}, {0.37f, 0.21f});
                    CubeFrame frame{info, {20, 10}, size, world, world.halfSize + double(view.gap), camera, {}};
                    const auto look = [&] {
                        frame.camera = cubeCamera(view, camera, frame.half, frame.aspect());
                        frame.space = spaceFrame(frame.min, frame.max(), frame.camera, info.bounds, glm::dvec3(1));
                    };
                    const auto inside = [&](ImVec2 at) {
                        return at.x >= frame.min.x && at.x <= frame.max().x && at.y >= frame.min.y &&
                               at.y <= frame.max().y;
                    };
                    const auto corners = [&] {
                        int count = 0;
                        for (int i = 0; i < 8; ++i) {
                            const glm::dvec3 sign(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
                            const auto at = frame.pixel(sign * frame.half);
                            count += at && inside(*at);
                        }
                        return count;
                    };
                    view.zoom = 1;
                    look();
                    EXPECT_EQ(corners(), 8);
                    std::vector<std::pair<ImVec2, ImVec2>> taken;
                    for (std::size_t face = 0; face < kCubeFaces.size(); ++face) {
                        if (!facesViewer(kCubeFaces[face], frame.half, frame.camera)) continue;
                        const ImVec2 text{60, 15}, at = faceTitlePlace(frame, face, text, taken);
                        const ImVec2 lo{at.x - 30, at.y - 7.5f}, hi{at.x + 30, at.y + 7.5f};
                        EXPECT_TRUE(inside(lo) && inside(hi)) << face;
                        taken.push_back({lo, hi});
                    }
                    view.zoom = 2;
                    look();
                    EXPECT_LT(corners(), 8) << "nearer";
                }
    });
}

TEST_F(DrawnShapes, TitlesOfTheShadowCubeKeepClearOfTheDataAndOfEachOther) {
    volume::DatasetInfo info;
    info.bounds = {glm::dvec3(0), {0.6, 1, 2.2}};
    const vis::WorldFrame world = vis::worldFrame(info, glm::dvec3(1));
    const ShadowCubeView view;
    feedWindow([&] {
        const ImVec2 size{446, 180};
        CubeFrame frame{info, {0, 0}, size, world, world.halfSize + double(view.gap), {}, {}};
        frame.camera = cubeCamera(view, {}, frame.half, frame.aspect());
        frame.space = spaceFrame(frame.min, frame.max(), frame.camera, info.bounds, glm::dvec3(1));
        std::vector<std::pair<ImVec2, ImVec2>> taken{{{300, 0}, {446, 30}}}; // legends
        for (std::size_t face = 0; face < kCubeFaces.size(); ++face) {
            if (!facesViewer(kCubeFaces[face], frame.half, frame.camera)) continue;
            const ImVec2 at = faceTitlePlace(frame, face, {60, 15}, taken);
            const ImVec2 lo{at.x - 30, at.y - 7.5f}, hi{at.x + 30, at.y + 7.5f};
            EXPECT_LT(coveredByBox(frame.space, lo, hi), 0.05) << face;
            for (const auto& [from, to] : taken)
                EXPECT_FALSE(lo.x < to.x && from.x < hi.x && lo.y < to.y && from.y < hi.y) << face;
            taken.push_back({lo, hi});
        }
        EXPECT_EQ(taken.size(), 4u);
    });
}

TEST(WallScene, HasTheWallAlone) {
    vis::Scene scene;
    scene.showBox = scene.showGround = true;
    scene.layers.resize(3);
    scene.lenses.resize(1);
    for (const WallKind kind : {WallKind::Mean, WallKind::Maximum, WallKind::Shadow, WallKind::Slice})
        for (const CubeFace& face : kCubeFaces) {
            const vis::Scene wall = wallScene(scene, "T", {.kind = kind}, face,
                                              vis::worldFrame({glm::dvec3(0), {2, 1, 1}}, glm::dvec3(1)), {});
            EXPECT_FALSE(wall.showBox);
            EXPECT_FALSE(wall.showGround);
            EXPECT_EQ(wall.layers.size(), 1u);
            EXPECT_TRUE(wall.lenses.empty());
        }
}

TEST(WallScene, HasLensesContoursAndALookWhereAFaceAsksForThem) {
    vis::Scene scene;
    scene.layers = {{"", true, vis::VolumeLayer{.channel = "T"}},
                    {"", true, vis::IsoLayer{.channel = "O2"}, "round"},
                    {"", true, vis::IsoLayer{.channel = "p"}, "flat"},
                    {"", false, vis::IsoLayer{.channel = "H2"}, "round"}};
    scene.lenses = {{.name = "round"}, {.name = "flat", .shape = vis::LensShape::Disc}};
    scene.selection.brushes.resize(1);
    const vis::WorldFrame world = vis::worldFrame({glm::dvec3(0), {2, 1, 1}}, glm::dvec3(1));
    const auto wall = [&](const Wall& of) { return wallScene(scene, "T", of, kCubeFaces[2], world, {}); };
    const vis::Scene slices = wall({.kind = WallKind::Slice, .contours = 7, .lenses = true});
    ASSERT_EQ(slices.layers.size(), 2u) << "of the lens that stands in space, what is shown";
    ASSERT_EQ(slices.lenses.size(), 1u);
    for (const vis::Layer& layer : slices.layers) {
        const auto& slice = std::get<vis::SliceLayer>(layer.technique);
        EXPECT_EQ(slice.contours, 7);
        EXPECT_EQ(slice.channel, layer.lens.empty() ? "T" : "O2");
        EXPECT_EQ(layer.brushes, vis::BrushEffect::None);
    }
    EXPECT_TRUE(wall({.kind = WallKind::Shadow, .lenses = true}).lenses.empty());
    const vis::Scene means = wall({.kind = WallKind::Mean, .lenses = true});
    EXPECT_EQ(means.transfer.at("O2").opacity, means.transfer.at("T").opacity) << "means are opaque";
    vis::Look look;
    look.charcoal.emplace();
    const vis::Scene volume = wall({.kind = WallKind::Volume, .look = look});
    EXPECT_EQ(std::get<vis::VolumeLayer>(volume.layers[0].technique).look, look);
    EXPECT_EQ(std::get<vis::VolumeLayer>(volume.layers[0].technique).style, vis::RayStyle::Composite);
}

} // namespace
} // namespace tessera::app
