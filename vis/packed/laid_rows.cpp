#include "vis/packed/laid_rows.h"

#include "volume/base/parallel.h"

#include <algorithm>
#include <span>

namespace tessera::vis::packet {

namespace {

/// Rows of samples in memory, and their neighbours.
struct RowsFrom {
    const float* first;
    std::ptrdiff_t pitch;
    const std::array<std::ptrdiff_t, 8>& steps;
};

template <std::size_t kCount>
TESSERA_INLINE float filtered(const float* at, const std::array<std::ptrdiff_t, 8>& steps) {
    float differences = at[steps[0]] - *at;
    for (std::size_t n = 1; n < kCount; ++n) differences += at[steps[n]] - *at;
    return *at - differences * (1.0f / 12);
}

template <std::size_t kCount>
TESSERA_INLINE void filterBody(const RowsFrom& from, std::size_t rows, std::size_t width, float* to) {
    constexpr std::size_t kTogether = 8; // the last ones overlap: rows of bricks are short
    const std::array<std::ptrdiff_t, 8> steps = from.steps;
    for (std::size_t row = 0; row < rows; ++row) {
        const float* const in = from.first + std::ptrdiff_t(row) * from.pitch;
        float* __restrict const out = to + row * width;
        if (width < kTogether) {
            for (std::size_t i = 0; i < width; ++i) out[i] = filtered<kCount>(in + i, steps);
            continue;
        }
        for (std::size_t i = 0; i < width; i += kTogether) {
            const std::size_t first = std::min(i, width - kTogether);
            float made[kTogether]; // which is no sample
            for (std::size_t j = 0; j < kTogether; ++j) made[j] = filtered<kCount>(in + first + j, steps);
            std::copy_n(made, kTogether, out + first);
        }
    }
}

template <std::size_t kCount>
TESSERA_AVX2 void filterAvx2(const RowsFrom& from, std::size_t rows, std::size_t width, float* to) {
    filterBody<kCount>(from, rows, width, to);
}
template <std::size_t kCount>
void filter(const RowsFrom& from, std::size_t rows, std::size_t width, float* to, Cpu cpu) {
    if (cpu == Cpu::Portable) return filterBody<kCount>(from, rows, width, to);
    filterAvx2<kCount>(from, rows, width, to);
}

/// The same of a row among whose samples some are absent.
void filterMasked(const float* from, const std::uint8_t* present, std::span<const std::ptrdiff_t> steps,
                  std::size_t width, float* to) {
    for (std::size_t i = 0; i < width; ++i) {
        to[i] = 0;
        if (present[i] == 0) continue;
        float differences = 0;
        for (const std::ptrdiff_t step : steps)
            if (present[std::ptrdiff_t(i) + step] != 0) differences += from[std::ptrdiff_t(i) + step] - from[i];
        to[i] = from[i] - differences * (1.0f / 12);
    }
}

/// To the neighbours of a sample in memory, on even and on odd slices.
std::array<std::array<std::ptrdiff_t, 8>, 2> stepsOf(glm::ivec3 size, volume::LatticeKind kind) {
    const std::ptrdiff_t row = size.x, slice = row * size.y;
    if (kind == volume::LatticeKind::CC) {
        const std::array<std::ptrdiff_t, 8> steps{-1, 1, -row, row, -slice, slice, 0, 0};
        return {steps, steps};
    }
    std::array<std::array<std::ptrdiff_t, 8>, 2> out{};
    for (int odd = 0; odd < 2; ++odd) {
        std::size_t n = 0;
        for (const int z : {-1, 1})
            for (const int y : {odd - 1, odd})
                for (const int x : {odd - 1, odd}) out[std::size_t(odd)][n++] = z * slice + y * row + x;
    }
    return out;
}

} // namespace

LaidRows::LaidRows(const PaddedSamples& samples, volume::LatticeKind kind, bool filtered, Cpu cpu)
    : samples_(samples), slices_(kind == volume::LatticeKind::BCC ? 2 : 1), halo_(filtered ? 1 : 0),
      size_(samples.size - 2 * halo_ * glm::ivec3(1, 1, slices_)), cpu_(cpu), steps_(stepsOf(samples.size, kind)) {
    if (filtered) neighbours_ = kind == volume::LatticeKind::BCC ? 8 : 6;
}

void LaidRows::read(glm::ivec3 first, int width, int rows, float* values, std::uint8_t* present) const {
    const glm::ivec3 at = first + halo_ * glm::ivec3(1, 1, slices_);
    const std::size_t pitch = std::size_t(samples_.size.x), n = std::size_t(width);
    const std::size_t begin =
        (std::size_t(at.z) * std::size_t(samples_.size.y) + std::size_t(at.y)) * pitch + std::size_t(at.x);
    const float* const from = samples_.values.data() + begin;
    const auto& steps = steps_[std::size_t(first.z & 1)];
    if (masked())
        for (std::size_t y = 0; y < std::size_t(rows); ++y) {
            const std::uint8_t* const there = samples_.present.data() + begin + y * pitch;
            std::copy_n(there, n, present + y * n);
            if (neighbours_ > 0)
                filterMasked(from + y * pitch, there, {steps.data(), neighbours_}, n, values + y * n);
            else
                std::copy_n(from + y * pitch, n, values + y * n);
        }
    else if (neighbours_ == 8)
        filter<8>({from, std::ptrdiff_t(pitch), steps}, std::size_t(rows), n, values, cpu_);
    else if (neighbours_ == 6)
        filter<6>({from, std::ptrdiff_t(pitch), steps}, std::size_t(rows), n, values, cpu_);
    else
        for (std::size_t y = 0; y < std::size_t(rows); ++y) std::copy_n(from + y * pitch, n, values + y * n);
}

Extent LaidRows::extent(glm::ivec3 end) const {
    constexpr int kTogether = 8; // rows
    std::vector<Extent> own(std::size_t(end.z));
    parallelFor(own.size(), [&](std::size_t z) {
        std::vector<float> values(std::size_t(end.x) * kTogether);
        std::vector<std::uint8_t> present(masked() ? values.size() : 0);
        for (int y = 0; y < end.y; y += kTogether) {
            const int rows = std::min(kTogether, end.y - y);
            read({0, y, int(z)}, end.x, rows, values.data(), present.data());
            own[z].add(
                extentOf(values.data(), masked() ? present.data() : nullptr, std::size_t(end.x) * std::size_t(rows)));
        }
    });
    Extent out;
    for (const Extent& slice : own) out.add(slice);
    return out;
}

} // namespace tessera::vis::packet
