#include "bench/pictures/bench_frames.h"

#include "vis/gl/driver.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <thread>

namespace tessera::app {

BenchClock benchClock() {
    return vis::currentDriver().software ? BenchClock::Processor : BenchClock::Wall;
}

const char* timeColumn(BenchClock clock) {
    return clock == BenchClock::Wall ? "ms" : "CPU ms";
}

double milliseconds(BenchClock clock) {
    if (clock == BenchClock::Processor) return 1000 * double(std::clock()) / CLOCKS_PER_SEC;
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double, std::milli>(now).count();
}

vis::Scene benchScene(const vis::Technique& technique, const std::vector<glm::vec2>& opacity) {
    vis::Scene scene;
    scene.layers = {{.name = "v", .visible = true, .technique = technique}};
    scene.transfer["v"].opacity = opacity;
    scene.render.stepVoxels = 1;
    scene.render.samples = 1;
    scene.render.detail = 0; // all samples, as the peers and the reference have them
    scene.camera.distance = 2.6f;
    scene.showBox = false;
    return scene;
}

namespace {

constexpr double kGpuWarmUp = 400; // ms until a GPU that was idle, while a program was compiled, has its full clock

/// Draws the scene whole and takes the pixels.
void draw(vis::Renderer& renderer, vis::ViewTarget& target, const vis::Scene& scene) {
    vis::FrameRequest request;
    request.size = {kBenchPicture, kBenchPicture};
    request.wait = true;
    renderer.render(target, scene, request);
    glm::ivec2 size;
    renderer.readPixels(target, size);
}

} // namespace

double timeFrames(vis::Renderer& renderer, vis::Scene scene) {
    const vis::ViewTargetPtr target = renderer.makeTarget();
    draw(renderer, *target, scene);
    const BenchClock clock = benchClock();
    const auto next = [&] {
        vis::orbit(scene.camera, {0, 0}, {0.00175f, 0});
        const double begin = milliseconds(clock);
        draw(renderer, *target, scene);
        return milliseconds(clock) - begin;
    };
    if (clock == BenchClock::Wall)
        for (double left = kGpuWarmUp; left > 0;) left -= next();
    std::vector<double> times;
    for (int frame = 0; frame < kBenchFrames; ++frame) times.push_back(next());
    std::ranges::sort(times);
    return times[times.size() / 2];
}

double timeChanged(vis::Renderer& renderer, const vis::Scene& scene,
                   std::shared_ptr<const volume::BrickSource> source) {
    const vis::ViewTargetPtr target = renderer.makeTarget();
    draw(renderer, *target, scene);
    const BenchClock clock = benchClock();
    const double begin = milliseconds(clock);
    renderer.setSource(std::move(source));
    for (vis::FrameStatus status; !status.current || status.samples == 0;) {
        status = renderer.render(*target, scene, {.size = {kBenchPicture, kBenchPicture}});
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    glm::ivec2 size;
    renderer.readPixels(*target, size);
    return milliseconds(clock) - begin;
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

double samplesPerPixel(vis::Renderer& counter, const vis::Scene& scene) {
    const vis::reference::Image counts = benchPicture(counter, scene);
    double sum = 0;
    for (const glm::dvec4& pixel : counts.pixels) sum += pixel.r;
    return sum / double(counts.pixels.size());
}

} // namespace tessera::app
