#pragma once

#include "vis/transfer/transfer_function.h"

#include <glm/vec4.hpp>
#include <vector>

/// Pre-integrated classification: colour and opacity of a ray segment along which the value runs linearly from one
/// place of the transfer function to another.
///
/// K. Engel, M. Kraus, T. Ertl: High-quality pre-integrated volume rendering using hardware-accelerated pixel shading,
/// 2001, with the approximation of their section 3.3 (no attenuation within a segment), so that integral functions
/// serve. We keep means per unit of length and not per segment: mean extinction as the opacity of a layer
/// kReferenceLength thick and mean emission as the colour of it. A sample's own length then enters by
/// correctedOpacity() as for any other opacity, so a table holds for every step length.
namespace tessera::vis {

/// Integrals over the place x in 0..1 of extinction t = -log(1 - opacity) and of t * colour (linear light), which are
/// taken to be linear between the nodes x = i / (size - 1).
struct IntegralFunctions {
    std::vector<glm::dvec4> density;  ///< t * colour, t at the nodes
    std::vector<glm::dvec4> integral; ///< of density from 0 to the node
};

inline constexpr int kIntegralNodes = 4096;
/// From the curve and colours of a function over a range; in O(nodes).
IntegralFunctions integralFunctions(const TransferFunction& function, Range range, int nodes = kIntegralNodes);

/// Colour (linear light, not premultiplied: mean weighted by extinction) and opacity of the segment between two places,
/// clamped to 0..1; the order of the two does not matter. Where they are equal, of that place.
glm::dvec4 preintegrated(const IntegralFunctions& functions, double front, double back);

/// Colour and opacity of a segment whose halves have two of their own: where the value jumps in between. Twin:
/// lib/classify.glsl.
glm::dvec4 inHalves(glm::dvec4 front, glm::dvec4 back);

/// preintegrated() for front = x / (size - 1), back = y / (size - 1), x fastest, colour premultiplied so that entries
/// can be interpolated; in O(size^2).
std::vector<glm::vec4> preintegrationTable(const IntegralFunctions& functions, int size);

} // namespace tessera::vis
