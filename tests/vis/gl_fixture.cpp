#include "tests/vis/gl_fixture.h"

#include <cmath>
#include <limits>

namespace tessera::test {

vis::Camera frontCamera(double extent) {
    vis::Camera camera;
    camera.projection = vis::Projection::Orthographic;
    camera.orientation = {1, 0, 0, 0};
    camera.fieldOfView = 30;
    camera.distance = float(extent / 2 / std::tan(15 * 3.14159265358979323846 / 180));
    return camera;
}

vis::FrameStatus renderAll(vis::Renderer& renderer, vis::ViewTarget& target, const vis::Scene& scene, glm::ivec2 size) {
    vis::FrameRequest request;
    request.size = size;
    request.wait = true;
    const vis::FrameStatus status = renderer.render(target, scene, request);
    EXPECT_TRUE(status.complete);
    return status;
}

std::vector<glm::vec4> picture(std::shared_ptr<const volume::BrickSource> source, const vis::RendererOptions& options,
                               const vis::Scene& scene, glm::ivec2 size) {
    vis::Renderer renderer(options);
    renderer.setSource(std::move(source));
    const vis::ViewTargetPtr target = renderer.makeTarget();
    renderAll(renderer, *target, scene, size);
    for (const std::string& message : renderer.takeMessages()) ADD_FAILURE() << message;
    return renderer.readLinear(*target);
}

double maxDifference(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b) {
    if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (int c = 0; c < 4; ++c) worst = std::max(worst, std::abs(double(a[i][c]) - double(b[i][c])));
    return worst;
}

} // namespace tessera::test
