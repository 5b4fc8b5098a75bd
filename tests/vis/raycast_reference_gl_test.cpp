#include "tests/vis/function_source.h"
#include "vis/gl/headless.h"
#include "vis/image_io.h"
#include "vis/model/ray_setup.h"
#include "vis/reference/raycast.h"
#include "vis/renderer.h"
#include "volume/memory_source.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <gtest/gtest.h>
#include <memory>
#include <thread>

/// The shader's pictures against the double-precision reference: every style on CC and BCC, with and without absent
/// samples, parallel and perspective. Linear light before the background, all four components.
///
/// Tolerance with 32-bit textures (Mesa's software GL reaches RMSE 1e-6 and two outliers): RMSE <= kRmse over the
/// pixels that are within kOutlier of the reference, and at most kOutliers pixels of the picture that are not. Outliers
/// are pixels where a yes or no (present or absent, above or below an iso-value, one sample more or less, the nearest
/// label) falls the other way in single precision. Tolerance with 16-bit textures and a 16-bit float target: PSNR >=
/// kPsnr16 for a peak of 1 (reached: 75 dB).
namespace tessera::vis {
namespace {

using reference::Flaws;
using reference::Image;
using volume::LatticeKind;

constexpr glm::ivec2 kSize{72, 56};
constexpr double kRmse = 2e-6, kOutlier = 1e-4;
constexpr std::size_t kOutliers = 8; // of 4032 pixels
constexpr double kPsnr16 = 65;

/// Two scalars, a label and (where masked) absent samples outside a ball and in a slab; sizes that fill no brick.
std::shared_ptr<FunctionSource> source(LatticeKind kind, bool masked) {
    const auto present = [masked](glm::dvec3 p) {
        return !masked || (glm::length((p - glm::dvec3(9, 8, 12)) / glm::dvec3(9.3, 8.4, 12.7)) < 1 &&
                           std::abs(p.x - p.z * 0.5 - 2.2) > 1.7);
    };
    const auto a = [=](glm::dvec3 p) -> std::optional<double> {
        if (!present(p)) return std::nullopt;
        return 300 + 40 * std::sin(0.45 * p.x + 0.2) * std::cos(0.5 * p.y) + 35 * std::sin(0.4 * p.z + 0.1 * p.x);
    };
    const auto b = [=](glm::dvec3 p) -> std::optional<double> {
        if (!present({p.x, p.y + 1, p.z})) return std::nullopt;
        return 0.04 * (p.x + p.y) + 0.3 * std::cos(0.35 * p.z);
    };
    const auto label = [](glm::dvec3 p) -> std::optional<double> {
        return std::floor(p.z / 6.3) + (p.x > 7.3 ? 1 : 0);
    };
    return std::make_shared<FunctionSource>(kind, glm::ivec3(19, 17, 25), glm::dvec3(1),
                                            std::vector<FunctionSource::Channel>{{"a", a, {225, 375}},
                                                                                 {"b", b, {-0.3, 1.7}},
                                                                                 {"label", label, {0, 5}, true}},
                                            8, glm::dvec3(0.137, 0.211, 0.173));
}

Scene baseScene(bool perspective) {
    Scene scene;
    scene.camera.projection = perspective ? Projection::Perspective : Projection::Orthographic;
    scene.camera.distance = perspective ? 1.7f : 2.1f;
    scene.camera.target = {0.04f, -0.03f, 0.02f};
    scene.showBox = false;
    scene.transfer["a"].opacity = {{0, 0}, {0.3f, 0}, {1, 0.06f}};
    scene.transfer["b"].colormap = "inferno";
    scene.transfer["b"].opacity = {{0, 0.3f}, {1, 1}};
    scene.transfer["label"].colormap = "labels";
    scene.transfer["label"].opacity = {{0, 0.02f}, {1, 0.02f}};
    scene.cursor = {9.3, 7.7, 12.2};
    return scene;
}

struct Mode {
    const char* name;
    std::function<void(Scene&)> apply;
};

const Mode kModes[] = {
    {"composite",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a", .shaded = false}}};
     }},
    {"shaded",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a", .density = 3}}};
     }},
    {"iso",
     [](Scene& s) {
         s.layers = {{"", true, IsoLayer{.channel = "a", .value = 317, .opacity = 0.7f}}};
     }},
    {"maximum",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "b", .style = VolumeStyle::Maximum}}};
     }},
    {"xray",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "b", .style = VolumeStyle::XRay}}};
     }},
    {"slices",
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
    {"layers and brushes",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a"}},
                     {"", true, IsoLayer{.channel = "b", .value = 0.55, .color = {0.2f, 0.5f, 0.9f}, .opacity = 0.5f}},
                     {"", true, SliceLayer{.channel = "a", .orientation = SliceOrientation::Y, .opacity = 0.8f}},
                     {"", false, IsoLayer{.channel = "a", .value = 300}},
                     {"", true, VolumeLayer{.channel = "b", .style = VolumeStyle::Maximum, .density = 0.5f}}};
         s.selection.brushes = {{.intervals = {{"a", 290, 340, 12}, {"b", 0.1, 0.9, 0.2}}},
                                {.inverted = true, .intervals = {{"b", 0.3, 0.4, 0.05}}}};
         s.selection.contextOpacity = 0.2f;
     }},
};

