#include "codec/brick/stepped_brick.h"

#include "codec/wavelet/body_centred.h"
#include "volume/field/field.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace tessera::codec {

namespace {

constexpr std::uint32_t kMostQuantum = 1u << 28;

/// A subband as a band, with its context group and the size of its steps.
struct StepBand {
    Band<std::int32_t> band;
    int group = 0;
    std::uint32_t step = 1;
};

std::uint32_t stepOf(const Subband& subband, std::uint32_t quantum) {
    constexpr std::uint64_t kOne = std::uint64_t(1) << 20; // gains are in 2^-24, the quantum in 1/16
    return static_cast<std::uint32_t>(std::max<std::uint64_t>(1, quantum * kOne / subband.gain()));
}

/// The subbands of the box of one sublattice at a level.
void addBands(LevelBox<std::int32_t>& box, int level, bool coarsest, const StepChoice& steps,
              std::vector<StepBand>& bands) {
    const Box<std::int32_t> values = box.box();
    const std::ptrdiff_t slice = std::ptrdiff_t(values.pitch) * values.size.y;
    for (const Subband& part : subbandsOf(values.size, level, coarsest || box.undivided(), steps.split)) {
        const std::ptrdiff_t at = part.begin.z * slice + std::ptrdiff_t(part.begin.y) * values.pitch + part.begin.x;
        Band<std::int32_t> band;
        band.values = values.values + at;
        band.present = box.masked() ? box.flags().values + at : nullptr;
        band.size = part.size;
        band.rowPitch = values.pitch;
        band.slicePitch = slice;
        bands.push_back({band, AdaptiveBands::groupOf(std::popcount(static_cast<unsigned>(part.high)), level),
                         stepOf(part, steps.quantum)});
    }
}

/// Calls `visit(row of coefficients, flags or null, step)`.
template <class Visit> void forRows(const std::vector<StepBand>& bands, Visit&& visit) {
    for (const StepBand& one : bands)
        for (int z = 0; z < one.band.size.z; ++z)
            for (int y = 0; y < one.band.size.y; ++y) {
                const std::ptrdiff_t at = z * one.band.slicePitch + y * one.band.rowPitch;
                visit(std::span(one.band.values + at, std::size_t(one.band.size.x)),
                      one.band.present ? one.band.present + at : nullptr, one.step);
            }
}

std::vector<Band<std::int32_t>> plainBands(const std::vector<StepBand>& bands) {
    std::vector<Band<std::int32_t>> out;
    for (const StepBand& one : bands) out.push_back(one.band);
    return out;
}

void multiply(const std::vector<StepBand>& bands) {
    forRows(bands, [](std::span<std::int32_t> row, const std::uint8_t*, std::uint32_t step) {
        for (std::int32_t& value : row) value = static_cast<std::int32_t>(static_cast<std::uint32_t>(value) * step);
    });
}

/// Divides by the steps, rounding down a little more often than up. Coefficients of absent samples become 0. True if
/// all are 0.
bool divide(const std::vector<StepBand>& bands) {
    constexpr double kUp = 0.45;
    std::uint32_t any = 0;
    forRows(bands, [&](std::span<std::int32_t> row, const std::uint8_t* present, std::uint32_t step) {
        const double scale = 1.0 / step, up = step == 1 ? 0.5 : kUp;
        for (std::int32_t& value : row) {
            const auto steps = static_cast<std::int32_t>(std::abs(double(value)) * scale + up);
            value = value < 0 ? -steps : steps;
        }
        for (std::size_t x = 0; x < row.size(); ++x) {
            if (present && present[x] == 0) row[x] = 0;
            any |= static_cast<std::uint32_t>(row[x]);
        }
    });
    return any == 0;
}

bool isWide(const BrickFormat& format) {
    return arithmeticOf(format) == Arithmetic::Wide;
}

/// The samples of finer levels from coarser ones and coefficients, shared by writer and reader.
struct Joining {
    const BrickFormat& format;
    DecodedBrick::Boxes<std::int32_t>& boxes;
    bool predicted;

