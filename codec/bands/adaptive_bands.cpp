#include "codec/bands/adaptive_bands.h"

#include "codec/bands/band_rows.h"
#include "codec/bytes/entropy.h"

#include <algorithm>
#include <bit>
#include <type_traits>

namespace tessera::codec {

namespace {

/// Number of low bits that are coded with equal probabilities, where neighbours are large.
int rawBitsNear(std::uint32_t near) {
    constexpr int kOctave = 5;
    return std::max(0, int(std::bit_width(near + 1)) - 1 - kOctave);
}

std::int32_t signedOf(std::uint32_t size, std::uint32_t negative) {
    return static_cast<std::int32_t>(negative != 0 ? 0u - size : size);
}

} // namespace

template <class Coder>
TESSERA_INLINE std::int32_t AdaptiveBands::codeOne(Coder& coder, std::int32_t value, int group, std::uint32_t near) {
    const auto of = static_cast<std::size_t>(group), about = static_cast<std::size_t>(halfOctaves(near));
    const std::uint32_t negative = value < 0 ? 1 : 0;
    const std::uint32_t size =
        negative != 0 ? 0u - static_cast<std::uint32_t>(value) : static_cast<std::uint32_t>(value);
    auto& larger = larger_[of / 4 * 2 + (of % 4 > 0 ? 1 : 0)][about];
    AdaptiveNumber& rest = rest_[of / 4 * 2 + (of % 4 > 0 ? 1 : 0)];
    const int low = rawBitsNear(near);
    std::uint32_t high = 0, got = 0;
    if (low == 0) {
        if (coder.bit(significant_[of][about], size > 0 ? 1 : 0) == 0) return 0;
        high = 1;
    }
    const std::uint32_t wanted = size >> low;
    std::uint32_t step = 0;
    while (step < kSteps && coder.bit(larger[step], wanted > high ? 1 : 0) != 0) ++high, ++step;
    if (step == kSteps) high += rest.code(coder, wanted - high);
    got = high << low | coder.raw(size & ((1u << low) - 1), low);
    if (got == 0) return 0;
    return signedOf(got, coder.raw(negative, 1));
}

template <class Coder, class Word> void AdaptiveBands::code(Coder& coder, const Band<Word>& band, int group) {
    constexpr bool kReads = !std::is_const_v<Word>; // else writes
    Magnitudes magnitudes(band.size);
    std::vector<std::uint16_t> around(std::size_t(band.size.x));
    // Whether rows of the latest two slices have a coefficient, with one before the first and one after the last.
    std::array<std::vector<std::uint8_t>, 2> filled;
    for (auto& rows : filled) rows.assign(std::size_t(band.size.y) + 2, 0);
    for (int z = 0; z < band.size.z; ++z)
        for (int y = 0; y < band.size.y; ++y) {
            const Neighbours near(magnitudes, z, y);
            Word* const values = band.values + z * band.slicePitch + y * band.rowPitch;
            const std::uint8_t* const present =
                band.present ? band.present + z * band.slicePitch + y * band.rowPitch : nullptr;
            std::uint16_t* const sizes = magnitudes.row(z, y);
            std::uint32_t any = 0;
            for (int x = 0; x < band.size.x; ++x) {
                around[std::size_t(x)] = static_cast<std::uint16_t>(near.sum(x, true) - near.north[x] - near.before[x]);
                any |= around[std::size_t(x)];
            }
            std::uint8_t* const now = filled[std::size_t(z & 1)].data() + y + 1;
            const std::uint8_t* const before = filled[std::size_t(~z & 1)].data() + y + 1;
            *now = 1;
            if (any == 0) {
                std::uint32_t used = 0;
                if constexpr (!kReads)
                    for (int x = 0; x < band.size.x; ++x) used |= static_cast<std::uint32_t>(values[x]);
                const auto about = static_cast<std::size_t>(now[-1] + 2 * before[0] + 4 * before[1]);
                AdaptiveBit& bit = row_[std::size_t(group)][about];
                *now = static_cast<std::uint8_t>(coder.bit(bit, used != 0 ? 1 : 0));
            }
            if (*now == 0) {
                if constexpr (kReads) std::fill_n(values, band.size.x, 0);
                std::fill_n(sizes, band.size.x, std::uint16_t(0));
                continue;
            }
            std::uint32_t west = 0;
            for (int x = 0; x < band.size.x; ++x) {
                std::int32_t value = 0;
                if (!present || present[x] != 0)
                    value = codeOne(coder, kReads ? 0 : values[x], group, around[std::size_t(x)] + 2 * west);
                if constexpr (kReads) values[x] = value;
                west = magnitudeOf(value, 0);
                sizes[x] = static_cast<std::uint16_t>(west);
            }
        }
}

template void AdaptiveBands::code(RangeEncoder&, const Band<const std::int32_t>&, int);
template void AdaptiveBands::code(RangeDecoder&, const Band<std::int32_t>&, int);

namespace {

template <class Visit> void forPresent(std::span<const Band<std::int32_t>> bands, Visit&& visit) {
    for (const Band<std::int32_t>& band : bands)
        for (int z = 0; z < band.size.z; ++z)
            for (int y = 0; y < band.size.y; ++y) {
                const std::ptrdiff_t at = z * band.slicePitch + y * band.rowPitch;
                for (int x = 0; x < band.size.x; ++x)
                    if (!band.present || band.present[at + x] != 0) visit(band.values[at + x]);
            }
}

} // namespace

void AdaptiveBands::encodeCoarse(RangeEncoder& coder, std::span<const Band<std::int32_t>> bands) {
    std::uint32_t before = 0;
    forPresent(bands, [&](std::int32_t value) {
        const auto code = static_cast<std::uint32_t>(value);
        (void)coarse_.code(coder, zigzag(code - before));
        before = code;
    });
}

void AdaptiveBands::decodeCoarse(RangeDecoder& coder, std::span<const Band<std::int32_t>> bands) {
    std::uint32_t before = 0;
    forPresent(bands, [&](std::int32_t& value) {
        before += unzigzag(coarse_.code(coder, 0));
        value = static_cast<std::int32_t>(before);
    });
}

void AdaptiveBands::encode(RangeEncoder& coder, std::span<const Correction> corrections) {
    (void)count_.code(coder, static_cast<std::uint32_t>(corrections.size()));
    std::uint32_t next = 0;
    for (const Correction& one : corrections) {
        (void)gap_.code(coder, one.index - next);
        next = one.index + 1;
        const bool negative = one.times < 0;
        (void)coder.raw(negative ? 1 : 0, 1);
        (void)times_.code(coder, static_cast<std::uint32_t>(negative ? -one.times : one.times) - 1);
    }
}

DecodeStatus AdaptiveBands::decode(RangeDecoder& coder, std::size_t samples, std::vector<Correction>& corrections) {
    const std::uint32_t count = count_.code(coder, 0);
    corrections.clear();
    if (count > samples) return DecodeStatus::BadLength;
    std::uint64_t next = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        next += gap_.code(coder, 0);
        if (next >= samples) return DecodeStatus::BadLength;
        const std::uint32_t negative = coder.raw(0, 1);
        corrections.push_back({static_cast<std::uint32_t>(next), signedOf(times_.code(coder, 0) + 1, negative)});
        ++next;
    }
    return DecodeStatus::Ok;
}

} // namespace tessera::codec
