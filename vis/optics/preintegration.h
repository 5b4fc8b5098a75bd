#pragma once

#include "vis/transfer/transfer_function.h"

#include <glm/vec4.hpp>
#include <vector>

/// Pre-integrated classification: colour and opacity of a ray segment along which the value changes linearly between
/// two positions of the transfer function.
///
/// K. Engel, M. Kraus, T. Ertl: High-quality pre-integrated volume rendering using hardware-accelerated pixel shading,
/// 2001, with the approximation of their section 3.3 (no attenuation within a segment), which allows integral
/// functions. We store means per unit of length instead of integrals per segment: mean extinction as the opacity of a
/// layer kReferenceLength thick, and mean emission as its colour. correctedOpacity() then accounts for the segment
/// length as for any other opacity, so one table serves all step lengths.
namespace tessera::vis {

/// Integrals over the position x in 0..1 of extinction t = -log(1 - opacity) and of t * colour (linear light), both
/// assumed linear between the nodes x = i / (size - 1).
struct IntegralFunctions {
    std::vector<glm::dvec4> density;  ///< t * colour, t at the nodes
    std::vector<glm::dvec4> integral; ///< integral of density from 0 to the node
};

inline constexpr int kIntegralNodes = 4096;
/// From a function's opacity curve and colours over a range; O(nodes).
IntegralFunctions integralFunctions(const TransferFunction& function, Range range, int nodes = kIntegralNodes);

/// Colour (linear light, not premultiplied: mean weighted by extinction) and opacity of the segment between two
/// positions, clamped to 0..1; symmetric in both. For equal positions, the values of that position.
glm::dvec4 preintegrated(const IntegralFunctions& functions, double front, double back);

/// Colour and opacity of a segment whose two halves have their own, where the value jumps between two parts. Twin:
/// lib/classify.glsl.
glm::dvec4 inHalves(glm::dvec4 front, glm::dvec4 back);

/// preintegrated() for front = x / (size - 1), back = y / (size - 1), x fastest, with premultiplied colours so that
/// entries can be interpolated; O(size^2).
std::vector<glm::vec4> preintegrationTable(const IntegralFunctions& functions, int size);

} // namespace tessera::vis
