#include "codec/brick/whole_brick.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <vector>

namespace tessera::codec {

namespace {

constexpr std::byte kWhole{5}, kPalette{6}, kMixed{8};
constexpr std::size_t kMostColours = 256;

/// The distinct codes in ascending (signed) order, and the index of each; empty if there are too many for one-byte
/// indices.
class Palette {
public:
    explicit Palette(std::span<const std::uint32_t> codes) {
        if (codes.empty()) return;
        const auto [least, most] =
            std::minmax_element(codes.begin(), codes.end(), [](std::uint32_t a, std::uint32_t b) {
                return static_cast<std::int32_t>(a) < static_cast<std::int32_t>(b);
            });
        const auto first = static_cast<std::int32_t>(*least);
        const std::int64_t range = std::int64_t(static_cast<std::int32_t>(*most)) - first + 1;
        if (range > kLargestRange) {
            gather(codes);
            return;
        }
        first_ = *least;
        places_.resize(std::size_t(range));
        for (const std::uint32_t code : codes) places_[code - first_] = 1;
        const auto distinct = std::count(places_.begin(), places_.end(), std::uint8_t(1));
        if (distinct > std::ptrdiff_t(kMostColours)) return;
        // With few gaps, the full range is shorter as a palette, since its differences are equal.
        const bool whole = distinct > 1 && range <= std::int64_t(kMostColours) && range - distinct <= kMostGaps;
        for (std::size_t i = 0; i < places_.size(); ++i) {
            if (places_[i] == 0 && !whole) continue;
            places_[i] = static_cast<std::uint8_t>(colours_.size());
            colours_.push_back(first + static_cast<std::int32_t>(i));
        }
    }
    std::span<const std::int32_t> colours() const { return colours_; }
    std::uint32_t placeOf(std::uint32_t code) const {
        if (!places_.empty()) return places_[code - first_];
        return static_cast<std::uint32_t>(
            std::lower_bound(colours_.begin(), colours_.end(), static_cast<std::int32_t>(code)) - colours_.begin());
    }

private:
    static constexpr std::int64_t kLargestRange = 1 << 16, kMostGaps = 64;

    void gather(std::span<const std::uint32_t> codes) {
        std::optional<std::int32_t> before;
        for (const std::uint32_t code : codes) {
            const auto value = static_cast<std::int32_t>(code);
            if (before == value) continue;
            before = value;
            const auto at = std::lower_bound(colours_.begin(), colours_.end(), value);
            if (at != colours_.end() && *at == value) continue;
            if (colours_.size() == kMostColours) {
                colours_.clear();
                return;
            }
            colours_.insert(at, value);
        }
    }

