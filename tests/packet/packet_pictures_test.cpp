#include "tests/packet/packet_pictures.h"
#include "vis/optics/ray_setup.h"
#include "vis/packet/packet_refusal.h"

#include <atomic>

/// Pictures of the packet ray caster against the double-precision reference: every mode that it supports, on both
/// lattices, with and without absent samples, parallel and perspective, by every instruction set of this machine.
namespace tessera::vis::packet {
namespace {

const Mode kModes[] = {
    {"composite", [](Scene& s) { s.layers = {layerOf(VolumeLayer{.channel = "a", .shaded = false})}; }},
    {"shaded", [](Scene& s) { s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3})}; }},
    {"opaque",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 10})};
         s.transfer["a"].opacity = {{0, 0}, {0.55f, 0}, {0.7f, 0.8f}, {1, 0.8f}};
     }},
    {"wide gradients",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3})};
         s.render.gradient = volume::GradientSpan::Wide;
     }},
    {"cubic",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .shaded = false}),
                     layerOf(IsoLayer{.channel = "whole", .value = 0.9, .opacity = 0.4f})};
         s.render.filter = Filter::Cubic;
     }},
    {"cubic, shaded",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3}),
                     layerOf(VolumeLayer{.channel = "parted", .style = RayStyle::Maximum, .density = 0.5f})};
         s.render.filter = Filter::Cubic;
     }},
    {"cubic, of floats",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .quantity = Quantity::Gradient, .density = 3})};
         s.render.filter = Filter::Cubic;
     }},
    {"cubic, but classified before interpolation",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .classification = Classification::Pre, .density = 3})};
         s.render.filter = Filter::Cubic;
     }},
    {"maximum", [](Scene& s) { s.layers = {layerOf(VolumeLayer{.channel = "b", .style = RayStyle::Maximum})}; }},
    {"minimum", [](Scene& s) { s.layers = {layerOf(VolumeLayer{.channel = "b", .style = RayStyle::Minimum})}; }},
    {"average", [](Scene& s) { s.layers = {layerOf(VolumeLayer{.channel = "b", .style = RayStyle::Average})}; }},
    {"x-ray",
     [](Scene& s) { s.layers = {layerOf(VolumeLayer{.channel = "b", .style = RayStyle::XRay, .density = 0.3f})}; }},
    {"local maximum",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "b", .style = RayStyle::LocalMaximum, .threshold = 0.6})};
     }},
    {"iso", [](Scene& s) { s.layers = {layerOf(IsoLayer{.channel = "a", .value = 317, .opacity = 0.7f})}; }},
    {"physical light",
     [](Scene& s) {
         s.layers = {layerOf(IsoLayer{.channel = "a", .value = 317})};
         s.lighting.model = LightModel::Physical;
         s.lighting.lights = {
             Light{.color = {1, 0.9f, 0.7f}, .intensity = 1.5f},
             Light{.kind = LightKind::Point, .color = {0.4f, 0.6f, 1}, .position = {0.6f, 0.2f, -0.4f}}};
     }},
    {"clipped",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3})};
         s.clips = {{.axis = {0.6f, 0.7f, 0.2f}},
                    {.kind = ClipKind::Sphere, .keep = ClipKeep::Outside, .center = {0.4f, 0.3f, 0.6f}, .radius = 0.2f},
                    {.kind = ClipKind::Cylinder,
                     .keep = ClipKeep::Outside,
                     .center = {0.3f, 0.6f, 0.2f},
                     .axis = {1, 0, 0.3f},
                     .radius = 0.12f,
                     .length = 0.5f},
                    {.kind = ClipKind::Box, .size = {0.6f, 0.5f, 0.85f}}};
     }},
    {"several layers",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a"}),
                     layerOf(IsoLayer{.channel = "b", .value = 0.55, .color = {0.2f, 0.5f, 0.9f}, .opacity = 0.5f}),
                     layerOf(IsoLayer{.channel = "a", .value = 317, .opacity = 0.4f}),
                     layerOf(VolumeLayer{.channel = "b", .style = RayStyle::Maximum, .density = 0.5f})};
         s.clips = {{.kind = ClipKind::Box, .keep = ClipKeep::Outside, .size = {0.3f, 0.4f, 0.5f}}};
     }},
    {"layers with and without absent samples",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "whole", .shaded = false, .density = 0.5f}),
                     layerOf(IsoLayer{.channel = "a", .value = 317, .opacity = 0.4f}),
                     layerOf(IsoLayer{.channel = "whole", .value = 0.9, .opacity = 0.4f})};
     }},
    {"brushes of values",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3})};
         Brush ellipse{.name = "ellipse", .combine = BrushCombine::Or, .region = {}};
         ellipse.region =
             EllipseRegion{.x = "a", .y = "b", .center = {320, 0.8}, .radius = {20, 0.4}, .correlation = 0.5};
         Brush lasso{.name = "lasso", .color = {0.1f, 0.8f, 0.3f}, .combine = BrushCombine::Or, .region = {}};
         lasso.region = LassoRegion{.x = "b", .y = "a", .points = {{0.2, 280}, {0.9, 290}, {0.5, 330}}, .soft = 0.3};
         s.selection.brushes = {rangeBrush({{.channel = "a", .lo = 290, .hi = 310, .soft = 12}}), ellipse, lasso};
         s.selection.brushColor = 0.7f;
         s.selection.contextLightness = 1.4f;
     }},
    {"brushes in space",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3}),
                     layerOf(IsoLayer{.channel = "whole", .value = 0.9, .opacity = 0.8f})};
         s.layers[1].brushes = BrushEffect::FocusOnly;
         Brush box{.name = "box", .combine = BrushCombine::Minus, .region = {}};
         box.region = BoxRegion{.center = {9, 8, 9}, .radius = {4, 3, 5}, .soft = 0.4};
         Brush sphere{.name = "sphere", .region = {}};
         sphere.region = SphereRegion{.center = {9, 8, 12}, .radius = {8, 7, 9}, .soft = 0.2};
         Brush rest = rangeBrush({{.channel = "b", .lo = 0.2, .hi = 0.5, .soft = 0.2}});
         rest.inverted = true;
         s.selection.brushes = {sphere, box, rest};
         s.selection.contextOpacity = 0.2f;
     }},
    {"brushed projections",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "b", .style = RayStyle::Maximum, .density = 0.6f})};
         s.selection.brushes = {rangeBrush({{.channel = "a", .lo = 290, .hi = 320, .soft = 8}})};
         s.selection.contextOpacity = 0.3f;
     }},
    {"brushed means",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "b", .style = RayStyle::Average, .density = 0.6f}),
                     layerOf(VolumeLayer{.channel = "b", .style = RayStyle::XRay, .density = 0.2f})};
         s.selection.brushes = {rangeBrush({{.channel = "a", .lo = 290, .hi = 320, .soft = 8}})};
         s.selection.contextOpacity = 0.3f;
     }},
    {"lenses",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3}),
                     layerOf(VolumeLayer{.channel = "whole", .shaded = false, .density = 0.5f})};
         s.layers[1].lens = "window";
         s.lenses = {{.name = "window", .center = {8, 7, 10}, .size = glm::vec3(0.2f), .rim = 0.3f},
                     {.name = "faint",
                      .shape = LensShape::Box,
                      .effect = LensEffect::Suppress,
                      .center = {12, 10, 14},
                      .size = {0.2f, 0.15f, 0.1f},
                      .rotation = {10, 30, 20},
                      .strength = 0.8f},
                     {.name = "tube",
                      .shape = LensShape::Cylinder,
                      .effect = LensEffect::Enhance,
                      .center = {4, 4, 4},
                      .size = {0.1f, 0.1f, 0.3f}},
                     {.name = "disc",
                      .shape = LensShape::Disc,
                      .effect = LensEffect::Only,
                      .center = {9, 8, 12},
                      .size = glm::vec3(0.4f),
                      .inverted = true,
                      .strength = 0.5f}};
     }},
    {"a lens of what is brushed",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3}),
                     layerOf(VolumeLayer{.channel = "whole", .shaded = false, .density = 0.5f})};
         s.layers[1].lens = "brushed";
         s.selection.brushes = {rangeBrush({{.channel = "a", .lo = 290, .hi = 320, .soft = 8}})};
         s.lenses = {{.name = "brushed", .shape = LensShape::Selection}};
     }},
    {"brushes and lenses",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3})};
         s.lenses = {{.name = "focus", .effect = LensEffect::Focus, .center = {8, 7, 10}, .size = glm::vec3(0.3f)},
                     {.name = "mark",
                      .effect = LensEffect::Enhance,
                      .center = {10, 10, 16},
                      .size = glm::vec3(0.2f),
                      .strength = 0.2f}};
         Brush lens{.name = "lens", .combine = BrushCombine::Or, .region = {}};
         lens.region = LensRegion{.lens = "mark"};
         s.selection.brushes = {rangeBrush({{.channel = "a", .lo = 300, .hi = 320, .soft = 5}}), lens};
     }},
    {"jittered passes",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3})};
         s.render.jitter = true;
         s.render.samples = 3;
     }},
    {"long steps",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 2})};
         s.render.stepVoxels = 1.7f;
     }},
    {"narrow range",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .shaded = false})};
         s.transfer["a"].autoRange = false;
         s.transfer["a"].range = {300, 312};
     }},
    {"stretched, eye inside",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a"})};
         s.stretch = {3, 0.7, 1};
         s.camera.distance = 0.2f;
     }},
};

