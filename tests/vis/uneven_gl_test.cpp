#include "tests/vis/gl_fixture.h"
#include "tests/vis/raycast_compare.h"
#include "tests/vis/uneven_view.h"
#include "tests/vis/wavy_data.h"
#include "volume/mesh/isosurface.h"
#include "volume/sources/sheet_source.h"

#include <functional>

/// Pictures of data with uneven axes by OpenGL: those of the reference, and those of the same samples on an even
/// lattice.
namespace tessera::vis {
namespace {

constexpr glm::ivec2 kUnevenSize{64, 48};

struct UnevenMode {
    const char* name;
    std::function<void(Scene&)> apply; ///< places on the sheet
    bool placed = true;                ///< has places in space
};

Layer unevenLayer(Technique technique) {
    return {"", true, std::move(technique)};
}

const UnevenMode kUnevenModes[] = {
    {"volume", [](Scene& s) { s.layers = {unevenLayer(VolumeLayer{.channel = "a", .density = 3})}; }, false},
    {"shadows",
     [](Scene& s) {
         s.layers = {unevenLayer(VolumeLayer{.channel = "a", .density = 3})};
         s.lighting.shadows.strength = 0.8f;
     },
     false},
    {"slices",
     [](Scene& s) {
         s.cursor = {7.3, 6.1, 11.4};
         s.layers = {unevenLayer(SliceLayer{.channel = "a", .orientation = SliceOrientation::Z, .opacity = 0.7f}),
                     unevenLayer(SliceLayer{
                         .channel = "b", .orientation = SliceOrientation::X, .atCursor = false, .position = 0.37}),
                     unevenLayer(IsoLayer{.channel = "a", .value = 317, .opacity = 0.4f})};
     }},
    {"clips, brushes and lenses",
     [](Scene& s) {
         s.layers = {unevenLayer(VolumeLayer{.channel = "a", .density = 3})};
         s.clips = {
             {.kind = ClipKind::Sphere, .keep = ClipKeep::Outside, .center = {0.4f, 0.3f, 0.6f}, .radius = 0.2f}};
         Brush ball{.name = "ball", .region = SphereRegion{{6.2, 7.1, 12.3}, {4, 5, 6}, 0.4}};
         Brush box{.name = "box", .combine = BrushCombine::Or, .region = BoxRegion{{11.3, 8.2, 12.1}, {2, 3, 7}, 0}};
         s.selection.brushes = {ball, box};
         Lens lens{.name = "near", .size = {0.25f, 0.2f, 0.3f}};
         lens.effect = LensEffect::Suppress;
         lens.center = {7, 6.3, 12.2};
         s.lenses = {lens};
     }},
};

class UnevenPictures : public test::GlTest {};

TEST_F(UnevenPictures, AreThoseOfTheSameSamplesOnAnEvenLattice) {
    for (const volume::LatticeKind kind : {volume::LatticeKind::CC, volume::LatticeKind::BCC}) {
        const auto even = wavySource(kind, {wavyA(true), wavyB(true)});
        const volume::Box box = even->info().bounds;
        const volume::AxisMaps axes = gradedAxes(box);
        const auto uneven = std::make_shared<UnevenView>(even, axes);
        for (const UnevenMode& mode : kUnevenModes) {
            Scene scene = wavyScene(true);
            mode.apply(scene);
            const auto one = test::picture(even, {}, scene, kUnevenSize);
            const auto other = test::picture(uneven, {}, placedInSpace(scene, box, axes), kUnevenSize);
            if (!mode.placed) {
                EXPECT_EQ(test::maxDifference(one, other), 0) << mode.name;
                continue;
            }
            ASSERT_EQ(one.size(), other.size());
            int apart = 0, elsewhere = 0;
            const auto wrong = test::picture(even, {}, placedInSpace(scene, box, axes), kUnevenSize);
            for (std::size_t i = 0; i < one.size(); ++i) {
                apart += glm::length(one[i] - other[i]) > 4e-3f;
                elsewhere += glm::length(one[i] - wrong[i]) > 4e-3f;
            }
            EXPECT_LE(apart, 3) << mode.name;
            EXPECT_GT(elsewhere, 60) << mode.name << ": the maps matter";
        }
    }
}

TEST_F(UnevenPictures, AreThoseOfTheReference) {
    const auto even = source(LatticeKind::CC, true);
    const volume::Box box = even->info().bounds;
    const volume::AxisMaps axes = gradedAxes(box);
    const auto uneven = std::make_shared<UnevenView>(even, axes);
    Renderer renderer(optionsFor(true, false));
    renderer.setSource(uneven);
    for (const UnevenMode& mode : kUnevenModes) {
        Scene scene = wavyScene(true);
        mode.apply(scene);
        scene = placedInSpace(scene, box, axes);
        const reference::Difference apart = reference::compare(drawWhole(renderer, *renderer.makeTarget(), scene),
                                                               reference::render(scene, *uneven, kSize, {}), kOutlier);
        EXPECT_TRUE(apart.rmseWithin <= 4 * kRmse && apart.beyond <= kOutliers) << mode.name << ": " << words(apart);
    }
}

TEST_F(UnevenPictures, SurfacesAsMeshesAndPicksLieAtTheirPlace) {
    const auto even = wavySource(volume::LatticeKind::CC, {wavyA(false), wavyB(false)});
    const volume::Box box = even->info().bounds;
    const volume::AxisMaps axes = gradedAxes(box);
    const auto uneven = std::make_shared<UnevenView>(even, axes);
    const auto scene = [&](const std::shared_ptr<const volume::BrickSource>& source) {
        auto geometry = std::make_shared<Geometry>();
        geometry->mesh = volume::extractIsosurface(*volume::sheetSource(source), 0, 0, 317, 0);
        Scene out = wavyScene(false);
        out.geometry = {{.geometry = geometry, .style = {.cutByBox = true}}};
        return out;
    };
    EXPECT_EQ(test::maxDifference(test::picture(even, {}, scene(even), kUnevenSize),
                                  test::picture(uneven, {}, scene(uneven), kUnevenSize)),
              0);
    // A pick gives the place in space of what is seen.
    Renderer sheet, maps;
    sheet.setSource(even);
    maps.setSource(uneven);
    const ViewTargetPtr one = sheet.makeTarget(), other = maps.makeTarget();
    test::renderAll(sheet, *one, scene(even), kUnevenSize);
    test::renderAll(maps, *other, scene(uneven), kUnevenSize);
    int picked = 0;
    for (int y = 4; y < kUnevenSize.y; y += 8)
        for (int x = 4; x < kUnevenSize.x; x += 8) {
            const auto a = sheet.pick(*one, {x, y}), b = maps.pick(*other, {x, y});
            ASSERT_EQ(a.has_value(), b.has_value());
            if (!a) continue;
            EXPECT_LT(glm::distance(axes.toSpace(a->position), b->position), 1e-9);
            ++picked;
        }
    EXPECT_GT(picked, 5);
}

} // namespace
} // namespace tessera::vis
