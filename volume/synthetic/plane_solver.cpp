#include "volume/synthetic/plane_solver.h"

#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>

namespace tessera::volume {

StencilSystem::StencilSystem(int cellsX, int cellsY, int cellsZ) : nx(cellsX), ny(cellsY), nz(cellsZ) {
    for (auto* part : {&diag, &rhs, &west, &east, &south, &north, &down, &up}) part->assign(count(), 0.0);
}

void StencilSystem::clear() {
    for (auto* part : {&diag, &rhs, &west, &east, &south, &north, &down, &up})
        std::fill(part->begin(), part->end(), 0.0);
}

namespace {

bool samePlane(const StencilSystem& s, std::size_t a, std::size_t b) {
    const std::size_t n = s.plane();
    for (const auto* part : {&s.diag, &s.west, &s.east, &s.south, &s.north})
        if (!std::equal(part->begin() + long(a * n), part->begin() + long((a + 1) * n), part->begin() + long(b * n)))
            return false;
    return true;
}

// Factorises a banded matrix in place; columns of 2 width + 1 entries with the diagonal in the middle.
void factorBand(std::vector<float>& columns, int n, int band, int width) {
    const std::size_t stride = std::size_t(2 * width + 1);
    for (int k = 0; k < n; ++k) {
        float* pivot = columns.data() + std::size_t(k) * stride + width;
        const int below = std::min(band, n - 1 - k);
        const float inverse = 1.0f / pivot[0];
        pivot[0] = inverse;
        for (int i = 1; i <= below; ++i) pivot[i] *= inverse;
        for (int j = 1; j <= below; ++j) {
            float* column = columns.data() + std::size_t(k + j) * stride + width - j;
            const float factor = column[0];
            if (factor == 0.0f) continue;
            for (int i = 1; i <= below; ++i) column[i] -= factor * pivot[i];
        }
    }
}

constexpr int kBlock = 4; // columns that are eliminated together

// Subtracts multiples of the columns of a block, which begin at `columns`, from `count` (a multiple of kBlock) numbers,
// for each of them in the order given.
void subtract(float* __restrict from, const float* __restrict columns, std::ptrdiff_t stride, int first, int step,
              const float (&factors)[kBlock], int count) {
    for (int i = 0; i < count; i += kBlock)
        for (int c = 0; c < kBlock; ++c) {
            const float* column = columns + (first + step * c) * stride + i;
            for (int lane = 0; lane < kBlock; ++lane) from[i + lane] -= factors[first + step * c] * column[lane];
        }
}

double dot(std::span<const double> a, std::span<const double> b) {
    // Four partial sums in fixed order: faster than one, and the same result on any machine.
    double sum[4] = {0, 0, 0, 0};
    const std::size_t n = a.size();
    std::size_t i = 0;
    for (; i + 4 <= n; i += 4)
        for (std::size_t k = 0; k < 4; ++k) sum[k] += a[i + k] * b[i + k];
    for (; i < n; ++i) sum[0] += a[i] * b[i];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/// The rows [begin, end) of the product, near the ends of the system.
void multiplyEnds(const StencilSystem& s, std::span<const double> x, std::span<double> out, std::size_t begin,
                  std::size_t end) {
    const std::size_t row = std::size_t(s.nx), plane = s.plane(), count = s.count();
    for (std::size_t p = begin; p < end; ++p) {
        double value = s.diag[p] * x[p];
        if (p >= 1) value -= s.west[p] * x[p - 1];
        if (p + 1 < count) value -= s.east[p] * x[p + 1];
        if (p >= row) value -= s.south[p] * x[p - row];
        if (p + row < count) value -= s.north[p] * x[p + row];
        if (p >= plane) value -= s.down[p] * x[p - plane];
        if (p + plane < count) value -= s.up[p] * x[p + plane];
        out[p] = value;
    }
}

/// The same where every row has all its neighbours: without conditions, so that the compiler vectorises it.
void multiplyInside(const StencilSystem& s, const double* x, double* out, std::size_t begin, std::size_t end) {
    const std::size_t row = std::size_t(s.nx), plane = s.plane();
    const double *diag = s.diag.data(), *west = s.west.data(), *east = s.east.data(), *south = s.south.data(),
                 *north = s.north.data(), *down = s.down.data(), *up = s.up.data();
    for (std::size_t p = begin; p < end; ++p) {
        double value = diag[p] * x[p];
        value -= west[p] * x[p - 1];
        value -= east[p] * x[p + 1];
        value -= south[p] * x[p - row];
        value -= north[p] * x[p + row];
        value -= down[p] * x[p - plane];
        value -= up[p] * x[p + plane];
        out[p] = value;
    }
}

void multiply(const StencilSystem& s, std::span<const double> x, std::span<double> out) {
    const std::size_t plane = s.plane(), count = s.count();
    const auto planes = [&](std::size_t zBegin, std::size_t zEnd) {
        const std::size_t begin = zBegin * plane, end = zEnd * plane;
        const std::size_t first = std::clamp(plane, begin, end),
                          last = std::clamp(count - std::min(plane, count), first, end);
        multiplyEnds(s, x, out, begin, first);
        multiplyInside(s, x.data(), out.data(), first, last);
        multiplyEnds(s, x, out, last, end);
    };
    // Handing out less costs more than it takes, and several systems are solved at a time anyway.
    constexpr std::size_t kWorthSharing = 100'000;
    if (count < kWorthSharing)
        planes(0, std::size_t(s.nz));
    else
        parallelRanges(std::size_t(s.nz), planes, 32);
}

} // namespace

PlanePreconditioner::PlanePreconditioner(const StencilSystem& s) {
    band_ = std::min(s.nx, s.ny);
    width_ = (band_ + kBlock - 1) / kBlock * kBlock + kBlock;
    transposed_ = s.ny < s.nx;
    const std::size_t nz = std::size_t(s.nz), plane = s.plane(), stride = std::size_t(2 * width_ + 1);
    const std::size_t columnCount = (plane + kBlock - 1) / kBlock * kBlock;

    std::vector<std::size_t> planes; // the planes with a factor of their own
    factorOf_.resize(nz);
    for (std::size_t z = 0; z < nz; ++z) {
        if (planes.empty() || !samePlane(s, planes.back(), z)) planes.push_back(z);
        factorOf_[z] = planes.size() - 1;
    }
    factors_.resize(planes.size());
    parallelFor(planes.size(), [&](std::size_t f) {
        std::vector<float>& columns = factors_[f];
        columns.assign(columnCount * stride, 0.0f);
        for (std::size_t c = plane; c < columnCount; ++c) columns[c * stride + std::size_t(width_)] = 1.0f;
        const std::size_t base = planes[f] * plane;
        const auto at = [&](std::size_t row, std::size_t column) -> float& {
            return columns[column * stride + std::size_t(width_) + row - column];
        };
        for (int y = 0; y < s.ny; ++y)
            for (int x = 0; x < s.nx; ++x) {
                const std::size_t p = base + std::size_t(x + s.nx * y);
                const std::size_t row = std::size_t(transposed_ ? y + s.ny * x : x + s.nx * y);
                const std::size_t stepX = std::size_t(transposed_ ? s.ny : 1),
                                  stepY = std::size_t(transposed_ ? 1 : s.nx);
                // Scale rows by their diagonal, so that single precision suffices in any unit.
                const double scale = 1 / s.diag[p];
                at(row, row) = 1.0f;
                if (x > 0) at(row, row - stepX) = float(-s.west[p] * scale);
                if (x + 1 < s.nx) at(row, row + stepX) = float(-s.east[p] * scale);
                if (y > 0) at(row, row - stepY) = float(-s.south[p] * scale);
                if (y + 1 < s.ny) at(row, row + stepY) = float(-s.north[p] * scale);
            }
        factorBand(columns, int(plane), band_, width_);
    });

    // Plane sums: one unknown per plane.
    lower_.assign(nz, 0.0), center_.assign(nz, 0.0), upper_.assign(nz, 0.0);
    for (std::size_t z = 0; z < nz; ++z) {
        for (std::size_t p = z * plane; p < (z + 1) * plane; ++p) {
            if (s.west[p] + s.east[p] + s.south[p] + s.north[p] + s.down[p] + s.up[p] == 0) continue;
            center_[z] += s.diag[p] - s.west[p] - s.east[p] - s.south[p] - s.north[p];
            lower_[z] += s.down[p];
            upper_[z] += s.up[p];
        }
        if (z > 0) center_[z] -= lower_[z] * upper_[z - 1] / center_[z - 1];
    }
}

void PlanePreconditioner::solvePlane(int z, float* values) const {
    const std::vector<float>& columns = factors_[factorOf_[std::size_t(z)]];
    const std::ptrdiff_t stride = 2 * width_ + 1, n = std::ptrdiff_t(columns.size()) / stride;
    const int reach = width_ - kBlock; // the band, and zeros
    const float* diagonal = columns.data() + width_;
    float v[kBlock];
    for (std::ptrdiff_t k = 0; k < n; k += kBlock, diagonal += kBlock * stride) {
        std::copy_n(values + k, kBlock, v);
        for (int c = 0; c < kBlock; ++c)
            for (int row = c + 1; row < kBlock; ++row) v[row] -= v[c] * diagonal[c * stride + row - c];
        std::copy_n(v, kBlock, values + k);
        subtract(values + k + kBlock, diagonal + kBlock, stride - 1, 0, 1, v, reach);
    }
    for (std::ptrdiff_t k = n - kBlock; k >= 0; k -= kBlock) {
        diagonal -= kBlock * stride;
        std::copy_n(values + k, kBlock, v);
        for (int c = kBlock - 1; c >= 0; --c) {
            v[c] *= diagonal[c * stride];
            for (int row = 0; row < c; ++row) v[row] -= v[c] * diagonal[c * stride + row - c];
        }
        std::copy_n(v, kBlock, values + k);
        subtract(values + k - reach, diagonal - reach, stride - 1, kBlock - 1, -1, v, reach);
    }
}

void PlanePreconditioner::apply(const StencilSystem& s, std::span<const double> residual,
                                std::span<double> result) const {
    const std::size_t nz = std::size_t(s.nz), plane = s.plane();
    std::vector<double> coarse(nz, 0.0);
    for (std::size_t z = 0; z < nz; ++z) {
        for (std::size_t p = z * plane; p < (z + 1) * plane; ++p) coarse[z] += residual[p];
        if (z > 0) coarse[z] += lower_[z] / center_[z - 1] * coarse[z - 1];
    }
    for (std::size_t z = nz; z-- > 0;)
        coarse[z] = (coarse[z] + (z + 1 < nz ? upper_[z] * coarse[z + 1] : 0.0)) / center_[z];
    for (std::size_t z = 0; z < nz; ++z) std::fill_n(result.begin() + long(z * plane), plane, coarse[z]);

    const std::size_t nx = std::size_t(s.nx), ny = std::size_t(s.ny);
    const std::size_t stepX = transposed_ ? ny : 1, stepY = transposed_ ? 1 : nx;
    std::vector<float> padded(plane + 3 * std::size_t(width_));
    float* const values = padded.data() + width_;
    const auto relax = [&](std::size_t z) {
        std::size_t p = z * plane;
        for (std::size_t y = 0; y < ny; ++y)
            for (std::size_t x = 0; x < nx; ++x, ++p) {
                double value = residual[p];
                if (z > 0) value += s.down[p] * result[p - plane];
                if (z + 1 < nz) value += s.up[p] * result[p + plane];
                values[x * stepX + y * stepY] = float(value / s.diag[p]);
            }
        solvePlane(int(z), values);
        p = z * plane;
        for (std::size_t y = 0; y < ny; ++y)
            for (std::size_t x = 0; x < nx; ++x, ++p) result[p] = double(values[x * stepX + y * stepY]);
    };
    for (std::size_t z = 0; z < nz; ++z) relax(z);
    for (std::size_t z = nz; z-- > 0;) relax(z);
}

int solve(const StencilSystem& s, const PlanePreconditioner& m, std::span<double> x, double tolerance,
          int maxIterations) {
    const std::size_t n = s.count();
    std::vector<double> r(n), first(n), p(n, 0.0), v(n, 0.0), t(n), hat(n);
    multiply(s, x, r);
    for (std::size_t i = 0; i < n; ++i) r[i] = s.rhs[i] - r[i];
    const double goal = tolerance * std::sqrt(dot(s.rhs, s.rhs));
    if (std::sqrt(dot(r, r)) <= goal) return 0;
    first = r;
    double rho = 1, alpha = 1, omega = 1;
    for (int iteration = 1; iteration <= maxIterations; ++iteration) {
        const double next = dot(first, r);
        if (next == 0 || omega == 0) break;
        const double beta = next / rho * (alpha / omega);
        rho = next;
        for (std::size_t i = 0; i < n; ++i) p[i] = r[i] + beta * (p[i] - omega * v[i]);
        m.apply(s, p, hat);
        multiply(s, hat, v);
        alpha = rho / dot(first, v);
        for (std::size_t i = 0; i < n; ++i) {
            x[i] += alpha * hat[i];
            r[i] -= alpha * v[i];
        }
        if (std::sqrt(dot(r, r)) <= goal) return iteration;
        m.apply(s, r, hat);
        multiply(s, hat, t);
        omega = dot(t, r) / dot(t, t);
        for (std::size_t i = 0; i < n; ++i) {
            x[i] += omega * hat[i];
            r[i] -= omega * t[i];
        }
        if (std::sqrt(dot(r, r)) <= goal) return iteration;
    }
    return -1;
}

} // namespace tessera::volume
