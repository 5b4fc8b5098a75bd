#include "codec/whole_brick.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <optional>
#include <vector>

namespace tessera::codec {

namespace {

constexpr std::byte kWhole{5}, kPalette{6};
constexpr std::size_t kMostColours = 256;

/// The distinct codes in ascending order, as signed; empty when there are too many for indices of one byte.
std::vector<std::int32_t> paletteOf(std::span<const std::uint32_t> codes) {
    std::vector<std::int32_t> palette;
    std::optional<std::int32_t> before;
    for (const std::uint32_t code : codes) {
        const auto value = static_cast<std::int32_t>(code);
        if (before == value) continue;
        before = value;
        const auto at = std::lower_bound(palette.begin(), palette.end(), value);
        if (at != palette.end() && *at == value) continue;
        if (palette.size() == kMostColours) return {};
        palette.insert(at, value);
    }
    return palette;
}

} // namespace

bool isWhole(std::byte mode) {
    return mode == kWhole || mode == kPalette;
}

Bytes encodeWhole(std::span<const std::uint32_t> codes, Compressor& compressor) {
    std::vector<std::int32_t> palette = paletteOf(codes);
    std::vector<std::uint32_t> symbols(codes.size());
    // With few gaps, a palette without any is shorter: all its steps are alike.
    constexpr std::int64_t kMostGaps = 64;
    if (palette.size() > 1) {
        const auto colours = std::int64_t(palette.size()), range = std::int64_t(palette.back()) - palette.front() + 1;
        if (range <= std::int64_t(kMostColours) && range - colours <= kMostGaps && range - colours > 0) {
            palette.resize(std::size_t(range));
            std::iota(palette.begin(), palette.end(), palette.front());
        }
    }
    if (palette.size() < 2) {
        for (std::size_t i = 0; i < codes.size(); ++i) symbols[i] = zigzag(codes[i]);
        Bytes whole{kWhole};
        encodeStream(symbols, compressor, whole);
        return whole;
    }
    for (std::size_t i = 0; i < codes.size(); ++i)
        symbols[i] = static_cast<std::uint32_t>(
            std::lower_bound(palette.begin(), palette.end(), static_cast<std::int32_t>(codes[i])) - palette.begin());
    std::vector<std::uint32_t> steps;
    for (std::size_t i = 0; i < palette.size(); ++i)
        steps.push_back(i == 0
                            ? zigzag(std::bit_cast<std::uint32_t>(palette[0]))
                            : std::bit_cast<std::uint32_t>(palette[i]) - std::bit_cast<std::uint32_t>(palette[i - 1]));
    Bytes whole{kPalette, static_cast<std::byte>(palette.size() - 1)};
    encodeStream(steps, compressor, whole);
    encodeStream(symbols, compressor, whole);
    return whole;
}

DecodeStatus decodeWhole(std::span<const std::byte> in, std::span<std::uint32_t> codes) {
    const bool indexed = in[0] == kPalette;
    in = in.subspan(1);
    std::vector<std::uint32_t> palette;
    if (indexed) {
        if (in.empty()) return DecodeStatus::Truncated;
        palette.resize(static_cast<std::size_t>(in[0]) + 1);
        in = in.subspan(1);
        if (const DecodeStatus status = decodeStream(in, palette); status != DecodeStatus::Ok) return status;
        palette[0] = unzigzag(palette[0]);
        for (std::size_t i = 1; i < palette.size(); ++i) palette[i] += palette[i - 1];
    }
    if (const DecodeStatus status = decodeStream(in, codes); status != DecodeStatus::Ok) return status;
    if (!in.empty()) return DecodeStatus::Trailing;
    for (std::uint32_t& code : codes) {
        if (indexed && code >= palette.size()) return DecodeStatus::BadData;
        code = indexed ? palette[code] : unzigzag(code);
    }
    return DecodeStatus::Ok;
}

} // namespace tessera::codec
