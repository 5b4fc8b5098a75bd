#include "tests/reference/some_strokes.h"
#include "tests/vis/raycast_compare.h"
#include "vis/gl/driver.h"
#include "volume/sources/memory_source.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

/// The shader's pictures against the double-precision reference: every style on CC and BCC, with and without absent
/// samples, parallel and perspective. Linear light before the background, all four components.
namespace tessera::vis {
namespace {

using reference::Flaws;
using reference::Image;
using volume::LatticeKind;

/// The lattices that a mode is drawn on: light, clips, jitter and shapes of brushes do not know them.
enum class On { Every, TwoOfFour };

struct Mode {
    const char* name;
    On lattices;
    std::function<void(Scene&)> apply;
    std::size_t outliers = kOutliers;
    double rmse = kRmse;
};
/// Cube maps: what the driver does where three texels meet, at the corners of the cube, is its own business.
constexpr std::size_t kCornerOutliers = 24;

const Mode kModes[] = {
    {"composite", On::Every,
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a", .shaded = false}}};
     }},
    {"shaded", On::Every,
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a", .density = 3}}};
     }},
    {"wide gradients", On::Every,
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a", .density = 3}},
                     {"", true, IsoLayer{.channel = "a", .value = 317, .opacity = 0.7f}}};
         s.render.gradient = volume::GradientSpan::Wide;
     }},
    {"iso", On::Every,
     [](Scene& s) {
         s.layers = {{"", true, IsoLayer{.channel = "a", .value = 317, .opacity = 0.7f}}};
     }},
    {"physical", On::TwoOfFour,
     [](Scene& s) {
         s.layers = {{"", true, IsoLayer{.channel = "a", .value = 317, .opacity = 0.7f}},
                     {"", true, VolumeLayer{.channel = "a", .density = 3}}};
         s.lighting.model = LightModel::Physical;
         s.lighting.lights = {
             Light{.color = {1, 0.9f, 0.7f}, .intensity = 1.5f},
             Light{.kind = LightKind::Point, .color = {0.4f, 0.6f, 1}, .position = {0.6f, 0.2f, -0.4f}}};
     },
     kOutliers, 1.5 * kRmse}, // narrow highlights of normals whose differences span one sample distance
    {"many lights", On::TwoOfFour,
     [](Scene& s) {
         s.layers = {{"", true, IsoLayer{.channel = "a", .value = 317}}};
         for (int i = 0; i < 15; ++i)
             s.lighting.lights.push_back({.enabled = i != 3,
                                          .kind = i % 3 == 0 ? LightKind::World : LightKind::Point,
                                          .intensity = 0.1f,
                                          .azimuth = 40.0f * float(i % 9) - 160,
                                          .position = {0.3f * float(i % 4), 0.8f, -0.2f * float(i)}});
     }},
    {"cube maps", On::TwoOfFour,
     [](Scene& s) {
         s.layers = {{"", true, IsoLayer{.channel = "a", .value = 317, .opacity = 0.7f}},
                     {"", true, VolumeLayer{.channel = "a", .density = 3}}};
         s.lighting.lights.assign(30, Light{.color = {1, 0.8f, 0.6f}, .intensity = 0.04f, .elevation = 20});
         s.lighting.inMaps = true;
         s.lighting.environment = {.kind = Environment::Studio, .turn = 35};
     },
     kCornerOutliers, 2 * kRmse},
    {"physical sky", On::TwoOfFour,
     [](Scene& s) {
         s.layers = {{"", true, IsoLayer{.channel = "a", .value = 317}}};
         s.lighting.model = LightModel::Physical;
         s.lighting.roughness = 0.5f;
         s.lighting.metalness = 0.4f;
         s.lighting.environment = {.kind = Environment::Sky, .strength = 0.8f, .follows = true};
     },
     kCornerOutliers, 2 * kRmse},
    {"lit by a picture", On::TwoOfFour,
     [](Scene& s) {
         s.layers = {{"", true, IsoLayer{.channel = "a", .value = 317, .opacity = 0.7f}},
                     {"", true, VolumeLayer{.channel = "a", .density = 3}}};
         s.lighting.environment = {.kind = Environment::Picture,
                                   .picture = TESSERA_SOURCE_DIR "/tests/fuzz/corpus/fuzz_light_picture/runs.hdr",
                                   .strength = 0.7f,
                                   .turn = 50};
     },
     kCornerOutliers, 2 * kRmse},
    {"shadows", On::Every,
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a", .density = 3}},
                     {"", true, IsoLayer{.channel = "b", .value = 0.9, .opacity = 0.6f}}};
         s.lighting.lights.push_back({.kind = LightKind::Point, .intensity = 0.5f, .position = {0.5f, 0.7f, 0.1f}});
         s.lighting.shadows = {.strength = 0.9f, .occlusion = 0.8f, .resolution = 24};
         s.clips = {{.keep = ClipKeep::Outside, .center = {0.2f, 0.5f, 0.5f}, .axis = {-1, 0.2f, 0}}};
     }},
    {"translucent", On::TwoOfFour,
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a", .shaded = false, .density = 4}}};
         s.lighting.shadows = {.strength = 1, .translucency = 0.8f, .resolution = 20};
         s.selection.brushes = {rangeBrush({{"b", 0.1, 0.9, 0.2}})};
     }},
    {"clipped", On::TwoOfFour,
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a", .density = 3}},
                     {"", true, IsoLayer{.channel = "b", .value = 0.55, .opacity = 0.6f}},
                     {"", true, SliceLayer{.channel = "a", .orientation = SliceOrientation::Y, .opacity = 0.8f}},
                     {"", true, VolumeLayer{.channel = "b", .style = RayStyle::XRay, .density = 0.3f}}};
         s.clips = {{.axis = {0.6f, 0.7f, 0.2f}},
                    {.kind = ClipKind::Sphere, .keep = ClipKeep::Outside, .center = {0.4f, 0.3f, 0.6f}, .radius = 0.2f},
                    {.enabled = false, .kind = ClipKind::Sphere, .radius = 0},
                    {.kind = ClipKind::Cylinder,
                     .keep = ClipKeep::Outside,
                     .center = {0.3f, 0.6f, 0.2f},
                     .axis = {1, 0, 0.3f},
                     .radius = 0.12f,
                     .length = 0.5f},
                    {.kind = ClipKind::Box, .size = {0.6f, 0.5f, 0.85f}}};
     }},
    {"clipped plain", On::TwoOfFour,
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a", .shaded = false}},
                     {"", true, VolumeLayer{.channel = "b", .style = RayStyle::Maximum}}};
         s.clips = {{.kind = ClipKind::Box, .keep = ClipKeep::Outside, .size = {0.3f, 0.4f, 0.5f}},
                    {.kind = ClipKind::Cylinder, .axis = {0.1f, 0.2f, 1}, .radius = 0.35f, .length = 0.9f}};
     }},
    {"jittered still", On::TwoOfFour,
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a", .density = 3}},
                     {"", true, SliceLayer{.channel = "b", .opacity = 0.5f}}};
         s.render.jitter = true;
         s.render.samples = 3;
     }},
    {"maximum", On::Every,
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "b", .style = RayStyle::Maximum}}};
     }},
    {"average", On::Every,
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "b", .style = RayStyle::Average}}};
     }},
    {"slices", On::Every,
     [](Scene& s) {
         s.layers = {{"", true, SliceLayer{.channel = "a", .orientation = SliceOrientation::X}},
                     {"", true,
                      SliceLayer{.channel = "b",
                                 .orientation = SliceOrientation::Oblique,
                                 .atCursor = false,
                                 .position = 0.4,
                                 .normal = {0.3f, 0.5f, -0.8f},
                                 .opacity = 0.6f}},
                     {"", true, SliceLayer{.channel = "label", .atCursor = false, .position = 0.83}}};
     }},
    {"strokes", On::TwoOfFour,
     [](Scene& s) {
         s.layers = {{"", true, SliceLayer{.channel = "a", .orientation = SliceOrientation::X, .contours = 2}},
                     {"", true, SliceLayer{.channel = "b", .orientation = SliceOrientation::Z, .opacity = 0.7f}},
                     {"", true, SliceLayer{.channel = "b", .orientation = SliceOrientation::Y}}};
         std::get<SliceLayer>(s.layers[0].technique).strokes.strength = 0.8f;
         std::get<SliceLayer>(s.layers[1].technique).strokes.grey = true;
         s.strokes = {{0, reference::someStrokes({0, 1, 0}, {0, 0, 1})},
                      {1, reference::someStrokes({0.6, 0.8, 0}, {-0.8, 0.6, 0})}};
     },
     kCornerOutliers},
    {"contour lines", On::Every,
     [](Scene& s) {
         s.layers = {{"", true, SliceLayer{.channel = "a", .orientation = SliceOrientation::X, .contours = 3}}};
     },
     kCornerOutliers},
    {"layers and brushes", On::Every,
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a"}},
                     {"", true, IsoLayer{.channel = "b", .value = 0.55, .color = {0.2f, 0.5f, 0.9f}, .opacity = 0.5f}},
                     {"", true, SliceLayer{.channel = "a", .orientation = SliceOrientation::Y, .opacity = 0.8f}},
                     {"", false, IsoLayer{.channel = "a", .value = 300}},
                     {"", true, VolumeLayer{.channel = "b", .style = RayStyle::Maximum, .density = 0.5f}}};
         s.selection.brushes = {rangeBrush({{"a", 290, 340, 12}, {"b", 0.1, 0.9, 0.2}}),
                                rangeBrush({{"b", 0.3, 0.4, 0.05}})};
         s.selection.brushes[1].inverted = true;
         s.selection.contextOpacity = 0.2f;
     }},
    {"brushes of every shape", On::TwoOfFour,
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a"}},
                     {"", true, SliceLayer{.channel = "b", .orientation = SliceOrientation::Y}}};
         s.selection.brushes = {
             {.region = EllipseRegion{"a", "b", {310, 0.5}, {40, 0.4}, 0.5, 0.4}},
             {.combine = BrushCombine::Or,
              .region = LassoRegion{"b", "a", {{0.1, 280}, {0.9, 290}, {0.5, 310}, {0.8, 350}, {0.2, 340}}, 0.3}},
             {.combine = BrushCombine::Minus, .region = SphereRegion{s.cursor, glm::dvec3(4, 3, 5), 0.5}},
             {.inverted = true, .region = BoxRegion{s.cursor * 0.5, glm::dvec3(2, 3, 2), 0.4}}};
         s.selection.contextOpacity = 0.1f;
     }},
};