    int step() const { return format.sublattices(); }
    /// Adds the coefficients in `boxes.details`.
    void level() {
        auto& [samples, details, spare] = boxes;
        for (std::size_t s = 0; s < std::size_t(predicted ? 1 : step()); ++s) {
            splitDetails(details[s], format.wavelet, isWide(format), format.steps.split, false);
            joinLevel<std::int32_t>(format, samples[s], details[s], spare[s]);
        }
        if (predicted) std::swap(spare[1], details[1]);
        std::swap(samples, spare);
    }
    void odd(int level) {
        auto& samples = boxes.samples;
        if (predicted && level == 0) {
            addPrediction<std::int32_t>(std::as_const(samples[0]).box(), samples[1].box(),
                                        format.codeBits > kBitsOfPrediction);
        } else if (predicted) {
            samples[1].reset(levelSize(format.sublatticeSize(1), level), false);
            interpolateOdd<std::int32_t>(std::as_const(samples[0]).box(), samples[1].box(), level);
        }
    }
};

/// Flags of the present samples of each part that has any; empty if that is one part.
std::vector<std::vector<std::uint8_t>> flagsOfParts(std::span<const std::uint8_t> parts,
                                                    std::span<const std::uint8_t> present) {
    std::array<int, 256> place; // of a part among those that have samples
    place.fill(-1);
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (volume::isPresent(present, i)) place[parts[i]] = 0;
    int count = 0;
    for (int& one : place)
        if (one == 0) one = count++;
    if (count < 2) return {};
    std::vector<std::vector<std::uint8_t>> flags(std::size_t(count), std::vector<std::uint8_t>(parts.size()));
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (volume::isPresent(present, i)) flags[std::size_t(place[parts[i]])][i] = 1;
    return flags;
}

/// What is transformed by itself: a brick, or the samples of one of its parts.
struct Lane {
    DecodedBrick::Boxes<std::int32_t>& boxes;
    Joining joining;
    std::span<const std::uint8_t> present;
};
std::vector<Lane> lanesOf(const BrickFormat& format, std::span<const std::uint8_t> present,
                          const std::vector<std::vector<std::uint8_t>>& parts, DecodedBrick::Boxes<std::int32_t>& first,
                          std::vector<DecodedBrick::Boxes<std::int32_t>>& others) {
    std::vector<Lane> lanes;
    others.resize(parts.empty() ? 0 : parts.size() - 1);
    for (std::size_t n = 0; n <= others.size(); ++n) {
        auto& boxes = n == 0 ? first : others[n - 1];
        lanes.push_back({boxes, Joining{format, boxes, format.predictsOdd(!present.empty()) && parts.empty()},
                         parts.empty() ? present : std::span<const std::uint8_t>(parts[n])});
    }
    return lanes;
}

/// Moves the samples of all lanes to the first one's box.
void merge(const BrickFormat& format, int level, std::vector<Lane>& lanes) {
    const glm::ivec3 size = samplesAt(format, level);
    const Box<std::int32_t> to = lanes[0].boxes.samples[0].box();
    for (std::size_t n = 1; n < lanes.size(); ++n) {
        const auto from = std::as_const(lanes[n].boxes.samples[0]).box();
        int i = 0;
        forLevel(format, level, [&](std::size_t at) {
            const int x = i % size.x, y = i / size.x % size.y, z = i / (size.x * size.y);
            if (lanes[n].present[at] != 0) to.row(y, z)[x] = from.row(y, z)[x];
            ++i;
        });
    }
}

void correct(std::span<const Correction> corrections, DecodedBrick& out) {
    const std::size_t nx = std::size_t(out.size.x), ny = std::size_t(out.size.y);
    for (const Correction& one : corrections) {
        const int x = int(one.index % nx), y = int(one.index / nx % ny), z = int(one.index / (nx * ny));
        auto& box = out.boxes32.samples[std::size_t(z % out.sublattices)];
        std::int32_t& code = box.box().row(y, z / out.sublattices)[x];
        constexpr std::uint32_t kUnit = 2 * kReach + 1;
        code =
            static_cast<std::int32_t>(static_cast<std::uint32_t>(code) + static_cast<std::uint32_t>(one.times) * kUnit);
    }
}

/// Corrects decoded codes further than kReach from those wanted; returns the corrections.
std::vector<Correction> correctCodes(std::span<const std::uint32_t> wanted, std::span<const std::uint8_t> present,
                                     std::span<std::uint32_t> decoded) {
    constexpr std::size_t kRow = 512;
    constexpr std::int64_t kUnit = 2 * kReach + 1;
    std::vector<Correction> corrections;
    for (std::size_t first = 0; first < wanted.size(); first += kRow) {
        const std::size_t end = std::min(first + kRow, wanted.size());
        // Differences are less than 2^32, since wanted codes are below 2^29: small ones modulo 2^32 are small.
        std::uint32_t far = 0;
        for (std::size_t i = first; i < end; ++i)
            far |= wanted[i] - decoded[i] + std::uint32_t(kReach) > 2 * std::uint32_t(kReach) ? 1u : 0u;
        for (std::size_t i = first; far != 0 && i < end; ++i) {
            const std::int64_t apart =
                std::int64_t(static_cast<std::int32_t>(wanted[i])) - static_cast<std::int32_t>(decoded[i]);
            if (std::abs(apart) <= kReach || !volume::isPresent(present, i)) continue;
            const auto times = static_cast<std::int32_t>((std::abs(apart) + kReach) / kUnit * (apart < 0 ? -1 : 1));
            corrections.push_back({static_cast<std::uint32_t>(i), times});
            decoded[i] += static_cast<std::uint32_t>(times) * static_cast<std::uint32_t>(kUnit);
        }
    }
    return corrections;
}

} // namespace

