#include "tests/reference/raycast.h"
#include "tests/reference/samples.h"
#include "tests/vis/function_source.h"
#include "vis/optics/ray_setup.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace tessera::vis {
namespace {

using reference::Image;
using volume::LatticeKind;

const LatticeKind kKinds[] = {LatticeKind::CC, LatticeKind::BCC};
const Filter kFilters[] = {Filter::AverageQuasi, Filter::Average, Filter::Tetrahedral};

FunctionSource constant(LatticeKind kind, double value) {
    return {kind, {9, 9, 9}, glm::dvec3(0.5), {{"c", [=](glm::dvec3) { return value; }}}};
}

/// A scene seen along -z, parallel, that the unit box fills.
Scene frontal(Technique technique) {
    Scene scene;
    scene.camera.projection = Projection::Orthographic;
    scene.camera.orientation = standardOrientation(StandardView::Front);
    scene.camera.fieldOfView = 60;
    scene.camera.distance = float(0.5 / std::tan(glm::radians(30.0)));
    scene.layers = {{.name = "", .visible = true, .technique = std::move(technique)}};
    scene.showBox = false;
    scene.render.samples = 1;
    TransferFunction gray;
    gray.colormap = "gray";
    gray.opacity = {{0, 0.01f}, {1, 0.01f}};
    scene.transfer["c"] = gray;
    return scene;
}

void expectPixel(const Image& image, glm::ivec2 at, glm::dvec4 wanted, double tolerance) {
    const glm::dvec4 pixel = image.pixels[std::size_t(at.y * image.size.x + at.x)];
    for (int i = 0; i < 4; ++i)
        EXPECT_NEAR(pixel[i], wanted[i], tolerance) << at.x << "," << at.y << " component " << i;
}

TEST(Reference, ConstantDensityHasItsOpacityAtAnyStep) {
    for (LatticeKind kind : kKinds)
        for (Filter filter : kFilters)
            for (float step : {0.3f, 1.0f, 3.0f}) {
                Scene scene = frontal(VolumeLayer{.channel = "c", .density = 0.5f});
                scene.render.filter = filter;
                scene.render.stepVoxels = step;
                const Image image = reference::render(scene, constant(kind, 0.25), {4, 4});
                const double alpha = 1 - std::pow(1 - double(0.01f), 0.5 / kReferenceLength);
                const double light = linearFromSrgb(0.25) * alpha; // no gradient: colour unchanged
                for (int i = 0; i < 4; ++i) expectPixel(image, {i, i}, {light, light, light, alpha}, 1e-9);
            }
}

TEST(Reference, OutsideTheBoxIsNothing) {
    Scene scene = frontal(VolumeLayer{.channel = "c"});
    scene.camera.distance *= 2;
    const Image image = reference::render(scene, constant(LatticeKind::CC, 1), {8, 8});
    expectPixel(image, {1, 4}, glm::dvec4(0), 0);
    EXPECT_GT(image.pixels[4 * 8 + 2].a, 0.1);
    scene.layers[0].technique = VolumeLayer{.channel = "no such channel"};
    for (glm::dvec4 pixel : reference::render(scene, constant(LatticeKind::CC, 1), {8, 8}).pixels)
        EXPECT_EQ(pixel, glm::dvec4(0));
}

/// z from 0 (far) to 1 (near) along the box.
FunctionSource ramp(LatticeKind kind) {
    return {kind, {9, 9, 17}, glm::dvec3(2, 2, 1), {{"c", [](glm::dvec3 p) { return p.z / 16; }}}};
}

TEST(Reference, IsoSurfaceOfARampIsLitByPhong) {
    for (LatticeKind kind : kKinds)
        for (Filter filter : kFilters) {
            Scene scene = frontal(IsoLayer{.channel = "c", .value = 0.37, .color = {1, 1, 1}, .opacity = 0.5f});
            scene.render.filter = filter;
            scene.lighting.lights[0].azimuth = 0;
            scene.lighting.lights[0].elevation = 60;
            const Image image = reference::render(scene, ramp(kind), {5, 5});
            const Lighting& p = scene.lighting;
            const double shine = std::pow(std::cos(glm::radians(30.0)), double(p.shininess));
            const double light = p.ambient + p.diffuse * std::cos(glm::radians(60.0)) + p.specular * shine;
            expectPixel(image, {2, 2}, {0.5 * light, 0.5 * light, 0.5 * light, 0.5}, 1e-6);
        }
}

TEST(Reference, LayersCompositeFrontToBack) {
    // Two surfaces of one ramp: the larger value is nearer to the eye, whatever the order of the layers.
    for (bool swapped : {false, true}) {
        Scene scene = frontal(IsoLayer{.channel = "c", .value = 0.8, .color = {1, 0, 0}, .opacity = 0.6f});
        scene.layers.push_back({"", true, IsoLayer{.channel = "c", .value = 0.2, .color = {0, 1, 0}, .opacity = 0.5f}});
        if (swapped) std::swap(scene.layers[0], scene.layers[1]);
        scene.lighting.specular = 0;
        scene.lighting.ambient = 1;
        scene.lighting.diffuse = 0;
        const Image image = reference::render(scene, ramp(LatticeKind::BCC), {3, 3});
        expectPixel(image, {1, 1}, {0.6, 0.4 * 0.5, 0, 0.8}, 1e-6);
        scene.layers[0].visible = false;
        EXPECT_NEAR(reference::render(scene, ramp(LatticeKind::BCC), {3, 3}).pixels[4].a, swapped ? 0.6 : 0.5, 1e-6);
    }
}

TEST(Reference, MaximumAndAverageLookAtTheWholeRay) {
    for (LatticeKind kind : kKinds) {
        Scene scene = frontal(VolumeLayer{.channel = "c", .style = RayStyle::Maximum, .density = 20});
        scene.render.stepVoxels = 0.25f;
        Image image = reference::render(scene, ramp(kind), {3, 3});
        const double alpha = 20 * 0.01f;
        EXPECT_NEAR(image.pixels[4].a, alpha, 1e-6);
        EXPECT_NEAR(srgbFromLinear(image.pixels[4].r / alpha), 1, 0.02);
        scene.layers[0].technique = VolumeLayer{.channel = "c", .style = RayStyle::Average, .density = 20};
        image = reference::render(scene, ramp(kind), {3, 3});
        EXPECT_NEAR(srgbFromLinear(image.pixels[4].r / alpha), 0.5, 2e-3);
    }
}

TEST(Reference, SliceShowsTheValueOnItsPlane) {
    for (LatticeKind kind : kKinds) {
        Scene scene =
            frontal(SliceLayer{.channel = "c", .orientation = SliceOrientation::Z, .atCursor = false, .position = 0.3});
        Image image = reference::render(scene, ramp(kind), {3, 3});
        const double light = linearFromSrgb(0.3);
        for (glm::ivec2 at : {glm::ivec2(0, 0), glm::ivec2(1, 1)})
            expectPixel(image, at, {light, light, light, 1}, 1e-6);
        // Through the cursor, half transparent, before the same again.
        scene.cursor = {8, 8, 12};
        scene.layers.push_back({"", true, SliceLayer{.channel = "c", .opacity = 0.5f}});
        image = reference::render(scene, ramp(kind), {3, 3});
        const double mixed = 0.5 * linearFromSrgb(0.75) + 0.5 * light;
        expectPixel(image, {1, 1}, {mixed, mixed, mixed, 1}, 1e-6);
    }
}

TEST(Reference, AbsentSamplesShowNothingAndDoNotBleed) {
    for (LatticeKind kind : kKinds)
        for (Filter filter : kFilters) {
            const FunctionSource source(kind, {17, 17, 17}, glm::dvec3(1),
                                        {{"c", [](glm::dvec3 p) -> std::optional<double> {
                                              if (p.x < 7.9) return 0.25;
                                              return std::nullopt;
                                          }}});
            Scene scene = frontal(VolumeLayer{.channel = "c", .density = 0.5f});
            scene.render.filter = filter;
            const Image image = reference::render(scene, source, {16, 3});
            const double alpha = 1 - std::pow(1 - double(0.01f), 0.5 / kReferenceLength);
            const double light = linearFromSrgb(0.25) * alpha;
            for (int x = 0; x < 16; ++x) {
                const glm::dvec4 pixel = image.pixels[std::size_t(16 + x)];
                // Wherever something is seen it has exactly the colour of present samples.
                if (pixel.a > 0) {
                    EXPECT_NEAR(pixel.r / pixel.a, light / alpha, 1e-9) << x;
                }
            }
            expectPixel(image, {7, 1}, {light, light, light, alpha}, 1e-9);
            expectPixel(image, {9, 1}, glm::dvec4(0), 0);
        }
}

TEST(Reference, BrushDimsAndGraysWhatIsOutside) {
    Scene scene =
        frontal(SliceLayer{.channel = "c", .orientation = SliceOrientation::Z, .atCursor = false, .position = 0.5});
    scene.transfer["c"].colormap = "viridis";
    scene.selection.brushes = {rangeBrush({{"c", 0.9, 1.0, 0}})};
    scene.selection.contextOpacity = 0.25f;
    scene.selection.contextSaturation = 0;
    const glm::dvec3 color = linearFromSrgb(colormapColor("viridis", 0.5));
    const double gray = 0.25 * luminance(color);
    expectPixel(reference::render(scene, ramp(LatticeKind::CC), {3, 3}), {1, 1}, {gray, gray, gray, 0.25}, 1e-6);
    std::get<RangeRegion>(scene.selection.brushes[0].region).intervals[0].lo = 0.4;
    expectPixel(reference::render(scene, ramp(LatticeKind::CC), {3, 3}), {1, 1}, {color, 1}, 1e-6);
    scene.selection.brushes = {rangeBrush({{"no such channel", 0, 1, 0}})};
    expectPixel(reference::render(scene, ramp(LatticeKind::CC), {3, 3}), {1, 1}, {gray, gray, gray, 0.25}, 1e-6);
}

// Beyond the lattice the last samples go on, on BCC those of either sublattice: no slice comes in another's place.
TEST(Reference, SamplesGoOnBeyondTheLattice) {
    for (const int size : {9, 10}) {
        const FunctionSource whole(LatticeKind::CC, glm::ivec3(size), glm::dvec3(1),
                                   {{"c", [](glm::dvec3 p) { return p.z; }, {0, 10}}});
        const reference::Samples cubic(whole, 0, {0, 0, 0}, Filter::Average, {});
        for (const double beyond : {0.0, 0.3, 0.8, 5.3}) {
            EXPECT_NEAR(*cubic.value({4, 4, size - 1 + beyond}), size - 1, 1e-5) << size;
            EXPECT_NEAR(*cubic.value({4, 4, -beyond}), 0, 1e-5) << size;
        }
        // Even slices hold 0, odd ones 1: anywhere the mean of both sublattices.
        FunctionSource halves(LatticeKind::BCC, glm::ivec3(size), glm::dvec3(1), {{"c", {}, {0, 1}}});
        const volume::Lattice lattice = halves.grid().lattice;
        const FunctionSource mixed(LatticeKind::BCC, glm::ivec3(size), glm::dvec3(1),
                                   {{"c",
                                     [lattice](glm::dvec3 p) {
                                         const double slice = (p.z - lattice.origin.z) / lattice.spacing.z * 2;
                                         return std::abs(std::fmod(slice + 0.25, 2.0)) < 1 ? 0.0 : 1.0;
                                     },
                                     {0, 1}}});
        const reference::Samples bcc(mixed, 0, {0, 0, 0}, Filter::Average, {});
        const double last = lattice.texels().z - 1;
        for (const double z : {-5.3, 0.0, 0.2, 2.5, last - 0.5, last, last + 0.7, last + 5.2})
            EXPECT_NEAR(*bcc.value({3, 3, z}), 0.5, 1e-5) << size << ' ' << z;
    }
}

// How much of a pixel is in focus is that of the ray through its middle, and 0 where there is nothing.
TEST(Reference, InterestIsOfTheFirstRay) {
    Scene scene = frontal(VolumeLayer{.channel = "c", .shaded = false});
    scene.camera.distance *= 2;
    scene.transfer["c"].opacity = {{0, 0}, {0.3f, 0}, {1, 0.5f}};
    scene.selection.brushes = {rangeBrush({{"c", 0.5, 0.8, 0.1}})};
    const glm::ivec2 size(11, 9);
    const Image once = reference::render(scene, ramp(LatticeKind::CC), size);
    scene.render.samples = 4;
    const Image often = reference::render(scene, ramp(LatticeKind::CC), size);
    EXPECT_EQ(often.interest, once.interest);
    EXPECT_NE(often.pixels, once.pixels);
    EXPECT_EQ(once.interest[0], 0) << "beside the box";
    EXPECT_GT(*std::ranges::max_element(once.interest), 0.1);
}

TEST(Reference, LatticesAgreeOnASmoothField) {
    const auto wave = [](glm::dvec3 p) {
        return 0.5 + 0.4 * std::sin(p.x * 0.5) * std::cos(p.y * 0.4) * std::sin(p.z * 0.3);
    };
    const FunctionSource cc(LatticeKind::CC, {17, 17, 17}, glm::dvec3(1), {{"c", wave}});
    const FunctionSource bcc(LatticeKind::BCC, {17, 17, 17}, glm::dvec3(1), {{"c", wave}});
    Scene scene;
    scene.showBox = false;
    scene.render.samples = 1;
    scene.transfer["c"].opacity = {{0, 0}, {1, 0.1f}};
    scene.layers = {{"", true, VolumeLayer{.channel = "c"}}};
    const Image a = reference::render(scene, cc, {24, 24}), b = reference::render(scene, bcc, {24, 24});
    EXPECT_GT(reference::compare(a, b, 0.1).psnr, 38);
    // Single precision moves a picture by less than the tolerance against the shader.
    const reference::Difference rounding = reference::compare(b, reference::renderSingle(scene, bcc, {24, 24}), 1e-3);
    EXPECT_LT(rounding.rmse, 1e-5);
    EXPECT_GT(rounding.rmse, 0);
}

TEST(Reference, CompareCountsAndFindsTheWorst) {
    Image a{{3, 2}, std::vector<glm::dvec4>(6)}, b = a;
    EXPECT_EQ(reference::compare(a, b, 0).rmse, 0);
    b.pixels[4].g = 0.5;
    b.pixels[1].a = 0.1;
    const reference::Difference difference = reference::compare(a, b, 0.2);
    EXPECT_EQ(difference.beyond, 1u);
    EXPECT_EQ(difference.worst, glm::ivec2(1, 1));
    EXPECT_DOUBLE_EQ(difference.rmse, std::sqrt(0.26 / 24));
    b.pixels[0].r = std::nan("");
    EXPECT_EQ(reference::compare(a, b, 0.2).beyond, 2u);
}

} // namespace
} // namespace tessera::vis
