#pragma once

#include "volume/reconstruct/reconstruct.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace tessera::volume {

/// First and second derivative along the gradient, in value units per cell (of the CC grid, or of the one that a BCC
/// lattice replaces) and per cell squared.
struct Derivatives {
    double value = 0, first = 0, second = 0;
};

/// Derivatives at a lattice sample from its neighbours: on CC the 18 nearest, central differences; on BCC its own 8 and
/// 6, the first derivatives weighted 2/3 and 1/3 so that their error is the same in all directions. `samples` as in
/// volume/reconstruct/reconstruct.h, `at` a storage index. False when one of them is absent.
template <class Samples> bool derivativesAt(LatticeKind kind, const Samples& samples, glm::ivec3 at, Derivatives& out) {
    bool all = true;
    const auto value = [&](glm::ivec3 offset) {
        const Sample sample = samples(at + offset);
        all = all && sample.present;
        return sample.value;
    };
    const double centre = value({0, 0, 0});
    glm::dvec3 gradient(0);
    glm::dmat3 hessian(0);
    if (kind == LatticeKind::CC) {
        for (int a = 0; a < 3; ++a) {
            glm::ivec3 step(0);
            step[a] = 1;
            const double next = value(step), former = value(-step);
            gradient[a] = 0.5 * (next - former);
            hessian[a][a] = next + former - 2 * centre;
            const int b = (a + 1) % 3;
            glm::ivec3 side(0);
            side[b] = 1;
            hessian[a][b] = hessian[b][a] =
                0.25 * (value(step + side) - value(step - side) - value(side - step) + value(-step - side));
        }
    } else {
        // In half cells of a sublattice, the six at distance 2 and the eight at (+-1, +-1, +-1).
        for (int a = 0; a < 3; ++a) {
            glm::ivec3 step(0);
            step[a] = a == 2 ? 2 : 1; // slices alternate
            const double next = value(step), former = value(-step);
            gradient[a] = (next - former) / 12;
            hessian[a][a] = 0.25 * (next + former - 2 * centre);
        }
        const int low = (at.z & 1) != 0 ? 0 : -1; // x and y index of the other sublattice half a cell below
        for (int corner = 0; corner < 8; ++corner) {
            const glm::ivec3 up(corner & 1, corner >> 1 & 1, corner >> 2);
            const glm::dvec3 sign = 2.0 * glm::dvec3(up) - 1.0;
            const double there = value({low + up.x, low + up.y, up.z == 1 ? 1 : -1});
            gradient += there / 12.0 * sign;
            for (int a = 0; a < 3; ++a) {
                const int b = (a + 1) % 3;
                hessian[a][b] += 0.125 * sign[a] * sign[b] * there;
                hessian[b][a] = hessian[a][b];
            }
        }
        gradient *= kBccSpacing; // a cell of the replaced grid is sqrt 2 half cells long
        hessian *= kBccSpacing * kBccSpacing;
    }
    if (!all) return false;
    const double squared = glm::dot(gradient, gradient);
    out = {centre, std::sqrt(squared), squared > 0 ? glm::dot(gradient, hessian * gradient) / squared : 0};
    return true;
}

} // namespace tessera::volume