class RaycastReference : public testing::TestWithParam<Case> {
protected:
    HeadlessContext context;
};

INSTANTIATE_TEST_SUITE_P(Lattices, RaycastReference,
                         testing::Values(Case{LatticeKind::CC, false}, Case{LatticeKind::CC, true},
                                         Case{LatticeKind::BCC, false}, Case{LatticeKind::BCC, true}),
                         [](const auto& each) { return each.param.name(); });

TEST_P(RaycastReference, ExactTexturesAgreeAndSixteenBitsAreClose) {
    Drawing drawing(GetParam().kind, GetParam().masked, true), rounded(GetParam().kind, GetParam().masked, false);
    const bool coarse = !currentDriver().exactFilter; // then cube maps are, too
    const bool oneOfTwo = (GetParam().kind == LatticeKind::BCC) == GetParam().masked;
    for (const Mode& mode : kModes) {
        if (mode.lattices == On::TwoOfFour && !oneOfTwo) continue;
        for (bool perspective : {false, true}) {
            Scene scene = baseScene(perspective);
            mode.apply(scene);
            const Image got = drawing.draw(scene), wanted = drawing.truth(scene);
            const std::string name = GetParam().name() + " " + mode.name + (perspective ? " perspective" : " parallel");
            const reference::Difference difference = reference::compare(got, wanted, kOutlier);
            double most = 0;
            for (const glm::dvec4& pixel : wanted.pixels) most = std::max(most, pixel.a);
            EXPECT_GT(most, 0.2) << name << " shows next to nothing";
            EXPECT_TRUE(difference.rmseWithin <= (coarse ? std::max(mode.rmse, 1e-5) : mode.rmse) &&
                        difference.beyond <= mode.outliers + (coarse ? 8 : 0))
                << name << ": " << words(difference) << "; " << evidence(name, got, wanted);
            if (!perspective || !oneOfTwo) continue;
            const Image close = rounded.draw(scene);
            const reference::Difference rounding = reference::compare(close, wanted, kOutlier);
            EXPECT_GE(rounding.psnr, kPsnr16)
                << name << ", 16 bit: " << words(rounding) << "; " << evidence(name + " 16 bit", close, wanted);
        }
    }
}