class PacketPictures : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, PacketPictures, testing::ValuesIn(cases()), nameOf);

TEST_P(PacketPictures, AgreeWithTheReference) {
    expectAgreement(GetParam(), kModes);
}

TEST(PacketRefusal, NamesWhatIsNotDrawn) {
    const auto data = source(LatticeKind::CC, false);
    const auto refusal = [&](const Scene& scene) { return packetRefusal(scene, data->info(), data->grid().lattice); };
    Scene scene = wavyScene(true);
    scene.layers = {layerOf(VolumeLayer{.channel = "a"})};
    EXPECT_EQ(refusal(scene), "");
    Scene other = scene;
    other.render.adaptiveStep = 0.5f;
    EXPECT_EQ(refusal(other), "adaptive steps");
    other = scene;
    for (int i = 0; i <= kMostPacketSlices; ++i) {
        EXPECT_EQ(refusal(other), "");
        other.layers.push_back(layerOf(SliceLayer{.channel = "b"}));
    }
    EXPECT_EQ(refusal(other), "so many layers");
    other.layers.back().visible = false;
    EXPECT_EQ(refusal(other), "");
    other = scene;
    std::get<VolumeLayer>(other.layers[0].technique).classification = Classification::PreIntegrated;
    EXPECT_EQ(refusal(other), "");
    other.transfer["a"].kind = TransferKind::Regions;
    EXPECT_EQ(refusal(other), "");
}

