#include "volume/sources/weighed_rows.h"

#include <algorithm>

namespace tessera::volume {

namespace {

template <class Number> TESSERA_INLINE void sumBody(const WeighedRows<Number>& from, std::size_t n, double* to) {
    const auto [w0, w1, w2, w3] = from.weights;
    const Number* __restrict const r0 = from.rows[0];
    const Number* __restrict const r1 = from.rows[1];
    const Number* __restrict const r2 = from.rows[2];
    const Number* __restrict const r3 = from.rows[3];
    double* __restrict const out = to;
    switch (from.count) {
    case 0:
        std::fill_n(out, n, 0.0);
        return;
    case 1:
        for (std::size_t i = 0; i < n; ++i) out[i] = w0 * double(r0[i]);
        return;
    case 2:
        for (std::size_t i = 0; i < n; ++i) out[i] = w0 * double(r0[i]) + w1 * double(r1[i]);
        return;
    case 3:
        for (std::size_t i = 0; i < n; ++i) out[i] = w0 * double(r0[i]) + w1 * double(r1[i]) + w2 * double(r2[i]);
        return;
    default:
        for (std::size_t i = 0; i < n; ++i)
            out[i] = w0 * double(r0[i]) + w1 * double(r1[i]) + w2 * double(r2[i]) + w3 * double(r3[i]);
    }
}

TESSERA_INLINE void prefilterBody(const float* own, const float* other, const std::array<std::ptrdiff_t, 8>& steps,
                                  std::size_t n, float* to) {
    const auto [s0, s1, s2, s3, s4, s5, s6, s7] = steps;
    float* __restrict const out = to;
    for (std::size_t i = 0; i < n; ++i) {
        const auto centre = double(own[i]);
        const float* const at = other + i;
        double differences = double(at[s0]) - centre;
        differences += double(at[s1]) - centre;
        differences += double(at[s2]) - centre;
        differences += double(at[s3]) - centre;
        differences += double(at[s4]) - centre;
        differences += double(at[s5]) - centre;
        differences += double(at[s6]) - centre;
        differences += double(at[s7]) - centre;
        out[i] = float(centre - differences / 12);
    }
}

TESSERA_INLINE void extremesBody(const std::array<const float*, 4>& rows, std::size_t n, float* lo, float* hi) {
    float* __restrict const least = lo;
    float* __restrict const most = hi;
    const auto [a, b, c, d] = rows;
    for (std::size_t i = 0; i < n; ++i) {
        const float smallA = a[i] < b[i] ? a[i] : b[i], greatA = a[i] < b[i] ? b[i] : a[i];
        const float smallB = c[i] < d[i] ? c[i] : d[i], greatB = c[i] < d[i] ? d[i] : c[i];
        least[i] = smallA < smallB ? smallA : smallB;
        most[i] = greatA < greatB ? greatB : greatA;
    }
}

TESSERA_INLINE std::size_t addBody(const float* from, const double* sums, const float* lo, const float* hi,
                                   double headroom, std::size_t n, float* to) {
    float* __restrict const out = to;
    std::size_t outside = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double value = double(from[i]) + sums[i];
        out[i] = float(value);
        outside += isWithin(value, lo[i], hi[i], headroom) ? 0u : 1u;
    }
    return outside;
}

/// The loops for one instruction set each; not for AVX-512, whose compiler joins products and sums to other bits.
struct Portable {
    template <class Number> static void sum(const WeighedRows<Number>& from, std::size_t n, double* to) {
        sumBody(from, n, to);
    }
    static void prefilter(const float* own, const float* other, const std::array<std::ptrdiff_t, 8>& steps,
                          std::size_t n, float* to) {
        prefilterBody(own, other, steps, n, to);
    }
    static void extremes(const std::array<const float*, 4>& rows, std::size_t n, float* lo, float* hi) {
        extremesBody(rows, n, lo, hi);
    }
    static std::size_t add(const float* from, const double* sums, const float* lo, const float* hi, double headroom,
                           std::size_t n, float* to) {
        return addBody(from, sums, lo, hi, headroom, n, to);
    }
};
struct ByAvx2 {
    template <class Number> TESSERA_AVX2 static void sum(const WeighedRows<Number>& from, std::size_t n, double* to) {
        sumBody(from, n, to);
    }
    TESSERA_AVX2 static void prefilter(const float* own, const float* other, const std::array<std::ptrdiff_t, 8>& steps,
                                       std::size_t n, float* to) {
        prefilterBody(own, other, steps, n, to);
    }
    TESSERA_AVX2 static void extremes(const std::array<const float*, 4>& rows, std::size_t n, float* lo, float* hi) {
        extremesBody(rows, n, lo, hi);
    }
    TESSERA_AVX2 static std::size_t add(const float* from, const double* sums, const float* lo, const float* hi,
                                        double headroom, std::size_t n, float* to) {
        return addBody(from, sums, lo, hi, headroom, n, to);
    }
};

/// Calls run(loops) with those of an instruction set.
template <class Run> auto with(Cpu cpu, const Run& run) {
    return cpu == Cpu::Portable ? run(Portable{}) : run(ByAvx2{});
}

} // namespace

void sumRows(const WeighedRows<float>& from, std::size_t n, double* to, Cpu cpu) {
    with(cpu, [&](auto loops) { decltype(loops)::sum(from, n, to); });
}

void sumRows(const WeighedRows<double>& from, std::size_t n, double* to, Cpu cpu) {
    with(cpu, [&](auto loops) { decltype(loops)::sum(from, n, to); });
}

void prefilterRow(const float* own, const float* other, const std::array<std::ptrdiff_t, 8>& steps, std::size_t n,
                  float* to, Cpu cpu) {
    with(cpu, [&](auto loops) { decltype(loops)::prefilter(own, other, steps, n, to); });
}

void extremesOfRows(const std::array<const float*, 4>& rows, std::size_t n, float* lo, float* hi, Cpu cpu) {
    with(cpu, [&](auto loops) { decltype(loops)::extremes(rows, n, lo, hi); });
}

std::size_t addWithin(const float* from, const double* sums, const float* lo, const float* hi, double headroom,
                      std::size_t n, float* to, Cpu cpu) {
    return with(cpu, [&](auto loops) { return decltype(loops)::add(from, sums, lo, hi, headroom, n, to); });
}

} // namespace tessera::volume
