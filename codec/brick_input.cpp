#include "codec/brick_input.h"

#include "codec/brick_access.h"
#include "volume/number_extent.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace tessera::codec {

namespace {

template <class T> T sampleAt(const Bytes& samples, std::size_t i) {
    T sample;
    std::memcpy(&sample, samples.data() + i * sizeof(T), sizeof(T));
    return sample;
}

} // namespace

void BrickInput::take(const volume::BrickGrid& grid, glm::ivec3 brick, const volume::Field& field, bool masked) {
    const glm::ivec3 begin = grid.begin(brick);
    take(grid, begin, grid.end(brick) - begin, field, masked);
}

void BrickInput::take(const volume::BrickGrid& grid, glm::ivec3 begin, glm::ivec3 size, const volume::Field& field,
                      bool masked) {
    const std::size_t sampleBytes = volume::byteSize(field.type), n = std::size_t(size.x);
    const std::size_t rowBytes = n * sampleBytes;
    samples.resize(rowBytes * std::size_t(size.y) * std::size_t(size.z));
    std::byte* to = samples.data();
    present.clear();
    bool mixed = false;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y, to += rowBytes) {
            const std::size_t from = grid.lattice.index(begin + glm::ivec3(0, y, z));
            std::memcpy(to, field.samples.data() + from * sampleBytes, rowBytes);
            for (std::size_t i = from; masked && i < from + n; ++i) {
                present.push_back(field.present(i) ? 1 : 0);
                mixed = mixed || present.back() == 0;
            }
        }
    if (!mixed) present.clear();
}

void putSamples(const volume::BrickGrid& grid, glm::ivec3 brick, std::span<const std::byte> samples,
                volume::Field& field) {
    const std::size_t sampleBytes = volume::byteSize(field.type);
    forBrickRows(grid, brick, [&](std::size_t to, std::size_t from, std::size_t n) {
        std::memcpy(field.samples.data() + to * sampleBytes, samples.data() + from * sampleBytes, n * sampleBytes);
    });
}

void roundAsDecoded(const BrickFormat& format, double maxError, BrickInput& input) {
    if (format.numbers.kind != NumberKind::Quantised) return;
    for (std::size_t i = 0; i < input.samples.size() / sizeof(float); ++i) {
        if (!input.present.empty() && input.present[i] == 0) continue;
        const auto sample = sampleAt<float>(input.samples, i);
        const float decoded = sampleOf<float>(format.numbers, codeOf(format.numbers, sample));
        if (close(format.numbers, maxError, sample, decoded))
            std::memcpy(input.samples.data() + i * sizeof(float), &decoded, sizeof(float));
    }
}

FrameBrick rangeOf(const volume::Field& field, const BrickInput& decoded) {
    double lo = 0, hi = -1;
    const auto add = [&](double number) {
        const double value = field.offset + field.scale * number;
        if (lo > hi) lo = hi = value;
        lo = std::min(lo, value), hi = std::max(hi, value);
    };
    volume::dispatch(field.type, [&]<class T>(T) {
        const std::size_t count = decoded.samples.size() / sizeof(T);
        if constexpr (!std::same_as<T, float>)
            if (decoded.present.empty() && count > 0) { // of the ends of the range only
                const volume::NumberExtent<T> extent =
                    volume::extentOfNumbers(std::span(reinterpret_cast<const T*>(decoded.samples.data()), count));
                add(double(extent.least)), add(double(extent.most));
                return;
            }
        for (std::size_t i = 0; i < count; ++i) {
            if (!decoded.present.empty() && decoded.present[i] == 0) continue;
            const T sample = sampleAt<T>(decoded.samples, i);
            if constexpr (std::same_as<T, float>)
                if (!std::isfinite(sample)) continue;
            add(static_cast<double>(sample));
        }
    });
    return {static_cast<float>(lo), static_cast<float>(hi), {}};
}

bool mayStandFor(volume::ScalarType type, const BrickInput& decoded, const BrickInput& input, double maxError,
                 bool absentToo) {
    if (decoded.present != input.present) return false;
    if (decoded.samples == input.samples) return true;
    if (input.present.empty() && maxError == 0) return false;
    return volume::dispatch(type, [&]<class T>(T) {
        const std::size_t count = input.samples.size() / sizeof(T);
        for (std::size_t i = 0; i < count; ++i) {
            const bool there = input.present.empty() || input.present[i] != 0;
            if (!there && !absentToo) continue;
            const T was = sampleAt<T>(decoded.samples, i), is = sampleAt<T>(input.samples, i);
            if constexpr (std::same_as<T, float>) {
                if (std::bit_cast<std::uint32_t>(was) == std::bit_cast<std::uint32_t>(is)) continue;
                if (there && std::abs(double(was) - double(is)) <= maxError) continue;
                return false;
            } else if (was != is) {
                return false;
            }
        }
        return true;
    });
}

} // namespace tessera::codec
