#include "codec/archive/brick_input.h"

#include "codec/archive/brick_access.h"

#include <algorithm>
#include <array>
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

/// roundAsDecoded for integers of quantised coefficients.
void roundIntegers(const BrickFormat& format, std::span<const std::uint32_t> decoded, BrickInput& input) {
    volume::dispatch(format.type, [&]<class T>(T) {
        for (std::size_t i = 0; i < decoded.size(); ++i) {
            if (!volume::isPresent(input.present, i)) continue;
            const T sample = sampleOf<T>(format.numbers, decoded[i]);
            std::memcpy(input.samples.data() + i * sizeof(T), &sample, sizeof(T));
        }
    });
}

} // namespace

void BrickInput::take(const volume::BrickGrid& grid, glm::ivec3 brick, const FrameSamples& frame, bool masked) {
    const glm::ivec3 begin = grid.begin(brick);
    take(grid, begin, grid.end(brick) - begin, frame, masked);
}

void BrickInput::take(const volume::BrickGrid& grid, glm::ivec3 begin, glm::ivec3 size, const FrameSamples& frame,
                      bool masked) {
    const std::size_t sampleBytes = volume::byteSize(frame.type()), n = std::size_t(size.x);
    const std::size_t count = n * std::size_t(size.y) * std::size_t(size.z);
    samples.resize(count * sampleBytes);
    present.resize(masked ? count : 0);
    const volume::Field* const field = frame.whole();
    std::byte* to = samples.data();
    std::uint8_t* flags = masked ? present.data() : nullptr;
    constexpr std::size_t kCacheLine = 64;
    constexpr int kAhead = 16; // rows that are fetched from memory before they are copied, as they are far apart
    const auto indexOf = [&](int row) { return grid.lattice.index(begin + glm::ivec3(0, row % size.y, row / size.y)); };
    const int rows = size.y * size.z;
    for (int row = 0; row < rows; ++row) {
        const std::size_t from = indexOf(row);
        if (field && row + kAhead < rows) {
            const std::byte* const next = field->samples.data() + indexOf(row + kAhead) * sampleBytes;
            for (std::size_t i = 0; i < n * sampleBytes; i += kCacheLine) __builtin_prefetch(next + i);
        }
        frame.read(from, n, to, flags);
        to += n * sampleBytes;
        if (flags) flags += n;
    }
    if (std::find(present.begin(), present.end(), std::uint8_t(0)) == present.end()) present.clear();
}

void BrickInput::takeParts(const volume::BrickGrid& grid, glm::ivec3 begin, glm::ivec3 size,
                           const FrameSamples& frame) {
    const std::size_t n = std::size_t(size.x);
    parts.resize(countOf(size));
    std::uint8_t* to = parts.data();
    for (int row = 0; row < size.y * size.z; ++row, to += n)
        frame.read(grid.lattice.index(begin + glm::ivec3(0, row % size.y, row / size.y)), n,
                   reinterpret_cast<std::byte*>(to), nullptr);
}

void putSamples(const volume::BrickGrid& grid, glm::ivec3 brick, std::span<const std::byte> samples,
                volume::Field& field) {
    const std::size_t sampleBytes = volume::byteSize(field.type);
    forBrickRows(grid, brick, [&](std::size_t to, std::size_t from, std::size_t n) {
        std::memcpy(field.samples.data() + to * sampleBytes, samples.data() + from * sampleBytes, n * sampleBytes);
    });
}

void roundAsDecoded(const BrickFormat& format, double maxError, std::span<const std::uint32_t> decoded,
                    BrickInput& input) {
    if (!isBounded(format.numbers)) return;
    if (format.type != volume::ScalarType::F32) return roundIntegers(format, decoded, input);
    constexpr std::size_t kRow = 512;
    std::array<float, kRow> samples, rounded;
    std::array<std::uint32_t, kRow> own;
    const std::size_t all = input.samples.size() / sizeof(float);
    for (std::size_t first = 0; first < all; first += kRow) {
        const std::size_t count = std::min(kRow, all - first);
        const std::span<std::byte> row(input.samples.data() + first * sizeof(float), count * sizeof(float));
        std::memcpy(samples.data(), row.data(), row.size());
        const std::uint32_t* codes = format.isStepped() ? decoded.data() + first : own.data();
        if (!format.isStepped()) codesOf(format.numbers, row, own.data());
        toSamples(format.numbers, std::span(reinterpret_cast<const std::int32_t*>(codes), count), rounded.data());
        for (std::size_t i = 0; i < count; ++i)
            rounded[i] = std::abs(double(samples[i]) - double(rounded[i])) <= maxError ? rounded[i] : samples[i];
        for (std::size_t i = 0; !input.present.empty() && i < count; ++i)
            if (input.present[first + i] == 0) rounded[i] = samples[i];
        std::memcpy(row.data(), rounded.data(), row.size());
    }
}

FrameBrick statisticsOf(const volume::Field& field, const BrickInput& decoded, bool withHistogram) {
    const BrickSummary brick =
        summaryOf(field.type, field.offset, field.scale, decoded.samples, decoded.present, withHistogram);
    return {brick.min, brick.max, brick.histogram, {}};
}

bool mayStandFor(volume::ScalarType type, const BrickInput& decoded, const BrickInput& input, double maxError,
                 bool absentToo) {
    if (decoded.present != input.present) return false;
    if (decoded.samples == input.samples) return true;
    if (input.present.empty() && maxError == 0) return false;
    return volume::dispatch(type, [&]<class T>(T) {
        const std::size_t count = input.samples.size() / sizeof(T);
        for (std::size_t i = 0; i < count; ++i) {
            const bool there = volume::isPresent(input.present, i);
            if (!there && !absentToo) continue;
            const T was = sampleAt<T>(decoded.samples, i), is = sampleAt<T>(input.samples, i);
            if (std::memcmp(&was, &is, sizeof(T)) == 0) continue;
            if (!there || !(std::abs(double(was) - double(is)) <= maxError)) return false;
        }
        return true;
    });
}

SampleErrors errorsOf(volume::ScalarType type, const BrickInput& decoded, const BrickInput& input) {
    SampleErrors errors;
    volume::dispatch(type, [&]<class T>(T) {
        for (std::size_t i = 0; i < input.samples.size() / sizeof(T); ++i) {
            if (!volume::isPresent(input.present, i)) continue;
            const double apart = double(sampleAt<T>(decoded.samples, i)) - double(sampleAt<T>(input.samples, i));
            if (!std::isfinite(apart)) continue;
            errors.squares += apart * apart;
            errors.largest = std::max(errors.largest, std::abs(apart));
        }
    });
    return errors;
}

} // namespace tessera::codec