TEST_P(RaycastReference, EveryFilterAgrees) {
    Drawing drawing(GetParam().kind, GetParam().masked, true);
    for (std::size_t filter = 0; filter < std::size(kFilterNames); ++filter) {
        Scene scene = baseScene(true);
        scene.layers = {{"", true, VolumeLayer{.channel = "a", .density = 3}}};
        scene.render.filter = Filter(filter);
        const Image got = drawing.draw(scene), wanted = drawing.truth(scene);
        const reference::Difference difference = reference::compare(got, wanted, kOutlier);
        const std::string name = GetParam().name() + " filter " + std::string(kFilterNames[filter]);
        EXPECT_TRUE(agrees(difference)) << name << ": " << words(difference) << "; " << evidence(name, got, wanted);
    }
}

TEST_P(RaycastReference, StepStretchAndEyeInsideAgree) {
    Drawing drawing(GetParam().kind, GetParam().masked, true);
    Scene scene = baseScene(true);
    scene.layers = {{"", true, VolumeLayer{.channel = "a", .density = 2}},
                    {"", true, IsoLayer{.channel = "a", .value = 330, .opacity = 0.5f}}};
    const auto check = [&](const std::string& what) {
        const Image got = drawing.draw(scene), wanted = drawing.truth(scene);
        const reference::Difference difference = reference::compare(got, wanted, kOutlier);
        const std::string name = GetParam().name() + " " + what;
        EXPECT_TRUE(agrees(difference)) << name << ": " << words(difference) << "; " << evidence(name, got, wanted);
    };
    scene.render.stepVoxels = 1.7f;
    check("long steps");
    scene.render.stepVoxels = 0.5f;
    scene.stretch = {3, 0.7, 1};
    check("stretched");
    scene.camera.distance = 0.2f;
    check("eye inside");
}

