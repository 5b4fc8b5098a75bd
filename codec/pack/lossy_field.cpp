#include "codec/pack/lossy_field.h"

#include "codec/archive/brick_access.h"
#include "codec/archive/brick_input.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>

namespace tessera::codec {

namespace {

/// One transformed sublattice of a brick.
struct Part {
    glm::ivec3 size{0};
    std::vector<std::uint32_t> codes;
    std::vector<std::uint8_t> present;
    std::vector<std::size_t> from; ///< index in the brick of each sample
};

Part takePart(const BrickFormat& format, std::span<const std::uint32_t> codes, std::span<const std::uint8_t> present,
              int sublattice) {
    Part part;
    part.size = format.sublatticeSize(sublattice);
    for (int z = 0; z < part.size.z; ++z)
        for (int y = 0; y < part.size.y; ++y)
            for (int x = 0; x < part.size.x; ++x) {
                const std::size_t i =
                    (std::size_t(z * format.sublattices() + sublattice) * std::size_t(part.size.y) + std::size_t(y)) *
                        std::size_t(part.size.x) +
                    std::size_t(x);
                part.from.push_back(i);
                part.codes.push_back(codes[i]);
                if (!present.empty()) part.present.push_back(present[i]);
            }
    return part;
}

/// Calls `visit(index)` for every present detail of a transformed sublattice.
template <class Visit> void forDetails(const Part& part, glm::ivec3 low, Visit&& visit) {
    std::size_t i = 0;
    for (int z = 0; z < part.size.z; ++z)
        for (int y = 0; y < part.size.y; ++y)
            for (int x = 0; x < part.size.x; ++x, ++i)
                if ((x >= low.x || y >= low.y || z >= low.z) && volume::isPresent(part.present, i)) visit(i);
}

template <class T> T heldWithin(const NumberCoding& numbers, std::uint32_t code) {
    if constexpr (std::same_as<T, float>) {
        return sampleOf<float>(numbers, code);
    } else {
        const double value = std::rint(valueOf(numbers, code));
        return static_cast<T>(
            std::clamp(value, double(std::numeric_limits<T>::lowest()), double(std::numeric_limits<T>::max())));
    }
}

/// Thresholds the details of one brick and updates its samples; `value` in units of codes.
void thresholdBrick(const BrickFormat& format, Threshold kind, double value, BrickInput& input) {
    if (format.numbers.kind == NumberKind::Float || format.levels < 2 || !(value > 0)) return;
    volume::dispatch(format.type, [&]<class T>(T) {
        std::vector<T> samples(input.samples.size() / sizeof(T));
        std::memcpy(samples.data(), input.samples.data(), input.samples.size());
        std::vector<std::uint32_t> codes;
        for (const T sample : samples) codes.push_back(codeOf(format.numbers, sample));
        // Samples without a code are stored exactly.
        const auto coded = [&](std::size_t i) {
            if constexpr (std::same_as<T, float>)
                return close(format.numbers, 0, samples[i], sampleOf<float>(format.numbers, codes[i]));
            else
                return true;
        };
        std::vector<Part> parts;
        std::vector<std::int32_t> details;
        for (int s = 0; s < format.sublattices(); ++s) {
            Part& part = parts.emplace_back(takePart(format, codes, input.present, s));
            if (part.codes.empty()) continue;
            forward(part.codes, part.present, part.size, format.levels - 1, format.wavelet, Arithmetic::Wide);
            forDetails(part, levelSize(part.size, format.levels - 1),
                       [&](std::size_t i) { details.push_back(static_cast<std::int32_t>(part.codes[i])); });
        }
        applyThreshold(details, kind, value);
        auto next = details.begin();
        for (Part& part : parts) {
            if (part.codes.empty()) continue;
            forDetails(part, levelSize(part.size, format.levels - 1),
                       [&](std::size_t i) { part.codes[i] = static_cast<std::uint32_t>(*next++); });
            inverse(part.codes, part.present, part.size, format.levels - 1, format.wavelet, Arithmetic::Wide);
            for (std::size_t k = 0; k < part.from.size(); ++k) {
                const std::size_t i = part.from[k];
                const bool there = volume::isPresent(input.present, i);
                if (there && coded(i)) samples[i] = heldWithin<T>(format.numbers, part.codes[k]);
            }
        }
        std::memcpy(input.samples.data(), samples.data(), input.samples.size());
    });
}

/// Largest absolute difference of present samples in stored units.
double largestError(volume::ScalarType type, const BrickInput& before, const BrickInput& after) {
    double largest = 0;
    volume::dispatch(type, [&]<class T>(T) {
        for (std::size_t i = 0; i < before.samples.size() / sizeof(T); ++i) {
            if (!volume::isPresent(before.present, i)) continue;
            T was, is;
            std::memcpy(&was, before.samples.data() + i * sizeof(T), sizeof(T));
            std::memcpy(&is, after.samples.data() + i * sizeof(T), sizeof(T));
            const double error = std::abs(double(is) - double(was));
            if (error > 0)
                largest = std::max(largest, error); // differences of NaN and infinities from themselves are no error
        }
    });
    return largest;
}

/// The number coding for thresholding a frame: finer than the bound, to leave room for changes of details.
NumberCoding codingFor(const FrameSamples& samples, double maxError) {
    if (samples.type() != volume::ScalarType::F32) return {};
    if (maxError > 0) return chooseCoding(samples, maxError / 2);
    double lo = std::numeric_limits<double>::infinity(), hi = -lo;
    samples.forSlabs([&](const volume::Field& part, Slab) {
        const auto values = part.as<float>();
        for (std::size_t i = 0; i < values.size(); ++i)
            if (part.present(i) && std::isfinite(values[i]))
                lo = std::min(lo, double(values[i])), hi = std::max(hi, double(values[i]));
        return true;
    });
    constexpr double kParts = 65536;
    return chooseCoding(samples, lo < hi ? (hi - lo) / kParts / 2 : 0.0);
}

/// Converts a threshold to units of codes.
double inCodes(const NumberCoding& numbers, double value) {
    if (numbers.kind == NumberKind::Scaled) return value * numbers.step;
    return numbers.kind == NumberKind::Quantised ? value / numbers.step : value;
}

} // namespace

int stepWithin(volume::ScalarType type, double maxError) {
    constexpr double kMost = 1 << 29;
    if (type == volume::ScalarType::F32 || !(maxError >= 1)) return 1;
    return volume::dispatch(type, [&]<class T>(T) {
        if constexpr (std::same_as<T, float>) {
            return 1;
        } else {
            const auto hi = std::int64_t(std::numeric_limits<T>::max()),
                       lo = -std::int64_t(std::numeric_limits<T>::lowest());
            // Rounding must not leave the range of the type.
            std::int64_t step = 2 * std::int64_t(std::min(std::floor(maxError), kMost)) + 1;
            while (hi % step > step / 2 || lo % step > step / 2) step -= 2;
            return int(step);
        }
    });
}

bool stepFits(volume::ScalarType type, std::int64_t step, double lo, double hi) {
    const std::int64_t half = step / 2; // what countedIn() adds before it divides
    const auto rounded = [step, half](double number) {
        return double(step) * std::floor((std::abs(number) + double(half)) / double(step));
    };
    return volume::dispatch(type, [&]<class T>(T) {
        const double least = lo < 0 ? -rounded(lo) : lo, most = hi > 0 ? rounded(hi) : hi;
        return least >= double(std::numeric_limits<T>::lowest()) && most <= double(std::numeric_limits<T>::max());
    });
}

volume::Field inSteps(volume::Field field, double maxError) {
    const std::int64_t step = stepWithin(field.type, maxError);
    return countedIn(std::move(field), step);
}

volume::Field countedIn(volume::Field field, std::int64_t step) {
    if (step == 1) return field;
    volume::dispatch(field.type, [&]<class T>(T) {
        if constexpr (!std::same_as<T, float>)
            for (T& sample : field.as<T>()) {
                const auto value = std::int64_t(sample);
                sample = static_cast<T>((value >= 0 ? value + step / 2 : value - step / 2) / step);
            }
    });
    field.scale *= double(step);
    return field;
}

Thresholded giveUpDetails(const volume::BrickGrid& grid, FrameSamples& samples, Wavelet wavelet, Threshold kind,
                          double value, std::span<const float> strength, double maxError) {
    constexpr int kTries = 10;
    Thresholded out;
    out.numbers = codingFor(samples, maxError);
    if (out.numbers.kind == NumberKind::Float) return out;
    FrameRecord frame;
    frame.numbers = out.numbers;
    frame.wavelet = wavelet;
    const double most = kind == Threshold::Quantile ? value : inCodes(out.numbers, value);
    const double rounding =
        maxError > 0 ? maxError : std::numeric_limits<double>::max(); // no difference of finite numbers exceeds it
    std::mutex mutex;
    samples.change([&](volume::Field& part, Slab slab) {
        const volume::BrickGrid own = slab.grid(grid);
        const std::size_t firstBrick = slab.bricks(grid).first;
        parallelRanges(own.brickCount(), [&](std::size_t begin, std::size_t end) {
            BrickInput original, left;
            for (std::size_t b = begin; b < end; ++b) {
                const glm::ivec3 brick = own.indexOf(b);
                const BrickFormat format = brickFormat(own, brick, part.type, frame);
                original.take(own, brick, part, part.mask != nullptr);
                BrickInput rounded = original;
                roundAsDecoded(format, rounding, {}, rounded);
                double strongest = most * double(strength[firstBrick + b]), error = 0;
                int tries = 0;
                for (;; ++tries, strongest /= 2) {
                    left = rounded;
                    if (tries < kTries) thresholdBrick(format, kind, strongest, left);
                    error = largestError(part.type, original, left);
                    if (maxError <= 0 || error <= maxError || tries == kTries) break;
                }
                putSamples(own, brick, left.samples, part);
                const std::lock_guard lock(mutex);
                out.maxError = std::max(out.maxError, error);
                out.weakened += tries > 0 ? 1 : 0;
            }
        });
    });
    return out;
}

} // namespace tessera::codec
