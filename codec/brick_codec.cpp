#include "codec/brick_codec.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>

namespace tessera::codec {

namespace {

using volume::LatticeKind;
using volume::ScalarType;

std::size_t countOf(glm::ivec3 size) {
    return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
}

int sublattices(const BrickFormat& format) {
    return format.kind == LatticeKind::BCC ? 2 : 1;
}

/// Full-resolution samples of one sublattice of the brick.
glm::ivec3 sublatticeSize(const BrickFormat& format, int sublattice) {
    if (format.kind == LatticeKind::CC) return format.size;
    return {format.size.x, format.size.y, (format.size.z + 1 - sublattice) / 2};
}

Arithmetic arithmeticOf(const BrickFormat& format) {
    if (format.numbers.kind == NumberKind::Float) return Arithmetic::Float;
    return format.type == ScalarType::I32 || format.type == ScalarType::F32 ? Arithmetic::Wide : Arithmetic::Narrow;
}

/// Floats are only predicted: an update would mix exponents and overshoot by powers of two.
Wavelet waveletOf(const BrickFormat& format) {
    if (format.numbers.kind != NumberKind::Float) return format.wavelet;
    return levelPhase(format.wavelet) == 0 && format.wavelet != Wavelet::N1 ? Wavelet::N2 : Wavelet::N1;
}

/// Calls `visit(begin, count)` for each row of coefficients of a level: the corner of the coarsest one, or of the seven
/// others of a finer one those with high x, then high y, high x and y, high z, ...
template <class Visit> void forRows(glm::ivec3 full, glm::ivec3 part, glm::ivec3 low, bool coarsest, Visit&& visit) {
    for (int band = coarsest ? 0 : 1; band < (coarsest ? 1 : 8); ++band) {
        glm::ivec3 lo(0), hi = coarsest ? part : low;
        for (int axis = 0; axis < 3; ++axis)
            if ((band >> axis & 1) != 0) lo[axis] = low[axis], hi[axis] = part[axis];
        if (hi.x <= lo.x) continue;
        for (int z = lo.z; z < hi.z; ++z)
            for (int y = lo.y; y < hi.y; ++y)
                visit((std::size_t(z) * std::size_t(full.y) + std::size_t(y)) * std::size_t(full.x) + std::size_t(lo.x),
                      std::size_t(hi.x - lo.x));
    }
}

/// One sublattice while it is transformed: coefficients and flags of the box of some level.
struct Plane {
    glm::ivec3 size{0};
    std::vector<std::uint32_t> values;
    std::vector<std::uint8_t> present; ///< empty: all present
};

/// Slices of one sublattice of a storage array, in order.
template <class T>
void takeSlices(std::span<const T> storage, glm::ivec3 size, int sublattice, int step, std::vector<T>& out) {
    const std::size_t slice = std::size_t(size.x) * std::size_t(size.y);
    for (int z = sublattice; z < size.z; z += step) {
        const T* from = storage.data() + std::size_t(z) * slice;
        out.insert(out.end(), from, from + slice);
    }
}
template <class T>
void putSlices(const std::vector<T>& plane, glm::ivec3 size, int sublattice, int step, std::vector<T>& storage) {
    const std::size_t slice = std::size_t(size.x) * std::size_t(size.y);
    const T* from = plane.data();
    for (int z = sublattice; z < size.z; z += step, from += slice)
        std::copy(from, from + slice, storage.begin() + std::ptrdiff_t(std::size_t(z) * slice));
}

std::vector<std::uint32_t> sampleBits(const BrickFormat& format, std::span<const std::byte> samples) {
    std::vector<std::uint32_t> bits(countOf(format.size));
    volume::dispatch(format.type, [&]<class T>(T) {
        for (std::size_t i = 0; i < bits.size(); ++i) {
            T sample;
            std::memcpy(&sample, samples.data() + i * sizeof(T), sizeof(T));
            if constexpr (std::same_as<T, float>)
                bits[i] = std::bit_cast<std::uint32_t>(sample);
            else
                bits[i] = codeOf(format.numbers, sample);
        }
    });
    return bits;
}

/// Coefficients of one level of all sublattices that belong to present samples, in the order of the format.
std::vector<std::uint32_t> collect(const BrickFormat& format, std::span<const Plane> planes, int level) {
    std::vector<std::uint32_t> coefficients;
    for (const Plane& plane : planes)
        forRows(plane.size, levelSize(plane.size, level), levelSize(plane.size, level + 1), level == format.levels - 1,
                [&](std::size_t begin, std::size_t count) {
                    if (plane.present.empty()) {
                        const auto from = plane.values.begin() + std::ptrdiff_t(begin);
                        coefficients.insert(coefficients.end(), from, from + std::ptrdiff_t(count));
                        return;
                    }
                    for (std::size_t i = begin; i < begin + count; ++i)
                        if (plane.present[i] != 0) coefficients.push_back(plane.values[i]);
                });
    return coefficients;
}

/// Index of what is stored beside the coefficients of full resolution.
bool canHaveExact(const BrickFormat& format) {
    return format.numbers.kind == NumberKind::Scaled || format.numbers.kind == NumberKind::Quantised;
}

} // namespace

glm::ivec3 samplesAt(const BrickFormat& format, int level) {
    glm::ivec3 size = levelSize(format.size, level);
    if (format.kind == LatticeKind::BCC)
        size.z = levelSize(sublatticeSize(format, 0), level).z + levelSize(sublatticeSize(format, 1), level).z;
    return size;
}

std::vector<std::uint8_t> maskAt(const BrickFormat& format, std::span<const std::uint8_t> present, int level) {
    if (present.empty()) return {};
    const glm::ivec3 size = samplesAt(format, level);
    const int perTexel = sublattices(format), stride = 1 << level;
    std::vector<std::uint8_t> out;
    out.reserve(countOf(size));
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y) {
            const int fineZ = (z / perTexel) * stride * perTexel + z % perTexel;
            const std::size_t row = (std::size_t(fineZ) * std::size_t(format.size.y) + std::size_t(y * stride)) *
                                    std::size_t(format.size.x);
            for (int x = 0; x < size.x; ++x) out.push_back(present[row + std::size_t(x * stride)]);
        }
    return out;
}

