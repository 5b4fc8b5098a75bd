#include "app/command/bench_frames.h"

#include <algorithm>
#include <ctime>

namespace tessera::app {

double cpuMilliseconds() {
    return 1000 * double(std::clock()) / CLOCKS_PER_SEC;
}

vis::Scene benchScene(const vis::Technique& technique, const std::vector<glm::vec2>& opacity) {
    vis::Scene scene;
    scene.layers = {{.name = "v", .visible = true, .technique = technique}};
    scene.transfer["v"].opacity = opacity;
    scene.render.stepVoxels = 1;
    scene.render.samples = 1;
    scene.camera.distance = 2.6f;
    scene.showBox = false;
    return scene;
}

double timeFrames(vis::Renderer& renderer, vis::Scene scene) {
    const vis::ViewTargetPtr target = renderer.makeTarget();
    vis::FrameRequest request;
    request.size = {kBenchPicture, kBenchPicture};
    request.wait = true;
    std::vector<double> times;
    for (int frame = 0; frame <= kBenchFrames; ++frame) {
        const double begin = cpuMilliseconds();
        renderer.render(*target, scene, request);
        glm::ivec2 size;
        renderer.readPixels(*target, size);
        times.push_back(cpuMilliseconds() - begin);
        vis::orbit(scene.camera, {0, 0}, {0.00175f, 0});
    }
    times.erase(times.begin());
    std::ranges::sort(times);
    return times[times.size() / 2];
}

vis::reference::Image benchPicture(vis::Renderer& renderer, const vis::Scene& scene) {
    const vis::ViewTargetPtr target = renderer.makeTarget();
    vis::FrameRequest request;
    request.size = {kBenchCompared, kBenchCompared};
    request.wait = true;
    renderer.render(*target, scene, request);
    vis::reference::Image image;
    image.size = request.size;
    for (const glm::vec4& pixel : renderer.readLinear(*target)) image.pixels.emplace_back(pixel);
    return image;
}

} // namespace tessera::app
