#include "volume/resample/spline_prefilter.h"

#include "volume/base/parallel.h"

#include <array>
#include <cmath>
#include <cstdlib>

namespace tessera::volume {

namespace {

/// One pole on a signal that is odd about its first and last sample, both 0.
void filterOdd(std::span<double> c, double pole) {
    const std::size_t last = c.size() - 1;
    const double gain = (1 - pole) * (1 - 1 / pole);
    for (double& value : c) value *= gain;
    // The causal filter starts at sum over k of pole^k c(-k) with c(-k) = -c(k), until the power is negligible.
    double sum = 0, power = pole, sign = -1;
    std::size_t at = 1;
    for (int k = 1; k < 64 && std::abs(power) > 1e-17; ++k, power *= pole) {
        sum += sign * power * c[at];
        // Follow the odd periodic continuation: negative forwards, positive backwards from the last sample.
        if (sign < 0) {
            if (at == last) {
                sign = 1;
                --at;
            } else {
                ++at;
            }
        } else if (at == 0) {
            sign = -1;
            ++at;
        } else {
            --at;
        }
    }
    double before = sum;
    c[0] = before;
    for (std::size_t i = 1; i <= last; ++i) before = c[i] += pole * before;
    double after = 0; // the result is odd about the last sample
    c[last] = 0;
    for (std::size_t i = last; i-- > 1;) after = c[i] = pole * (after - c[i]);
    c[0] = 0;
}

} // namespace

void splinePrefilter(std::span<double> line, int degree) {
    const std::size_t n = line.size();
    if (n < 3) return;
    // The line between the ends is kept as it is; what remains is odd about both.
    const double first = line.front(), slope = (line.back() - first) / double(n - 1);
    for (std::size_t i = 0; i < n; ++i) line[i] -= first + slope * double(i);
    line.front() = line.back() = 0;
    if (degree == 3) {
        filterOdd(line, std::sqrt(3.0) - 2);
    } else {
        // Roots inside the unit circle of z^4 + 26 z^3 + 66 z^2 + 26 z + 1.
        const double root = std::sqrt(105.0);
        for (const double sum : {-13 - root, -13 + root}) // z + 1 / z
            filterOdd(line, (sum + std::sqrt(sum * sum - 4)) / 2);
    }
    for (std::size_t i = 0; i < n; ++i) line[i] += first + slope * double(i);
}

template <class Real> std::vector<Real> splineValues(const Field& field) {
    std::vector<Real> values(field.count());
    dispatch(field.type, [&]<class T>(T) {
        const auto stored = field.as<T>();
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = field.present(i) ? Real(stored[i]) : Real(0);
    });
    return values;
}

template <class Real>
void splineFilterAxis(glm::ivec3 size, std::span<const std::uint8_t> present, std::vector<Real>& values, int axis,
                      int degree) {
    const std::size_t steps[] = {1, std::size_t(size.x), std::size_t(size.x) * std::size_t(size.y)};
    // In parallel over planes across another axis.
    const int across = axis == 2 ? 1 : 2, along = 3 - axis - across;
    parallelFor(std::size_t(size[across]), [&](std::size_t plane) {
        std::vector<double> run;
        run.reserve(std::size_t(size[axis]));
        for (int row = 0; row < size[along]; ++row) {
            const std::size_t first = plane * steps[across] + std::size_t(row) * steps[along];
            std::uint8_t runNumber = 0;
            const auto finish = [&](std::size_t end) {
                if (run.size() > 2) {
                    splinePrefilter(run, degree);
                    for (std::size_t i = 0; i < run.size(); ++i)
                        values[first + (end - run.size() + i) * steps[axis]] = Real(run[i]);
                }
                run.clear();
            };
            for (std::size_t i = 0; i < std::size_t(size[axis]); ++i) {
                const std::size_t at = first + i * steps[axis];
                const std::uint8_t number = present.empty() ? std::uint8_t(1) : present[at];
                if (number != runNumber) finish(i);
                runNumber = number;
                if (number != 0) run.push_back(double(values[at]));
            }
            finish(std::size_t(size[axis]));
        }
    });
}

template <class Real> std::vector<Real> splineCoefficients(const Field& field, int degree) {
    std::vector<Real> values = splineValues<Real>(field);
    const std::span<const std::uint8_t> present =
        field.mask ? std::span<const std::uint8_t>(*field.mask) : std::span<const std::uint8_t>();
    for (int axis = 0; axis < 3; ++axis) splineFilterAxis(field.lattice.size, present, values, axis, degree);
    return values;
}

#define TESSERA_COEFFICIENTS(Real)                                                                                     \
    template std::vector<Real> splineValues<Real>(const Field&);                                                       \
    template void splineFilterAxis(glm::ivec3, std::span<const std::uint8_t>, std::vector<Real>&, int, int);           \
    template std::vector<Real> splineCoefficients<Real>(const Field&, int);
TESSERA_COEFFICIENTS(float)
TESSERA_COEFFICIENTS(double)
#undef TESSERA_COEFFICIENTS

} // namespace tessera::volume