    std::vector<std::int32_t> colours_;
    std::uint32_t first_ = 0;          ///< code of the first of `places_`
    std::vector<std::uint8_t> places_; ///< by code from the smallest on; empty if the codes are too far apart
};

Bytes encodePalette(std::byte mode, std::span<const std::int32_t> palette, Compressor& compressor) {
    std::vector<std::uint32_t> steps;
    for (std::size_t i = 0; i < palette.size(); ++i)
        steps.push_back(i == 0
                            ? zigzag(std::bit_cast<std::uint32_t>(palette[0]))
                            : std::bit_cast<std::uint32_t>(palette[i]) - std::bit_cast<std::uint32_t>(palette[i - 1]));
    Bytes out{mode, static_cast<std::byte>(palette.size() - 1)};
    encodeStream(steps, compressor, out);
    return out;
}

DecodeStatus takePalette(std::span<const std::byte>& in, std::vector<std::uint32_t>& palette) {
    if (in.empty()) return DecodeStatus::Truncated;
    palette.resize(static_cast<std::size_t>(in[0]) + 1);
    in = in.subspan(1);
    if (const DecodeStatus status = decodeStream(in, palette); status != DecodeStatus::Ok) return status;
    palette[0] = unzigzag(palette[0]);
    for (std::size_t i = 1; i < palette.size(); ++i) palette[i] += palette[i - 1];
    return DecodeStatus::Ok;
}

DecodeStatus decodeWholeMixed(std::span<const std::byte> in, const MixedShape& shape, std::span<std::uint32_t> codes) {
    std::vector<std::uint32_t> palette;
    if (const DecodeStatus status = takePalette(in, palette); status != DecodeStatus::Ok) return status;
    if (palette.size() < 2 || codes.size() != shape.count() || codes.size() > kMostMixed) return DecodeStatus::BadMode;
    std::vector<std::uint8_t> symbols(codes.size());
    const DecodeStatus status = decodeMixed(shape, int(palette.size()), in, symbols);
    if (status != DecodeStatus::Ok) return status;
    for (std::size_t i = 0; i < codes.size(); ++i) codes[i] = palette[symbols[i]];
    return DecodeStatus::Ok;
}

} // namespace

bool isWhole(std::byte mode) {
    return mode == kWhole || mode == kPalette || mode == kMixed;
}

bool isMixed(std::byte mode) {
    return mode == kMixed;
}

Bytes encodeWhole(std::span<const std::uint32_t> codes, Compressor& compressor) {
    const Palette all(codes);
    const std::span<const std::int32_t> palette = all.colours();
    std::vector<std::uint32_t> symbols(codes.size());
    if (palette.size() < 2) {
        for (std::size_t i = 0; i < codes.size(); ++i) symbols[i] = zigzag(codes[i]);
        Bytes whole{kWhole};
        encodeStream(symbols, compressor, whole);
        return whole;
    }
    for (std::size_t i = 0; i < codes.size(); ++i) symbols[i] = all.placeOf(codes[i]);
    Bytes whole = encodePalette(kPalette, palette, compressor);
    encodeStream(symbols, compressor, whole);
    return whole;
}

Bytes encodeWholeMixed(std::span<const std::uint32_t> codes, const MixedShape& shape, Compressor& compressor) {
    if (codes.size() > kMostMixed) return {};
    const Palette all(codes);
    const std::span<const std::int32_t> palette = all.colours();
    if (palette.size() < 2) return {};
    std::vector<std::uint8_t> symbols(codes.size());
    for (std::size_t i = 0; i < codes.size(); ++i) symbols[i] = static_cast<std::uint8_t>(all.placeOf(codes[i]));
    Bytes whole = encodePalette(kMixed, palette, compressor);
    const Bytes mixed = encodeMixed(shape, int(palette.size()), symbols);
    whole.insert(whole.end(), mixed.begin(), mixed.end());
    return whole;
}

std::optional<std::uint32_t> onlyCode(std::span<const std::byte> in) {
    // FORMAT.md "Streams": modes 0 and 1.
    if (in.size() == 2 && in[0] == kWhole && in[1] == std::byte{0}) return 0;
    if (in.size() == 6 && in[0] == kWhole && in[1] == std::byte{1}) return unzigzag(readU32(in.data() + 2));
    return std::nullopt;
}

DecodeStatus decodeWhole(std::span<const std::byte> in, std::span<std::uint32_t> codes,
                         const std::optional<MixedShape>& mixed) {
    const std::byte mode = in[0];
    in = in.subspan(1);
    if (mode == kMixed) return mixed ? decodeWholeMixed(in, *mixed, codes) : DecodeStatus::BadMode;
    const bool indexed = mode == kPalette;
    std::vector<std::uint32_t> palette;
    if (indexed)
        if (const DecodeStatus status = takePalette(in, palette); status != DecodeStatus::Ok) return status;
    if (const DecodeStatus status = decodeStream(in, codes); status != DecodeStatus::Ok) return status;
    if (!in.empty()) return DecodeStatus::Trailing;
    if (!indexed) {
        for (std::uint32_t& code : codes) code = unzigzag(code);
        return DecodeStatus::Ok;
    }
    for (std::uint32_t& code : codes) {
        if (code >= palette.size()) return DecodeStatus::BadData;
        code = palette[code];
    }
    return DecodeStatus::Ok;
}

} // namespace tessera::codec
