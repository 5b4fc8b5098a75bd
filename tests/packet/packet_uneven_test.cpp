#include "tests/packet/packet_pictures.h"
#include "tests/vis/uneven_view.h"
#include "tests/volume/uneven.h"

/// Pictures of data with uneven axes by packets of rays: those of the reference, and those of the same samples on an
/// even lattice.
namespace tessera::vis::packet {
namespace {

/// Places of lenses, brushes, clips and slices, here on the sheet of the wavy data.
const Mode kPlacedModes[] = {
    {"composite", [](Scene& s) { s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3})}; }},
    {"average", [](Scene& s) { s.layers = {layerOf(VolumeLayer{.channel = "b", .style = RayStyle::Average})}; }},
    {"slices and surfaces",
     [](Scene& s) {
         s.cursor = {7.3, 6.1, 11.4};
         s.layers = {layerOf(SliceLayer{.channel = "a", .orientation = SliceOrientation::Z, .opacity = 0.7f}),
                     layerOf(SliceLayer{
                         .channel = "b", .orientation = SliceOrientation::X, .atCursor = false, .position = 0.37}),
                     layerOf(SliceLayer{.channel = "b", .orientation = SliceOrientation::Oblique, .normal = {1, 2, 3}}),
                     layerOf(IsoLayer{.channel = "a", .value = 317, .opacity = 0.4f})};
     }},
    {"clips",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3})};
         s.clips = {
             {.center = {0.4f, 0.5f, 0.6f}, .axis = {0.6f, 0.7f, 0.2f}},
             {.kind = ClipKind::Sphere, .keep = ClipKeep::Outside, .center = {0.4f, 0.3f, 0.6f}, .radius = 0.2f}};
     }},
    {"brushes",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3})};
         Brush ball{.name = "ball", .region = SphereRegion{{6.2, 7.1, 12.3}, {4, 5, 6}, 0.4}};
         Brush box{.name = "box", .combine = BrushCombine::Or, .region = BoxRegion{{11.3, 8.2, 12.1}, {2, 3, 7}, 0}};
         s.selection.brushes = {ball, box};
         s.selection.brushColor = 0.5f;
     }},
    {"lenses",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 2})};
         Lens lens{.name = "near", .size = {0.25f, 0.2f, 0.3f}};
         lens.effect = LensEffect::Suppress;
         lens.center = {7, 6.3, 12.2};
         s.lenses = {lens};
     }},
};

TEST(UnevenPackets, DrawWhatTheReferenceDraws) {
    for (const bool masked : {false, true}) {
        const auto even = source(LatticeKind::CC, masked);
        const volume::Box box = even->info().bounds;
        const volume::AxisMaps axes = gradedAxes(box);
        std::vector<Mode> modes;
        for (const Mode& mode : kPlacedModes)
            modes.push_back({mode.name, [&mode, box, axes](Scene& s) {
                                 mode.apply(s);
                                 s = placedInSpace(s, box, axes);
                             }});
        expectAgreement(std::make_shared<UnevenView>(even, axes), modes);
    }
}

TEST(UnevenPackets, DrawThePictureOfTheSameSamplesOnAnEvenLattice) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
        const auto even = source(kind, true);
        const volume::Box box = even->info().bounds;
        const volume::AxisMaps axes = gradedAxes(box);
        PacketRenderer sheet, uneven;
        sheet.setSource(even);
        uneven.setSource(std::make_shared<UnevenView>(even, axes));
        for (const Mode& mode : kPlacedModes) {
            Scene scene = wavyScene(true);
            mode.apply(scene);
            const PacketPicture one = sheet.render(scene, kSize);
            const PacketPicture other = uneven.render(placedInSpace(scene, box, axes), kSize);
            ASSERT_EQ(one.rgba.size(), other.rgba.size());
            std::size_t apart = 0;
            for (std::size_t i = 0; i < one.rgba.size(); ++i) apart += std::abs(one.rgba[i] - other.rgba[i]) > 2e-3f;
            // Places through the maps and back lose their last digits: an edge may fall on another side of a ray.
            EXPECT_LE(apart, 4u) << mode.name;
            if (std::string(mode.name) == "composite" || std::string(mode.name) == "average") {
                EXPECT_EQ(one.rgba, other.rgba) << mode.name;
            }
            // The same numbers taken for places of an even lattice are elsewhere: the maps matter.
            if (scene.layers == placedInSpace(scene, box, axes).layers && scene.clips.empty() && scene.lenses.empty() &&
                scene.selection.brushes.empty())
                continue;
            const PacketPicture wrong = sheet.render(placedInSpace(scene, box, axes), kSize);
            std::size_t elsewhere = 0;
            for (std::size_t i = 0; i < one.rgba.size(); ++i)
                elsewhere += std::abs(one.rgba[i] - wrong.rgba[i]) > 2e-3f;
            EXPECT_GT(elsewhere, 100u) << mode.name;
        }
    }
}

/// A layered device of its own lattices, cells and points, as data sets are.
TEST(UnevenPackets, DrawLayeredDevicesAsTheReferenceDoes) {
    for (const auto of : {volume::AxisMap::Of::Cells, volume::AxisMap::Of::Points}) {
        const volume::Lattice lattice = volume::test::layeredLattice(of);
        const auto data = volume::test::unevenSource({volume::test::sampled<float>(
            lattice, [](glm::dvec3 p) { return std::sin(3e3 * p.x) + std::cos(2e3 * p.y) + 3e2 * p.z; })});
        std::vector<PacketRenderer> renderers = everyRenderer(data);
        Scene scene = bareScene(true);
        scene.stretch = {1, 1, 1.2};
        scene.layers = {layerOf(VolumeLayer{.channel = "p0", .density = 3}),
                        layerOf(SliceLayer{.channel = "p0", .orientation = SliceOrientation::Z})};
        scene.transfer["p0"].opacity = {{0, 0}, {1, 0.3f}};
        scene.cursor = {2e-3, 1e-3, 1e-3 + 12e-6}; // in the membrane
        const reference::Image wanted = reference::render(scene, *data, kSize, {});
        for (PacketRenderer& renderer : renderers)
            expectAlike(renderer, renderer.render(scene, kSize), wanted, kOutliers, "layered device");
    }
}

} // namespace
} // namespace tessera::vis::packet
