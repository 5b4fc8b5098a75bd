#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <vector>

/// Opacity curves of a translucent body, for fields without material boundaries: every value is seen, and none hides
/// what lies behind it.
namespace tessera::vis {

/// What matters more than other values: high ones, or those far from the middle of the range (0 of signed values).
enum class Emphasis { High, Magnitude };

/// The curve by which a body shows its values. `count`: the volume that each value has; bin b covers
/// [b, b + 1] / count.size() of the range, like the positions of the curve. `length`: mean length of the rays through
/// the body, in world units. Optical depth is divided among the values: each gets a small one for every part of the
/// volume, so that the body is seen as a whole, and parts of the range that hold values get equal ones (but for the
/// emphasis) whatever their volume, so that what is rare is opaque and what is common is clear. Values that do not
/// occur lie between those that do. Without values, a straight line from 0 to 0.8.
std::vector<glm::vec2> bodyOpacity(std::span<const double> count, double length, Emphasis emphasis);

} // namespace tessera::vis