/// A mean reconstructs every sample of every ray once; counts say so.
TEST(PacketSamples, AreCounted) {
    const auto data = source(LatticeKind::CC, false);
    Scene scene = wavyScene(true);
    scene.layers = {layerOf(VolumeLayer{.channel = "b", .style = RayStyle::Average})};
    const WorldFrame frame = worldFrame(data->info(), scene.stretch);
    const glm::dvec3 cell = worldCell(data->grid().lattice, frame);
    std::uint64_t wanted = 0;
    for (int y = 0; y < kSize.y; ++y)
        for (int x = 0; x < kSize.x; ++x) {
            const glm::dvec2 ndc = (glm::dvec2(x, y) + 0.5) / glm::dvec2(kSize) * 2.0 - 1.0;
            const Ray ray = cameraRay(scene.camera, double(kSize.x) / kSize.y, ndc);
            const std::optional<RaySegment> segment = clipToBox(ray, frame.halfSize, true);
            if (segment)
                wanted +=
                    std::uint64_t(raySamples(*segment, ray.direction, cell, double(scene.render.stepVoxels)).count);
        }
    PacketRenderer renderer;
    renderer.setSource(data);
    renderer.countSamples(true);
    renderer.render(scene, kSize);
    EXPECT_NEAR(double(renderer.samplesTaken()), double(wanted), 4);
}