/// One renderer for a data set and its pictures.
struct Drawing {
    std::shared_ptr<FunctionSource> data;
    Renderer renderer;

    Drawing(LatticeKind kind, bool masked, bool exact)
        : data(source(kind, masked)), renderer(RendererOptions{.exactTextures = exact}) {
        renderer.setSource(data);
    }
    Image draw(const Scene& scene) {
        const ViewTargetPtr target = renderer.makeTarget();
        FrameRequest request;
        request.size = kSize;
        request.wait = true;
        const FrameStatus status = renderer.render(*target, scene, request);
        EXPECT_TRUE(status.complete);
        Image image;
        image.size = kSize;
        for (const glm::vec4& pixel : renderer.readLinear(*target)) image.pixels.emplace_back(pixel);
        EXPECT_EQ(image.pixels.size(), std::size_t(kSize.x * kSize.y));
        for (const std::string& message : renderer.takeMessages()) ADD_FAILURE() << message;
        return image;
    }
    Image truth(const Scene& scene, const Flaws& flaws = {}) const {
        return reference::render(scene, *data, kSize, {.flaws = flaws});
    }
};

/// Writes the picture as PNG, colours over black and encoded.
void save(const std::string& name, const Image& image) {
    vis::Image out{image.size, {}};
    for (const glm::dvec4& pixel : image.pixels) {
        for (int c = 0; c < 3; ++c)
            out.rgba.push_back(std::uint8_t(255 * std::clamp(srgbFromLinear(std::max(pixel[c], 0.0)), 0.0, 1.0) + 0.5));
        out.rgba.push_back(255);
    }
    writePng(name, out);
}

/// Saves what was got, what was wanted and ten times their difference, and says where.
std::string evidence(const std::string& name, const Image& got, const Image& wanted) {
    const std::filesystem::path folder = std::filesystem::path(TESSERA_BINARY_DIR) / "test-pictures";
    std::filesystem::create_directories(folder);
    Image difference = got;
    for (std::size_t i = 0; i < got.pixels.size(); ++i)
        difference.pixels[i] = glm::abs(got.pixels[i] - wanted.pixels[i]) * 10.0;
    std::string stem = (folder / name).string();
    save(stem + " got.png", got);
    save(stem + " wanted.png", wanted);
    save(stem + " difference.png", difference);
    return "see " + stem + " *.png";
}

std::string words(const reference::Difference& d) {
    return "RMSE within " + std::to_string(d.rmseWithin * 1e6) + "e-6, " + std::to_string(d.beyond) +
           " outliers, maximum " + std::to_string(d.maximum) + " at " + std::to_string(d.worst.x) + "," +
           std::to_string(d.worst.y) + ", PSNR " + std::to_string(d.psnr) + " dB";
}

bool agrees(const reference::Difference& difference) {
    return difference.rmseWithin <= kRmse && difference.beyond <= kOutliers;
}

struct Case {
    LatticeKind kind;
    bool masked;
    std::string name() const {
        return std::string(volume::kLatticeNames[std::size_t(kind)]) + (masked ? "_masked" : "_whole");
    }
};

class RaycastReference : public testing::TestWithParam<Case> {
protected:
    HeadlessContext context;
};

INSTANTIATE_TEST_SUITE_P(Lattices, RaycastReference,
                         testing::Values(Case{LatticeKind::CC, false}, Case{LatticeKind::CC, true},
                                         Case{LatticeKind::BCC, false}, Case{LatticeKind::BCC, true}),
                         [](const auto& each) { return each.param.name(); });

TEST_P(RaycastReference, ExactTexturesAgree) {
    Drawing drawing(GetParam().kind, GetParam().masked, true);
    for (const Mode& mode : kModes)
        for (bool perspective : {false, true}) {
            Scene scene = baseScene(perspective);
            mode.apply(scene);
            const Image got = drawing.draw(scene), wanted = drawing.truth(scene);
            const std::string name = GetParam().name() + " " + mode.name + (perspective ? " perspective" : " parallel");
            const reference::Difference difference = reference::compare(got, wanted, kOutlier);
            double most = 0;
            for (const glm::dvec4& pixel : wanted.pixels) most = std::max(most, pixel.a);
            EXPECT_GT(most, 0.2) << name << " shows next to nothing";
            EXPECT_TRUE(agrees(difference)) << name << ": " << words(difference) << "; " << evidence(name, got, wanted);
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

TEST_P(RaycastReference, SixteenBitTexturesAreClose) {
    Drawing drawing(GetParam().kind, GetParam().masked, false);
    for (const Mode& mode : kModes) {
        Scene scene = baseScene(true);
        mode.apply(scene);
        const Image got = drawing.draw(scene), wanted = drawing.truth(scene);
        const reference::Difference difference = reference::compare(got, wanted, kOutlier);
        const std::string name = GetParam().name() + " 16 bit " + mode.name;
        EXPECT_GE(difference.psnr, kPsnr16) << name << ": " << words(difference) << "; " << evidence(name, got, wanted);
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
    dataset.load = [=, lattice = dataset.info.lattice](int, int, int) {
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
    for (int frame = 0; frame < 2000; ++frame) {
        const FrameStatus status = renderer.render(*target, scene, request);
        ASSERT_FALSE(status.complete);
        coarse.pixels.clear();
        for (const glm::vec4& pixel : renderer.readLinear(*target)) coarse.pixels.emplace_back(pixel);
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