std::vector<Bytes> encodeBrick(const BrickFormat& format, std::span<const std::byte> samples,
                               std::span<const std::uint8_t> present, double maxError, Compressor& compressor) {
    const std::size_t total = countOf(format.size);
    assert(samples.size() == total * volume::byteSize(format.type));
    assert(present.empty() || present.size() == total);
    const std::vector<std::uint32_t> bits = sampleBits(format, samples);
    std::vector<std::uint32_t> codes = bits;
    std::vector<std::uint32_t> exactIndex, exactBits, absentBits;
    for (std::size_t i = 0; i < total; ++i) {
        if (!present.empty() && present[i] == 0) {
            absentBits.push_back(bits[i]);
            continue;
        }
        if (format.type != ScalarType::F32) continue;
        const auto sample = std::bit_cast<float>(bits[i]);
        codes[i] = codeOf(format.numbers, sample);
        if (canHaveExact(format) &&
            !close(format.numbers, maxError, sample, sampleOf<float>(format.numbers, codes[i]))) {
            exactIndex.push_back(static_cast<std::uint32_t>(i));
            exactBits.push_back(bits[i]);
        }
    }

    const int step = sublattices(format);
    std::vector<Plane> planes(static_cast<std::size_t>(step));
    for (int s = 0; s < step; ++s) {
        Plane& plane = planes[std::size_t(s)];
        plane.size = sublatticeSize(format, s);
        takeSlices(std::span<const std::uint32_t>(codes), format.size, s, step, plane.values);
        if (!present.empty()) takeSlices(present, format.size, s, step, plane.present);
        forward(plane.values, plane.present, plane.size, format.levels - 1, waveletOf(format), arithmeticOf(format));
    }

    std::vector<Bytes> segments(static_cast<std::size_t>(format.levels));
    for (int level = format.levels - 1; level >= 0; --level) {
        Bytes& out = segments[std::size_t(format.levels - 1 - level)];
        std::vector<std::uint32_t> symbols = collect(format, planes, level);
        if (level == format.levels - 1) { // differences from the one before; the first as it is
            for (std::size_t i = symbols.size(); i-- > 1;) symbols[i] -= symbols[i - 1];
            if (!symbols.empty()) appendU32(out, symbols[0]);
            if (!symbols.empty()) symbols.erase(symbols.begin());
        }
        for (std::uint32_t& symbol : symbols) symbol = zigzag(symbol);
        encodeStream(symbols, compressor, out);
    }
    Bytes& fine = segments.back();
    if (format.keepsAbsent) encodeStream(absentBits, compressor, fine);
    if (canHaveExact(format)) {
        appendU32(fine, static_cast<std::uint32_t>(exactIndex.size()));
        encodeStream(exactIndex, compressor, fine);
        encodeStream(exactBits, compressor, fine);
    }
    return segments;
}

