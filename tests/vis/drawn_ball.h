#pragma once

#include "tests/vis/raycast_compare.h"

#include <functional>

/// A surface drawn in a look, for tests of what is known of its picture.
namespace tessera::vis {

inline constexpr glm::ivec2 kPicture{120, 120};

/// A ball of radius 0.4 world units in the middle of a cube of 41 samples a side, as its distance function.
struct Ball {
    static constexpr double kRadius = 0.4;
    HeadlessContext context;
    std::shared_ptr<FunctionSource> data;
    Renderer renderer{optionsFor(true, false)};
    Scene scene;

    /// Another function of the position in cells, 0 to 40, in its place.
    explicit Ball(const std::function<double(glm::dvec3)>& function = [](glm::dvec3 p) {
        return glm::length(p - 20.0) / 40;
    }) {
        const auto value = [=](glm::dvec3 p) -> std::optional<double> { return function(p); };
        data = std::make_shared<FunctionSource>(LatticeKind::CC, glm::ivec3(41), glm::dvec3(1),
                                                std::vector<FunctionSource::Channel>{{"d", value, {0, 0.87}}}, 16,
                                                glm::dvec3(0));
        renderer.setSource(data);
        scene.camera.projection = Projection::Orthographic;
        scene.camera.orientation = {1, 0, 0, 0};
        scene.showBox = false;
        scene.render.samples = 1;
        scene.render.stepVoxels = 0.25f;
    }
    IsoLayer& surface() {
        scene.layers = {{"", true, IsoLayer{.channel = "d", .value = kRadius, .color = glm::vec3(1)}}};
        return std::get<IsoLayer>(scene.layers[0].technique);
    }
    std::vector<glm::vec4> draw(glm::ivec2 size) {
        const ViewTargetPtr target = renderer.makeTarget();
        FrameRequest request;
        request.size = size;
        request.wait = true;
        renderer.render(*target, scene, request);
        for (const std::string& message : renderer.takeMessages()) ADD_FAILURE() << message;
        return renderer.readLinear(*target);
    }
    /// Places on the ball's front, in radii: x, y of a pixel.
    glm::dvec2 place(int x, int y, glm::ivec2 size) const {
        const glm::dvec2 ndc = (glm::dvec2(x, size.y - 1 - y) + 0.5) / glm::dvec2(size) * 2.0 - 1.0;
        return glm::dvec2(cameraRay(scene.camera, double(size.x) / size.y, ndc).origin) / kRadius;
    }
};

} // namespace tessera::vis
