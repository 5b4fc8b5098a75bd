#include "volume/synthetic/plane_solver.h"

#include <cmath>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>
#include <random>

namespace tessera::volume {
namespace {

/// Conduction between neighbours, and from every cell to a sink of 0; `along` over `across`: conductances along z and
/// in the planes. `unit` scales all of it.
StencilSystem conduction(glm::ivec3 size, double along, double across, double sink, double unit) {
    StencilSystem s(size.x, size.y, size.z);
    std::mt19937 random(4);
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const std::size_t p = s.index(x, y, z);
                const auto link = [&](std::vector<double>& next, std::vector<double>& back, std::size_t q, double k) {
                    s.diag[p] += k * unit, s.diag[q] += k * unit;
                    next[p] = k * unit, back[q] = k * unit;
                };
                s.diag[p] += sink * unit;
                s.rhs[p] = double(random() % 100) * unit;
                if (x + 1 < size.x) link(s.east, s.west, s.index(x + 1, y, z), across);
                if (y + 1 < size.y) link(s.north, s.south, s.index(x, y + 1, z), across);
                if (z + 1 < size.z) link(s.up, s.down, s.index(x, y, z + 1), along);
            }
    return s;
}

/// |rhs - A x| / |rhs|, written anew.
double residualOf(const StencilSystem& s, const std::vector<double>& x) {
    double off = 0, all = 0;
    for (int k = 0; k < s.nz; ++k)
        for (int j = 0; j < s.ny; ++j)
            for (int i = 0; i < s.nx; ++i) {
                const std::size_t p = s.index(i, j, k);
                double left = s.rhs[p] - s.diag[p] * x[p];
                if (i > 0) left += s.west[p] * x[s.index(i - 1, j, k)];
                if (i + 1 < s.nx) left += s.east[p] * x[s.index(i + 1, j, k)];
                if (j > 0) left += s.south[p] * x[s.index(i, j - 1, k)];
                if (j + 1 < s.ny) left += s.north[p] * x[s.index(i, j + 1, k)];
                if (k > 0) left += s.down[p] * x[s.index(i, j, k - 1)];
                if (k + 1 < s.nz) left += s.up[p] * x[s.index(i, j, k + 1)];
                off += left * left;
                all += s.rhs[p] * s.rhs[p];
            }
    return std::sqrt(off / all);
}

struct Solved {
    int iterations = 0;
    double residual = 0;
};
Solved solved(const StencilSystem& system, double tolerance) {
    std::vector<double> x(system.count(), 0.0);
    const int iterations = solve(system, PlanePreconditioner(system), x, tolerance);
    return {iterations, residualOf(system, x)};
}

// What is linked along z alone is solved at once by the system of one unknown per plane, which takes the slow modes of
// everything longer than wide: nearly nothing holds it, so that sweeps from plane to plane would take hundreds of
// turns.
TEST(PlaneSolver, TakesAChainAtOnce) {
    for (const double unit : {1e-15, 1.0, 1e12}) {
        const Solved chain = solved(conduction({1, 1, 400}, 1, 1, 1e-6, unit), 1e-5);
        EXPECT_LE(chain.residual, 1.1e-5) << unit;
        EXPECT_LE(chain.iterations, 2) << unit << ": the second is for the rounding to float";
    }
}

TEST(PlaneSolver, TakesALongBoxInAFewTurns) {
    for (const glm::ivec3 size : {glm::ivec3(5, 7, 90), glm::ivec3(7, 5, 90), glm::ivec3(4, 4, 1)})
        for (const double unit : {1e-15, 1.0}) {
            const Solved box = solved(conduction(size, 3, 1, 1e-5, unit), 1e-8);
            EXPECT_LE(box.residual, 1.1e-8) << size.x << " " << unit;
            EXPECT_GE(box.iterations, 1);
            EXPECT_LE(box.iterations, 20) << size.x << " " << unit;
        }
}

} // namespace
} // namespace tessera::volume
