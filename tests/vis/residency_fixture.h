#pragma once

#include "tests/vis/function_source.h"
#include "tests/vis/gl_fixture.h"

#include <algorithm>
#include <mutex>
#include <set>
#include <thread>
#include <tuple>

/// Waves in bricks whose reading is watched: what the tests of the brick cache share.
namespace tessera::test {

/// Remembers which bricks were read, and can hold them back.
class Watched : public volume::BrickSource {
public:
    explicit Watched(std::shared_ptr<const volume::BrickSource> source, int times = 1)
        : source_(std::move(source)), info_(source_->info()) {
        info_.times.clear();
        for (int i = 0; i < times; ++i) info_.times.push_back(i);
    }
    const volume::DatasetInfo& info() const override { return info_; }
    const volume::BrickGrid& grid() const override { return source_->grid(); }
    volume::BrickStats stats(const volume::BrickKey& key) const override { return source_->stats(key); }
    volume::BrickSamples read(const volume::BrickKey& key) const override {
        {
            const std::lock_guard lock(mutex_);
            read_.insert({key.time, key.level, key.index.x, key.index.y, key.index.z});
        }
        return source_->read(key);
    }
    void setRange(Range range) { info_.parameters[0].ranges = {range}; }
    /// Bricks read so far at a time and level.
    int count(int time, int level) const {
        const std::lock_guard lock(mutex_);
        return int(std::count_if(read_.begin(), read_.end(), [&](const auto& key) {
            return std::get<0>(key) == time && std::get<1>(key) == level;
        }));
    }

private:
    std::shared_ptr<const volume::BrickSource> source_;
    volume::DatasetInfo info_;
    mutable std::mutex mutex_;
    mutable std::set<std::tuple<int, int, int, int, int>> read_;
};

inline std::shared_ptr<Watched> waves(int times = 1, glm::ivec3 samples = {60, 52, 71}) {
    const auto v = [](glm::dvec3 p) -> std::optional<double> {
        return 0.5 + 0.4 * std::sin(0.2 * p.x) * std::cos(0.15 * p.y + 0.1 * p.z);
    };
    return std::make_shared<Watched>(
        std::make_shared<vis::FunctionSource>(volume::LatticeKind::BCC, samples, glm::dvec3(1),
                                              std::vector<vis::FunctionSource::Channel>{{"v", v}}, 8),
        times);
}

/// Half of it transparent.
inline vis::Scene volumeScene() {
    vis::Scene scene;
    scene.camera.distance = 1.8f;
    vis::VolumeLayer layer;
    layer.channel = "v";
    scene.layers.push_back({"volume", true, layer});
    vis::TransferFunction function;
    function.autoRange = false;
    function.range = {0, 1};
    function.opacity = {{0, 0}, {0.5f, 0}, {0.7f, 0.4f}, {1, 0.6f}};
    scene.transfer["v"] = function;
    scene.showBox = false;
    return scene;
}

inline vis::RendererOptions bricks() {
    vis::RendererOptions options;
    options.denseTexels = 0;
    return options;
}

/// Draws with a renderer as a window does.
class ResidencyTest : public GlTest {
protected:
    /// Draws frame after frame, as a window does, until nothing is left to do.
    static vis::FrameStatus refine(vis::Renderer& renderer, vis::ViewTarget& target, const vis::Scene& scene,
                                   glm::ivec2 size) {
        vis::FrameRequest request;
        request.size = size;
        vis::FrameStatus status;
        for (int frame = 0; frame < 20000 && !status.complete; ++frame) {
            status = renderer.render(target, scene, request);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        EXPECT_TRUE(status.complete);
        return status;
    }
};

} // namespace tessera::test
