#include "vis/optics/preintegration.h"

#include "vis/optics/ray_setup.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace tessera::vis {

namespace {

constexpr double kMostOpaque = 1 - 1e-12; ///< opacity 1 would mean infinite extinction
constexpr double kSame =
    1e-7; ///< closer positions are treated as equal, since their difference has no significant digits

/// A position between two nodes.
struct NodePlace {
    std::size_t below;
    double along;
};
NodePlace nodePlace(const IntegralFunctions& functions, double x) {
    const auto last = double(functions.density.size() - 1);
    const double at = std::clamp(x, 0.0, 1.0) * last;
    const double below = std::min(std::floor(at), last - 1);
    return {std::size_t(below), at - below};
}

/// Integral from 0 to a position.
glm::dvec4 integralAt(const IntegralFunctions& functions, NodePlace at) {
    const glm::dvec4 a = functions.density[at.below], b = functions.density[at.below + 1];
    const double node = 1 / double(functions.density.size() - 1);
    return functions.integral[at.below] + node * at.along * (a + 0.5 * at.along * (b - a));
}

/// Colour and opacity from the means of t * colour and t.
glm::dvec4 fromDensity(glm::dvec4 mean) {
    // Rounding dominates if there is next to no extinction.
    if (!(mean.a > 1e-11)) return glm::dvec4(0);
    return {glm::clamp(glm::dvec3(mean) / mean.a, 0.0, 1.0), -std::expm1(-mean.a)};
}

} // namespace

IntegralFunctions integralFunctions(const TransferFunction& function, Range range, int nodes) {
    IntegralFunctions out;
    out.density.reserve(std::size_t(nodes));
    out.integral.reserve(std::size_t(nodes));
    for (int i = 0; i < nodes; ++i) {
        const glm::dvec4 srgb = evaluate(function, range, glm::mix(range.lo, range.hi, double(i) / (nodes - 1)));
        const double t = -std::log1p(-std::min(srgb.a, kMostOpaque));
        out.density.emplace_back(linearFromSrgb(glm::dvec3(srgb)) * t, t);
    }
    glm::dvec4 sum(0);
    for (std::size_t i = 0; i < out.density.size(); ++i) {
        if (i > 0) sum += 0.5 * (out.density[i - 1] + out.density[i]) / double(nodes - 1);
        out.integral.push_back(sum);
    }
    return out;
}

glm::dvec4 preintegrated(const IntegralFunctions& functions, double front, double back) {
    const double a = std::clamp(std::min(front, back), 0.0, 1.0), b = std::clamp(std::max(front, back), 0.0, 1.0);
    const NodePlace lo = nodePlace(functions, a), hi = nodePlace(functions, b);
    if (b - a < kSame) {
        const glm::dvec4 here = glm::mix(functions.density[lo.below], functions.density[lo.below + 1], lo.along);
        return fromDensity(here);
    }
    return fromDensity((integralAt(functions, hi) - integralAt(functions, lo)) / (b - a));
}

glm::dvec4 inHalves(glm::dvec4 front, glm::dvec4 back) {
    const glm::dvec3 sum = glm::dvec3(front) * front.a + glm::dvec3(back) * back.a;
    return {sum / std::max(front.a + back.a, 1e-12), 1 - std::sqrt((1 - front.a) * (1 - back.a))};
}

std::vector<glm::vec4> preintegrationTable(const IntegralFunctions& functions, int size) {
    std::vector<glm::dvec4> integrals;
    std::vector<glm::vec4> table(std::size_t(size) * std::size_t(size));
    for (int i = 0; i < size; ++i)
        integrals.push_back(integralAt(functions, nodePlace(functions, double(i) / (size - 1))));
    parallelFor(std::size_t(size), [&](std::size_t y) {
        for (std::size_t x = 0; x <= y; ++x) {
            const glm::dvec4 mean =
                x == y ? glm::dvec4(0) : (integrals[y] - integrals[x]) * (double(size - 1) / double(y - x));
            const glm::dvec4 entry =
                x == y ? preintegrated(functions, double(x) / (size - 1), double(x) / (size - 1)) : fromDensity(mean);
            table[y * std::size_t(size) + x] = table[x * std::size_t(size) + y] =
                glm::vec4(glm::vec3(entry) * float(entry.a), float(entry.a));
        }
    });
    return table;
}

} // namespace tessera::vis
