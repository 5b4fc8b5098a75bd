#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <string_view>

/// What there is to know of each shape of lens. Places are those in the lens (PlacedLens::toUnit).
namespace tessera::vis {

/// A disc faces the viewer and reaches through everything that it covers in the picture.
enum class LensShape { Sphere, Box, Cylinder, Disc };
inline constexpr std::string_view kLensShapeNames[] = {"sphere", "box", "cylinder", "disc"};

/// 0 in the middle, 1 on the outline; twin: lensRadius in vis/shaders/lib/lens.glsl.
double lensRadius(LensShape shape, glm::dvec3 place);

/// Draws the outline as lines between places; `strength` is less than 1 where they only help to see the shape. `eye`:
/// where it is seen from; without perspective the direction towards the viewer.
void lensOutline(LensShape shape, glm::dvec3 eye, bool perspective,
                 const std::function<void(glm::dvec3 from, glm::dvec3 to, float strength)>& line);

} // namespace tessera::vis
