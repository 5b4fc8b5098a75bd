#pragma once

#include "tests/vis/function_source.h"
#include "tests/vis/gl_fixture.h"

#include <cmath>
#include <functional>

/// Scenes and data that tests of the renderer share.
namespace tessera::test {

using vis::Scene;

inline vis::RendererOptions exact() {
    vis::RendererOptions options;
    options.exactTextures = true;
    return options;
}

/// One composite layer of channel "v" with a constant opacity over the range 0..1.
inline Scene flatScene(float opacity) {
    Scene scene;
    scene.camera = test::frontCamera();
    vis::VolumeLayer layer;
    layer.channel = "v";
    layer.shaded = false;
    scene.layers.push_back({"volume", true, layer});
    vis::TransferFunction function;
    function.autoRange = false;
    function.range = {0, 1};
    function.opacity = {{0, opacity}, {1, opacity}};
    scene.transfer["v"] = function;
    scene.showBox = false;
    scene.render.samples = 1;
    return scene;
}

/// A smooth field that is absent in a corner, a label, and a field everywhere; many small bricks.
inline std::shared_ptr<vis::FunctionSource> brickedSource(volume::LatticeKind kind) {
    const auto v = [](glm::dvec3 p) -> std::optional<double> {
        if (p.x + p.y + p.z < 13) return std::nullopt;
        return 0.5 + 0.4 * std::sin(0.5 * p.x) * std::cos(0.4 * p.y + 0.3 * p.z);
    };
    const auto w = [](glm::dvec3 p) -> std::optional<double> { return p.x * 0.04 - p.z * 0.01; };
    const auto label = [](glm::dvec3 p) -> std::optional<double> { return p.y > 12 ? 2 : 1; };
    return std::make_shared<vis::FunctionSource>(
        kind, glm::ivec3(29, 25, 37), glm::dvec3(1),
        std::vector<vis::FunctionSource::Channel>{{"v", v}, {"w", w}, {"label", label, {1, 2}, true}});
}

inline Scene richScene() {
    Scene scene = flatScene(0.1f);
    scene.camera = {};
    scene.camera.distance = 1.8f;
    scene.transfer["v"].opacity = {{0, 0}, {0.3f, 0}, {0.5f, 0.3f}, {1, 0.6f}};
    std::get<vis::VolumeLayer>(scene.layers[0].technique).shaded = true;
    scene.layers.push_back({"iso", true, vis::IsoLayer{.channel = "w", .value = 0.35, .opacity = 0.5f}});
    scene.layers.push_back({"slice", true, vis::SliceLayer{.channel = "label", .atCursor = false, .position = 0.3}});
    scene.selection.brushes = {vis::rangeBrush({{"w", 0.2, 0.9, 0.1}})};
    return scene;
}

/// Another source's bricks, after asking `check`.
class CheckedSource : public volume::BrickSource {
public:
    CheckedSource(std::shared_ptr<const volume::BrickSource> source, std::function<void(const volume::BrickKey&)> check)
        : source_(std::move(source)), check_(std::move(check)) {}
    const volume::DatasetInfo& info() const override { return source_->info(); }
    const volume::BrickGrid& grid() const override { return source_->grid(); }
    volume::BrickStats stats(const volume::BrickKey& key) const override { return source_->stats(key); }
    volume::BrickSamples read(const volume::BrickKey& key) const override {
        check_(key);
        return source_->read(key);
    }

private:
    std::shared_ptr<const volume::BrickSource> source_;
    std::function<void(const volume::BrickKey&)> check_;
};

} // namespace tessera::test
