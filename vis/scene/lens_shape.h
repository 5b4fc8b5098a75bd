#pragma once

#include "volume/base/numbers.h"

#include <functional>
#include <glm/vec3.hpp>
#include <string_view>

/// Properties of the lens shapes. Positions are in lens coordinates (PlacedLens::toUnit).
namespace tessera::vis {

/// A disc faces the viewer and extends along the view through everything that it covers in the picture. A selection is
/// no shape in space: its inside is what the brushes select, wherever it lies (PlacedLens::weight).
enum class LensShape { Sphere, Box, Cylinder, Disc, Selection };
inline constexpr std::string_view kLensShapeNames[] = {"sphere", "box", "cylinder", "disc", "selection"};

/// Normalised radius: 0 at the centre, 1 on the outline; twin: lensRadius in vis/shaders/lib/sampling/lens.glsl.
template <class N> N lensRadius(LensShape shape, const glm::vec<3, N>& place) {
    const N across = squareRoot(place.x * place.x + place.y * place.y);
    switch (shape) {
    case LensShape::Sphere:
        return lengthOf(place);
    case LensShape::Box:
        return larger(larger(magnitude(place.x), magnitude(place.y)), magnitude(place.z));
    case LensShape::Cylinder:
        return larger(across, magnitude(place.z));
    case LensShape::Disc:
        return across / larger(N(1) + place.z, N(1e-6));
    case LensShape::Selection:
        return N(2); // nowhere inside
    }
    return N(0);
}

/// Draws the outline as lines between positions; `strength` is below 1 for auxiliary lines. `eye`: viewpoint, or
/// without perspective the direction towards the viewer.
void lensOutline(LensShape shape, glm::dvec3 eye, bool perspective,
                 const std::function<void(glm::dvec3 from, glm::dvec3 to, float strength)>& line);

} // namespace tessera::vis