/// Each sample lies where PacketVolume::at() says, in every brick that holds it, to half a step of its 16 bits.
TEST(PacketVolumes, BricksHoldTheSamples) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
        const auto data = source(kind, true);
        const PacketVolume volume = readPacketVolume(*data, {.channel = 0, .filter = Filter::Average});
        const volume::Lattice& lattice = data->grid().lattice;
        const int slices = kind == LatticeKind::BCC ? 2 : 1;
        std::size_t present = 0;
        for (int z = 0; z < lattice.size.z; ++z)
            for (int y = 0; y < lattice.size.y; ++y)
                for (int x = 0; x < lattice.size.x; ++x) {
                    const glm::ivec3 brick = glm::ivec3(x, y, z) / data->grid().brickSize / glm::ivec3(1, 1, slices);
                    const volume::BrickSamples from = data->read({0, 0, 0, brick});
                    const glm::ivec3 in = glm::ivec3(x, y, z) - data->grid().begin(brick);
                    const std::size_t i =
                        (std::size_t(in.z) * std::size_t(from.size.y) + std::size_t(in.y)) * std::size_t(from.size.x) +
                        std::size_t(in.x);
                    const std::size_t at = volume.at(glm::ivec3(x, y, z / slices) + kMargin, z % slices);
                    ASSERT_EQ(volume.present[at] == kQuantum, from.isPresent(i)) << x << "," << y << "," << z;
                    if (!from.isPresent(i)) continue;
                    ++present;
                    ASSERT_NEAR(volume.offset + volume.scale * volume.shorts[at], from.values[i], volume.scale * 0.51);
                }
        EXPECT_GT(present, 1000u);
    }
}

/// The last volumes used are kept within a limit, and read again beyond it.
TEST(PacketVolumes, KeepsTheLastOnesWithinALimit) {
    struct Counting : FunctionSource {
        using FunctionSource::FunctionSource;
        mutable std::atomic<int> reads = 0;
        volume::BrickSamples read(const volume::BrickKey& key) const override {
            ++reads;
            return FunctionSource::read(key);
        }
    };
    const auto ramp = [](glm::dvec3 p) -> std::optional<double> { return p.x; };
    const auto counting =
        std::make_shared<Counting>(LatticeKind::CC, glm::ivec3(9), glm::dvec3(1),
                                   std::vector<FunctionSource::Channel>{{"a", ramp}, {"b", ramp}, {"c", ramp}});
    PacketVolumes volumes(counting);
    const auto readsOf = [&](int channel) {
        const int before = counting->reads;
        const std::size_t bytes = volumes.get({.channel = channel})->bytes();
        EXPECT_GT(bytes, 9u * 9 * 9 * 2);
        return counting->reads - before;
    };
    EXPECT_GT(readsOf(0), 0);
    EXPECT_GT(readsOf(0), 0) << "nothing is kept without a limit";
    volumes.keep(volumes.get({.channel = 0})->bytes() * 2);
    EXPECT_GT(readsOf(0) + readsOf(1), 0);
    EXPECT_EQ(readsOf(0) + readsOf(1), 0) << "two fit";
    EXPECT_GT(readsOf(2), 0);
    EXPECT_EQ(readsOf(1), 0) << "used later than the first";
    EXPECT_GT(readsOf(0), 0) << "the first had to go";
}

} // namespace
} // namespace tessera::vis::packet