/// A source whose levels finer than the coarsest are held back until they are released.
struct HeldBack : volume::BrickSource {
    std::shared_ptr<const volume::BrickSource> inner;
    mutable std::atomic<bool> released = false;

    explicit HeldBack(std::shared_ptr<const volume::BrickSource> held) : inner(std::move(held)) {}
    const volume::DatasetInfo& info() const override { return inner->info(); }
    const volume::BrickGrid& grid() const override { return inner->grid(); }
    volume::BrickStats stats(const volume::BrickKey& key) const override { return inner->stats(key); }
    volume::BrickSamples read(const volume::BrickKey& key) const override {
        if (key.level < grid().levels - 1) released.wait(false);
        return inner->read(key);
    }
    void release() const {
        released = true;
        released.notify_all();
    }
};

/// While fine bricks are still on their way the coarsest level is shown: the same picture, less sharp, and not moved.
TEST_P(RaycastReference, CoarseLevelsLieWhereTheFineOnesDo) {
    const glm::ivec3 size(150, 161, 130); // enough that the renderer shows the coarsest level first
    const auto wave = [](glm::dvec3 p) {
        return 0.5 + 0.2 * std::sin(p.x * 0.06) * std::cos(p.y * 0.05) + 0.25 * std::sin(p.z * 0.06 + 0.03 * p.x);
    };
    const bool masked = GetParam().masked;
    volume::Dataset dataset;
    dataset.info.lattice.size = size;
    dataset.info.bounds = {glm::dvec3(0), glm::dvec3(size - 1)};
    volume::Parameter parameter;
    parameter.name = "a";
    parameter.ranges = {{0.05, 0.95}};
    dataset.info.parameters = {parameter};
    dataset.read = [=, lattice = dataset.info.lattice](int, int, int) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::F32);
        volume::Mask mask(field.count());
        for (std::size_t i = 0; i < field.count(); ++i) {
            const glm::ivec3 at(int(i) % size.x, int(i) / size.x % size.y, int(i) / (size.x * size.y));
            field.as<float>()[i] = float(wave(glm::dvec3(at)));
            mask[i] = !masked || glm::length(glm::dvec3(at) - glm::dvec3(73, 78, 61)) < 68;
        }
        field.mask = std::make_shared<const volume::Mask>(std::move(mask));
        return field;
    };
    const auto memory = volume::makeMemorySource(dataset, {.lattice = GetParam().kind, .brickSize = 16});
    Scene scene = baseScene(true);
    scene.transfer["a"].opacity = {{0, 0.1f}, {1, 0.1f}};
    scene.layers = {{"", true, VolumeLayer{.channel = "a", .shaded = false}}};
    const auto held = std::make_shared<const HeldBack>(memory);
    ASSERT_GE(held->grid().levels, 3);
    Renderer renderer;
    renderer.setSource(held);
    const ViewTargetPtr target = renderer.makeTarget();
    FrameRequest request;
    request.size = kSize;
    request.budgetMs = 10000;
    Image coarse;
    coarse.size = kSize;
    for (int frame = 0; frame < 20000; ++frame) {
        const FrameStatus status = renderer.render(*target, scene, request);
        ASSERT_FALSE(status.complete);
        coarse.pixels.clear();
        for (const glm::vec4& pixel : renderer.readLinear(*target)) coarse.pixels.emplace_back(pixel);
        ASSERT_TRUE(std::ranges::none_of(coarse.pixels, [](glm::dvec4 pixel) { return std::isnan(pixel.a); }))
            << "before anything is drawn a picture is empty";
        if (std::ranges::any_of(coarse.pixels, [](glm::dvec4 pixel) { return pixel.a > 0.2; })) break;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    held->release();
    request.wait = true;
    EXPECT_TRUE(renderer.render(*target, scene, request).complete);
    Image fine;
    fine.size = kSize;
    for (const glm::vec4& pixel : renderer.readLinear(*target)) fine.pixels.emplace_back(pixel);
    EXPECT_GT(reference::compare(fine, reference::render(scene, *memory, kSize), 1).psnr, kPsnr16);
    const reference::Difference difference = reference::compare(fine, coarse, kOutlier);
    const std::string name = GetParam().name() + " coarse";
    EXPECT_GT(difference.rmse, 1e-4) << "nothing was held back";
    EXPECT_GT(difference.psnr, masked ? 28 : 45)
        << name << ": " << words(difference) << "; " << evidence(name, coarse, fine);
}