Bytes serialise(const StepChoice& steps) {
    Bytes out{static_cast<std::byte>(steps.split.axes), static_cast<std::byte>(steps.split.least)};
    appendLength(out, steps.quantum);
    return out;
}

DecodeStatus parseSteps(std::span<const std::byte> bytes, StepChoice& steps) {
    if (bytes.size() < 2) return DecodeStatus::Truncated;
    steps.split = {static_cast<int>(bytes[0]), static_cast<int>(bytes[1])};
    std::span<const std::byte> in = bytes.subspan(2);
    std::uint64_t length = 0;
    if (const DecodeStatus status = takeLength(in, length); status != DecodeStatus::Ok) return status;
    if (steps.split.axes > 7 || steps.split.least < 2 || length < 1 || length > kMostQuantum)
        return DecodeStatus::BadMode;
    steps.quantum = static_cast<std::uint32_t>(length);
    return in.empty() ? DecodeStatus::Ok : DecodeStatus::Trailing;
}

DecodeStatus decodeStepped(const BrickFormat& format, std::span<const std::span<const std::byte>> segments, int level,
                           std::span<const std::uint8_t> present, std::span<const std::uint8_t> parts,
                           DecodedBrick& out) {
    const auto step = static_cast<std::size_t>(format.sublattices());
    const std::vector<std::vector<std::uint8_t>> flags = flagsOfParts(parts, present);
    std::vector<DecodedBrick::Boxes<std::int32_t>> others;
    std::vector<Lane> lanes = lanesOf(format, present, flags, out.boxes32, others);
    AdaptiveBands model;
    out.corrections.clear();
    for (int l = format.levels - 1; l >= level; --l) {
        const bool coarsest = l == format.levels - 1;
        std::span<const std::byte> in = segments[std::size_t(format.levels - 1 - l)];
        if (l == 0)
            if (const DecodeStatus status = decodeExtras(format, present, in, out); status != DecodeStatus::Ok)
                return status;
        std::vector<StepBand> bands;
        for (Lane& lane : lanes) {
            auto& coded = coarsest ? lane.boxes.samples : lane.boxes.details;
            for (std::size_t s = 0; s < step; ++s) {
                const bool residual = s == 1 && lane.joining.predicted;
                coded[s].reset(residual ? (l == 0 ? format.sublatticeSize(1) : glm::ivec3(0))
                                        : levelSize(format.sublatticeSize(int(s)), l),
                               !lane.present.empty() && !residual);
                if (residual) coded[s].setUndivided();
                if (coded[s].masked()) {
                    placeFlags<std::int32_t>(format, lane.present, l, int(s), !coarsest, coded[s]);
                    coded[s].clear();
                    if (!coarsest)
                        splitDetails(coded[s], format.wavelet, false, format.steps.split, true); // moves flags
                }
                addBands(coded[s], l, coarsest, format.steps, bands);
            }
        }
        if (in.empty()) {
            for (const StepBand& one : bands)
                forRows({one}, [](std::span<std::int32_t> row, const std::uint8_t*, std::uint32_t) {
                    std::fill(row.begin(), row.end(), 0);
                });
        } else {
            RangeDecoder coder(in);
            if (l == 0)
                if (const DecodeStatus status = model.decode(coder, countOf(format.size), out.corrections);
                    status != DecodeStatus::Ok)
                    return status;
            if (coarsest)
                model.decodeCoarse(coder, plainBands(bands));
            else
                for (const StepBand& one : bands) model.decode(coder, one.band, one.group);
            if (const DecodeStatus status = coder.end(); status != DecodeStatus::Ok) return status;
        }
        multiply(bands);
        for (Lane& lane : lanes)
            if (!coarsest) lane.joining.level();
    }
    for (Lane& lane : lanes) lane.joining.odd(level);
    merge(format, level, lanes);
    correct(out.corrections, out);
    return DecodeStatus::Ok;
}