DecodeStatus decodeBrick(const BrickFormat& format, std::span<const std::span<const std::byte>> segments, int level,
                         std::span<const std::uint8_t> present, DecodedBrick& out) {
    assert(level >= 0 && level < format.levels && int(segments.size()) == format.levels - level);
    assert(present.empty() || present.size() == countOf(format.size));
    const int step = sublattices(format), steps = format.levels - 1 - level;
    const glm::ivec3 size = samplesAt(format, level);
    out = {};
    out.present = maskAt(format, present, level);

    std::vector<Plane> planes(static_cast<std::size_t>(step));
    for (int s = 0; s < step; ++s) {
        Plane& plane = planes[std::size_t(s)];
        plane.size = levelSize(sublatticeSize(format, s), level);
        plane.values.resize(countOf(plane.size));
        if (out.present.empty()) continue;
        takeSlices(std::span<const std::uint8_t>(out.present), size, s, step, plane.present);
        deinterleave(plane.present, plane.size, steps);
    }

    std::vector<std::uint32_t> symbols;
    for (int i = 0; i <= steps; ++i) {
        const bool coarsest = i == 0;
        // The places of this level's coefficients, counted first.
        std::size_t count = 0;
        const auto visitPlaces = [&](auto&& visit) {
            for (Plane& plane : planes)
                forRows(plane.size, levelSize(plane.size, steps - i), levelSize(plane.size, steps - i + 1), coarsest,
                        [&](std::size_t begin, std::size_t length) { visit(plane, begin, length); });
        };
        visitPlaces([&](const Plane& plane, std::size_t begin, std::size_t length) {
            if (plane.present.empty())
                count += length;
            else
                for (std::size_t at = begin; at < begin + length; ++at) count += plane.present[at] != 0 ? 1 : 0;
        });
        std::span<const std::byte> in = segments[std::size_t(i)];
        symbols.resize(count);
        std::span<std::uint32_t> coded = symbols;
        if (coarsest && count > 0) {
            if (in.size() < 4) return DecodeStatus::Truncated;
            symbols[0] = readU32(in.data());
            in = in.subspan(4);
            coded = coded.subspan(1);
        }
        if (const DecodeStatus status = decodeStream(in, coded); status != DecodeStatus::Ok) return status;
        for (std::uint32_t& symbol : coded) symbol = unzigzag(symbol);
        if (coarsest)
            for (std::size_t k = 1; k < count; ++k) symbols[k] += symbols[k - 1];
        const std::uint32_t* next = symbols.data();
        visitPlaces([&](Plane& plane, std::size_t begin, std::size_t length) {
            if (plane.present.empty()) {
                std::copy(next, next + length, plane.values.begin() + std::ptrdiff_t(begin));
                next += length;
            } else {
                for (std::size_t at = begin; at < begin + length; ++at)
                    if (plane.present[at] != 0) plane.values[at] = *next++;
            }
        });

        if (i == format.levels - 1) {
            if (format.keepsAbsent) {
                out.absent.resize(std::size_t(std::count(present.begin(), present.end(), std::uint8_t(0))));
                if (const DecodeStatus status = decodeStream(in, out.absent); status != DecodeStatus::Ok) return status;
            }
            if (canHaveExact(format)) {
                if (in.size() < 4) return DecodeStatus::Truncated;
                const std::size_t exact = readU32(in.data());
                in = in.subspan(4);
                if (exact > countOf(format.size)) return DecodeStatus::BadLength;
                std::vector<std::uint32_t> index(exact), bits(exact);
                if (const DecodeStatus status = decodeStream(in, index); status != DecodeStatus::Ok) return status;
                if (const DecodeStatus status = decodeStream(in, bits); status != DecodeStatus::Ok) return status;
                for (std::size_t k = 0; k < exact; ++k) {
                    if (index[k] >= countOf(format.size)) return DecodeStatus::BadLength;
                    out.exact.push_back({index[k], bits[k]});
                }
            }
        }
        if (!in.empty()) return DecodeStatus::Trailing;
    }

    out.codes.resize(countOf(size));
    for (int s = 0; s < step; ++s) {
        Plane& plane = planes[std::size_t(s)];
        inverse(plane.values, plane.present, plane.size, steps, waveletOf(format), arithmeticOf(format));
        putSlices(plane.values, size, s, step, out.codes);
    }
    return DecodeStatus::Ok;
}

} // namespace tessera::codec
