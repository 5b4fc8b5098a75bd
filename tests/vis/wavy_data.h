#pragma once

#include "tests/vis/function_source.h"
#include "vis/scene/scene.h"

#include <atomic>
#include <cmath>
#include <memory>

/// The data of tests that compare whole pictures, drawn by OpenGL or by packets of rays, and the camera that sees them.
namespace tessera::vis {

/// Channels whose samples fill no brick, seen from a box that lies on no lattice plane.
inline std::shared_ptr<FunctionSource> wavySource(volume::LatticeKind kind,
                                                  std::vector<FunctionSource::Channel> channels) {
    return std::make_shared<FunctionSource>(kind, glm::ivec3(19, 17, 25), glm::dvec3(1), std::move(channels), 8,
                                            glm::dvec3(0.137, 0.211, 0.173));
}

/// Where samples are: everywhere, or in a ball but for a slab.
struct WavyPresence {
    bool masked = false;
    bool operator()(glm::dvec3 p) const {
        return !masked || (glm::length((p - glm::dvec3(9, 8, 12)) / glm::dvec3(9.3, 8.4, 12.7)) < 1 &&
                           std::abs(p.x - p.z * 0.5 - 2.2) > 1.7);
    }
};

inline FunctionSource::Channel wavyA(bool masked) {
    const auto value = [present = WavyPresence{masked}](glm::dvec3 p) -> std::optional<double> {
        if (!present(p)) return std::nullopt;
        return 300 + 40 * std::sin(0.45 * p.x + 0.2) * std::cos(0.5 * p.y) + 35 * std::sin(0.4 * p.z + 0.1 * p.x);
    };
    return {"a", value, {225, 375}};
}
inline FunctionSource::Channel wavyB(bool masked) {
    const auto value = [present = WavyPresence{masked}](glm::dvec3 p) -> std::optional<double> {
        if (!present({p.x, p.y + 1, p.z})) return std::nullopt;
        return 0.04 * (p.x + p.y) + 0.3 * std::cos(0.35 * p.z);
    };
    return {"b", value, {-0.3, 1.7}};
}

/// The same channels at a later time: others in narrower ranges, absent elsewhere.
inline FunctionSource::Channel laterA(bool masked) {
    const auto value = [masked](glm::dvec3 p) -> std::optional<double> {
        if (masked && glm::length((p - glm::dvec3(10, 9, 11)) / glm::dvec3(9, 8, 12)) > 1) return std::nullopt;
        return 310 + 20 * std::cos(0.35 * p.x - 0.3 * p.z) + 2 * p.y;
    };
    return {"a", value, {225, 375}};
}
inline FunctionSource::Channel laterB() {
    const auto value = [](glm::dvec3 p) -> std::optional<double> {
        return 0.8 - 0.02 * p.x + 0.3 * std::sin(0.3 * p.z);
    };
    return {"b", value, {-0.3, 1.7}};
}

/// Two data sets at three times: the first, the second, and the first again.
class ThreeTimes : public volume::BrickSource {
public:
    ThreeTimes(std::shared_ptr<FunctionSource> first, std::shared_ptr<FunctionSource> second)
        : first_(std::move(first)), second_(std::move(second)), info_(first_->info()) {
        info_.times = {1, 3, 4};
    }
    const volume::DatasetInfo& info() const override { return info_; }
    const volume::BrickGrid& grid() const override { return first_->grid(); }
    volume::BrickStats stats(const volume::BrickKey& key) const override { return frame(key).stats(key); }
    volume::BrickSamples read(const volume::BrickKey& key) const override {
        ++reads;
        return frame(key).read(key);
    }
    mutable std::atomic<int> reads = 0;

private:
    const FunctionSource& frame(const volume::BrickKey& key) const { return key.time == 1 ? *second_ : *first_; }
    std::shared_ptr<FunctionSource> first_, second_;
    volume::DatasetInfo info_;
};

/// Nothing, looked at so that neither rays nor pixels fall on lattice planes.
inline Scene bareScene(bool perspective) {
    Scene scene;
    scene.camera.projection = perspective ? Projection::Perspective : Projection::Orthographic;
    scene.camera.distance = perspective ? 1.7f : 2.1f;
    scene.camera.target = {0.04f, -0.03f, 0.02f};
    scene.showBox = false;
    scene.render.samples = 1;
    return scene;
}

/// The same with functions for the two channels.
inline Scene wavyScene(bool perspective) {
    Scene scene = bareScene(perspective);
    scene.transfer["a"].opacity = {{0, 0}, {0.3f, 0}, {1, 0.06f}};
    scene.transfer["b"].colormap = "inferno";
    scene.transfer["b"].opacity = {{0, 0.3f}, {1, 1}};
    return scene;
}

} // namespace tessera::vis