/// The comparison notices every error that a shader of this kind could make.
TEST_P(RaycastReference, NoticesFlaws) {
    const bool bcc = GetParam().kind == LatticeKind::BCC;
    struct Flawed {
        const char* name;
        bool applies;
        Flaws flaws;
    };
    const Flawed cases[] = {{"additive blend", true, {.additiveBlend = true}},
                            {"unmoved sublattice", bcc, {.unmovedSublattice = true}},
                            {"bricks without borders", true, {.clampedBricks = true}},
                            {"mask ignored", GetParam().masked, {.ignoredMask = true}},
                            {"prefilter left out", true, {.unfiltered = true}}};
    Drawing drawing(GetParam().kind, GetParam().masked, true);
    Scene scene = baseScene(true);
    scene.layers = {{"", true, VolumeLayer{.channel = "a", .density = 3}}};
    const Image got = drawing.draw(scene);
    ASSERT_TRUE(agrees(reference::compare(got, drawing.truth(scene), kOutlier)));
    for (const Flawed& flawed : cases) {
        if (!flawed.applies) continue;
        const reference::Difference difference = reference::compare(got, drawing.truth(scene, flawed.flaws), kOutlier);
        EXPECT_FALSE(agrees(difference)) << flawed.name << ": " << words(difference);
        EXPECT_GT(difference.beyond, 4 * kOutliers) << flawed.name << " is noticed by a wide margin";
    }
}

} // namespace
} // namespace tessera::vis
