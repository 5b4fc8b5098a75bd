#include "vis/scene/stereo.h"

#include <glm/vec2.hpp>

namespace tessera::vis {

Camera eyeCamera(Camera camera, const Stereo& stereo, Eye eye) {
    if (!stereo.on()) return camera;
    camera.aperture = 0;
    camera.lens = glm::vec2(stereo.aside(eye) * double(camera.distance), 0);
    camera.focus = camera.target + glm::vec3(forwardOf(camera)) * (camera.distance * (stereo.convergence - 1));
    return camera;
}

} // namespace tessera::vis
