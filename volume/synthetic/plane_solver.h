#pragma once

#include <cstddef>
#include <span>
#include <vector>

/// Linear systems of finite volumes on a long box of cells.
///
/// Preconditioner: a one-dimensional system along z (every plane one unknown), then a symmetric block Gauss-Seidel
/// sweep over the planes, each plane solved by banded elimination without pivoting. For flow along z a sweep with the
/// flow is nearly exact; the one-dimensional system takes the slow modes of pressure and heat. Krylov method: BiCGSTAB
/// (van der Vorst, SIAM J. Sci. Stat. Comput. 13, 1992). All sums run in a fixed order: same bits on any thread count.
namespace tessera::volume {

/// diag[P] x[P] - sum over the six neighbours N of a[N][P] x[N] = rhs[P], x fastest, nx*ny*nz cells. The matrix must be
/// an M-matrix. A cell that is not part of the domain has diag 1 and the rest 0.
struct StencilSystem {
    int nx = 0, ny = 0, nz = 0;
    std::vector<double> diag, rhs;
    std::vector<double> west, east, south, north, down, up; ///< couplings to x-1, x+1, y-1, y+1, z-1, z+1

    StencilSystem() = default;
    StencilSystem(int cellsX, int cellsY, int cellsZ);
    std::size_t plane() const { return static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny); }
    std::size_t count() const { return plane() * static_cast<std::size_t>(nz); }
    std::size_t index(int x, int y, int z) const {
        return static_cast<std::size_t>(x) +
               static_cast<std::size_t>(nx) *
                   (static_cast<std::size_t>(y) + static_cast<std::size_t>(ny) * static_cast<std::size_t>(z));
    }
    /// All coefficients to zero.
    void clear();
};

/// Conductance between the centres of two cells half a step from their common face each.
inline double series(double a, double b) {
    return a > 0 && b > 0 ? 2 * a * b / (a + b) : 0.0;
}

/// Factors of the planes of one system. May be kept while the matrix changes a little: it is only a preconditioner.
class PlanePreconditioner {
public:
    PlanePreconditioner() = default;
    explicit PlanePreconditioner(const StencilSystem& system);
    bool empty() const { return factors_.empty(); }
    /// result = M^-1 residual, for the couplings along z of `system`.
    void apply(const StencilSystem& system, std::span<const double> residual, std::span<double> result) const;

private:
    /// `values` of a plane, with width_ zeros before and twice as many behind, which take part with weight 0.
    void solvePlane(int z, float* values) const;

    int band_ = 0, width_ = 0; // coefficients on each side of the diagonal; with zeros, for columns taken in blocks
    bool transposed_ = false;  // y is the inner index of the band
    std::vector<std::size_t> factorOf_;          // per plane: its factor (equal planes share one)
    std::vector<std::vector<float>> factors_;    // per factor: columns of 2 width + 1 entries
    std::vector<double> lower_, center_, upper_; // the system along z, eliminated
};

/// Solves the system from the given start to |residual| <= tolerance |rhs| (2-norms) and returns the iterations taken,
/// or -1 when it stopped at `maxIterations` with the best it had.
int solve(const StencilSystem& system, const PlanePreconditioner& preconditioner, std::span<double> x, double tolerance,
          int maxIterations = 200);

} // namespace tessera::volume
