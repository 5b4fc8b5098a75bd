#include "tests/vis/function_source.h"
#include "tests/vis/gl_fixture.h"

#include "vis/model/ray_setup.h"
#include "vis/reference/raycast.h"

#include <cmath>

/// Each style, filter and lattice against the double-precision reference.
namespace tessera {
namespace {

using vis::Scene;
using volume::LatticeKind;

/// Three channels on an odd-sized, anisotropic grid: a smooth field, one that exists in half of the box only, a label.
std::shared_ptr<const volume::BrickSource> testSource(LatticeKind kind) {
    const auto smooth = [](glm::dvec3 p) -> std::optional<double> {
        return 3 + std::sin(0.6 * p.x + 0.2) * std::cos(0.4 * p.y) + 0.5 * std::sin(0.45 * p.z);
    };
    const auto half = [](glm::dvec3 p) -> std::optional<double> {
        if (p.x + 0.3 * p.y > 9.1) return std::nullopt;
        return 100 + 0.01 * p.z * p.z + std::cos(0.7 * p.x);
    };
    const auto label = [](glm::dvec3 p) -> std::optional<double> { return p.y > 6.2 ? 3 : p.x > 4 ? 1 : 0; };
    return std::make_shared<vis::FunctionSource>(
        kind, glm::ivec3(17, 14, 21), glm::dvec3(1, 1, 0.5),
        std::vector<vis::FunctionSource::Channel>{
            {"a", smooth, {1.5, 4.5}}, {"b", half, {99, 102}}, {"label", label, {0, 3}, true}});
}

Scene baseScene() {
    Scene scene;
    scene.showBox = false;
    scene.camera.distance = 1.9f;
    vis::TransferFunction a;
    a.opacity = {{0, 0}, {0.4f, 0}, {0.6f, 0.2f}, {1, 0.5f}};
    scene.transfer["a"] = a;
    vis::TransferFunction b;
    b.colormap = "inferno";
    b.opacity = {{0, 0.02f}, {1, 0.3f}};
    scene.transfer["b"] = b;
    return scene;
}

void add(Scene& scene, vis::Technique technique) {
    scene.layers.push_back({"layer", true, std::move(technique)});
}

vis::VolumeLayer volumeLayer(const char* channel, vis::VolumeStyle style, bool shaded = true) {
    vis::VolumeLayer layer;
    layer.channel = channel;
    layer.style = style;
    layer.shaded = shaded;
    return layer;
}

vis::IsoLayer isoLayer(const char* channel, double value, float opacity) {
    vis::IsoLayer layer;
    layer.channel = channel;
    layer.value = value;
    layer.opacity = opacity;
    return layer;
}

vis::SliceLayer sliceLayer(const char* channel, vis::SliceOrientation orientation, double position, float opacity) {
    vis::SliceLayer layer;
    layer.channel = channel;
    layer.orientation = orientation;
    layer.atCursor = false;
    layer.position = position;
    layer.opacity = opacity;
    layer.normal = {0.3f, -0.5f, 0.8f};
    return layer;
}

class RayStyles : public test::GlTest {
protected:
    /// Renders on both lattices and compares: RMSE of pixels within 1e-3, and how many lie beyond (a sample at the edge
    /// of a mask or a crossing may fall on either side).
    void compare(const Scene& scene, double rmse = 1e-5, double share = 0.002, const char* what = "") {
        const glm::ivec2 size(72, 60);
        for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
            SCOPED_TRACE(std::string(what) + (kind == LatticeKind::CC ? " CC" : " BCC"));
            const auto source = testSource(kind);
            vis::RendererOptions options;
            options.exactTextures = true;
            vis::Renderer renderer(options);
            renderer.setSource(source);
            const vis::ViewTargetPtr target = renderer.makeTarget();
            test::renderAll(renderer, *target, scene, size);
            const std::vector<glm::vec4> drawn = renderer.readLinear(*target);
            for (const std::string& message : renderer.takeMessages()) ADD_FAILURE() << message;
            vis::reference::Image got;
            got.size = size;
            for (const glm::vec4& pixel : drawn) got.pixels.emplace_back(pixel);
            const vis::reference::Image expected = vis::reference::render(scene, *source, size, {});
            const vis::reference::Difference difference = vis::reference::compare(got, expected, 1e-3);
            EXPECT_LT(difference.rmseWithin, rmse);
            EXPECT_LE(double(difference.beyond), share * size.x * size.y)
                << "worst " << difference.maximum << " at " << difference.worst.x << ", " << difference.worst.y;
            double sum = 0;
            for (const glm::dvec4& pixel : expected.pixels) sum += pixel.a;
            EXPECT_GT(sum, 50) << "the scene shows nothing";
        }
    }
};

TEST_F(RayStyles, CompositeUnshaded) {
    Scene scene = baseScene();
    add(scene, volumeLayer("a", vis::VolumeStyle::Composite, false));
    compare(scene);
}
TEST_F(RayStyles, CompositeShaded) {
    Scene scene = baseScene();
    add(scene, volumeLayer("a", vis::VolumeStyle::Composite));
    compare(scene);
}
TEST_F(RayStyles, EveryFilter) {
    Scene scene = baseScene();
    add(scene, volumeLayer("a", vis::VolumeStyle::Composite));
    for (const vis::Filter filter : {vis::Filter::AverageQuasi, vis::Filter::Average, vis::Filter::Tetrahedral}) {
        scene.render.filter = filter;
        compare(scene, 1e-5, 0.002, vis::kFilterNames[int(filter)].data());
    }
}
TEST_F(RayStyles, MaskedChannel) {
    Scene scene = baseScene();
    add(scene, volumeLayer("b", vis::VolumeStyle::Composite));
    compare(scene);
}
TEST_F(RayStyles, IsoSurfaces) {
    Scene scene = baseScene();
    add(scene, isoLayer("a", 3.2, 0.6f));
    add(scene, isoLayer("b", 100.4, 1));
    compare(scene, 1e-4, 0.01);
}
TEST_F(RayStyles, MaximumAndXRay) {
    Scene scene = baseScene();
    add(scene, volumeLayer("b", vis::VolumeStyle::Maximum));
    compare(scene);
    scene.layers.clear();
    add(scene, volumeLayer("a", vis::VolumeStyle::XRay));
    compare(scene);
}
TEST_F(RayStyles, SlicesAlone) {
    Scene scene = baseScene();
    add(scene, sliceLayer("a", vis::SliceOrientation::X, 0.4, 1));
    add(scene, sliceLayer("b", vis::SliceOrientation::Oblique, 0.5, 0.5f));
    compare(scene, 1e-5, 0.004);
}
TEST_F(RayStyles, EverythingTogetherOrthographic) {
    Scene scene = baseScene();
    scene.camera.projection = vis::Projection::Orthographic;
    scene.stretch = {1, 2, 0.7};
    add(scene, sliceLayer("a", vis::SliceOrientation::Z, 0.4, 0.5f));
    add(scene, volumeLayer("a", vis::VolumeStyle::Composite));
    add(scene, volumeLayer("b", vis::VolumeStyle::Maximum));
    add(scene, isoLayer("a", 2.8, 0.4f));
    compare(scene, 1e-4, 0.01);
}
TEST_F(RayStyles, Brushes) {
    Scene scene = baseScene();
    add(scene, volumeLayer("a", vis::VolumeStyle::Composite));
    add(scene, isoLayer("a", 2.6, 0.4f));
    add(scene, sliceLayer("b", vis::SliceOrientation::Y, 0.6, 0.8f));
    vis::Brush box;
    box.intervals = {{"a", 3, 3.8, 0.3}, {"b", 99.5, 101.5, 0}};
    vis::Brush label;
    label.inverted = true;
    label.intervals = {{"label", 1, 1, 0}};
    scene.selection.brushes = {box, label};
    for (const vis::Combine combine : {vis::Combine::All, vis::Combine::Any}) {
        scene.selection.combine = combine;
        compare(scene, 1e-4, 0.02);
    }
}

} // namespace
} // namespace tessera
