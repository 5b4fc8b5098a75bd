#include "vis/optics/preintegration.h"

#include "vis/optics/ray_setup.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace tessera::vis {

namespace {

constexpr double kMostOpaque = 1 - 1e-12; ///< opacity 1 would mean infinite extinction
constexpr double kSame = 1e-7;            ///< closer positions are treated as equal

/// As preintegrated() wants them.
struct Nodes {
    const IntegralFunctions& functions;
    double last() const { return functions.last(); }
    const glm::dvec4& density(double node) const { return functions.density[std::size_t(node)]; }
    using Sum = glm::dvec4;
    const Sum& sum(double node) const { return functions.integral[std::size_t(node)]; }
    static glm::dvec4 apart(const Sum& a, const Sum& b) { return b - a; }
};

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

glm::dvec4 integralAt(const IntegralFunctions& functions, double x) {
    const NodePlaceOf<double> at = nodePlace(functions.last(), x);
    const auto below = std::size_t(at.below);
    return functions.integral[below] +
           integralBeyond(functions.density[below], functions.density[below + 1], at.along, functions.last());
}

glm::dvec4 preintegrated(const IntegralFunctions& functions, double front, double back) {
    const Nodes nodes{functions};
    return preintegrated(nodes, segmentEnd(nodes, front), segmentEnd(nodes, back), kSame);
}

std::vector<glm::vec4> preintegrationTable(const IntegralFunctions& functions, int size) {
    std::vector<glm::dvec4> integrals;
    std::vector<glm::vec4> table(std::size_t(size) * std::size_t(size));
    for (int i = 0; i < size; ++i) integrals.push_back(integralAt(functions, double(i) / (size - 1)));
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