SteppedBrick encodeStepped(const BrickFormat& format, std::span<const std::uint32_t> codes,
                           std::span<const std::uint8_t> present, std::span<const std::uint8_t> parts,
                           BrickLevels<std::int32_t>& memory) {
    const int step = format.sublattices(), count = format.levels;
    const std::vector<std::vector<std::uint8_t>> flags = flagsOfParts(parts, present);
    SteppedBrick out;
    out.segments.resize(std::size_t(count));
    DecodedBrick decoded;
    decoded.begin(format, 0);
    std::vector<DecodedBrick::Boxes<std::int32_t>> others;
    std::vector<Lane> lanes = lanesOf(format, present, flags, decoded.boxes32, others);
    std::vector<BrickLevels<std::int32_t>> memories(others.size());
    std::vector<bool> nothing(static_cast<std::size_t>(count), true);
    std::vector<std::vector<StepBand>> bands(static_cast<std::size_t>(count));

    const auto levelsOf = [&](std::size_t lane) -> BrickLevels<std::int32_t>& {
        return lane == 0 ? memory : memories[lane - 1];
    };
    for (std::size_t n = 0; n < lanes.size(); ++n)
        splitBrick<std::int32_t>(format, codes, lanes[n].present, count, levelsOf(n));
    for (int l = count - 1; l >= 0; --l) {
        const bool coarsest = l == count - 1;
        const auto at = static_cast<std::size_t>(l);
        for (std::size_t n = 0; n < lanes.size(); ++n)
            for (int s = 0; s < step; ++s) {
                LevelBox<std::int32_t>& box = levelsOf(n)[std::size_t(l * step + s)];
                const bool residual = s == 1 && lanes[n].joining.predicted;
                if (!coarsest && !residual) splitDetails(box, format.wavelet, isWide(format), format.steps.split, true);
                addBands(box, l, coarsest, format.steps, bands[at]);
            }
        nothing[at] = divide(bands[at]);
        // What a reader will get.
        for (std::size_t n = 0; n < lanes.size(); ++n) {
            auto& coded = coarsest ? lanes[n].boxes.samples : lanes[n].boxes.details;
            for (int s = 0; s < step; ++s) coded[std::size_t(s)] = levelsOf(n)[std::size_t(l * step + s)];
            std::vector<StepBand> again;
            for (int s = 0; s < step; ++s) addBands(coded[std::size_t(s)], l, coarsest, format.steps, again);
            multiply(again);
            if (!coarsest) lanes[n].joining.level();
        }
    }
    for (Lane& lane : lanes) lane.joining.odd(0);
    merge(format, 0, lanes);

    out.codes = decoded.codes();
    const std::vector<Correction> corrections = correctCodes(codes, present, out.codes);

    AdaptiveBands model;
    for (int l = count - 1; l >= 0; --l) {
        const auto at = static_cast<std::size_t>(l);
        const bool coarsest = l == count - 1;
        Bytes& segment = out.segments[std::size_t(count - 1 - l)];
        if (nothing[at] && (l > 0 || corrections.empty())) continue;
        RangeEncoder coder;
        if (l == 0) model.encode(coder, corrections);
        if (coarsest)
            model.encodeCoarse(coder, plainBands(bands[at]));
        else
            for (const StepBand& one : bands[at]) {
                const Band<std::int32_t>& band = one.band;
                model.encode(coder, {band.values, band.present, band.size, band.rowPitch, band.slicePitch, band.kind},
                             one.group);
            }
        segment = coder.finish();
    }
    return out;
}

} // namespace tessera::codec
