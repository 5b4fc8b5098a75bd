#pragma once

#include "vis/image/image_io.h"
#include "vis/scene/camera.h"

#include <glm/vec2.hpp>
#include <optional>

/// The camera with which what is seen of a scene fills its picture.
namespace tessera::app {

/// What is seen in a picture of a scene alone, as a part of it: -1..1 from side to side, y up.
struct SeenExtent {
    glm::dvec2 lo{0}, hi{0};
};

/// Of the pixels that differ from the ground, which is that in the corners; nothing where none do.
std::optional<SeenExtent> seenExtent(const vis::Image& scene);

/// Moves a camera so that what is seen lies in the middle and fills the picture but for a margin. Exact in parallel
/// projection, else the better the flatter the object is: repeat it with a picture from the new camera.
void fitToSeen(vis::Camera& camera, const SeenExtent& seen, double aspect);

} // namespace tessera::app
