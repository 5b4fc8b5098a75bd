#include "codec/bytes/entropy.h"

#include "codec/bytes/lzma.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <new>
#include <zstd.h>

namespace tessera::codec {

namespace {

enum Mode : std::uint8_t { kZero = 0, kConstant = 1, kPlanes = 2, kPlanesZstd = 3, kPlanesLzma = 7 };

/// Numbers of literal context bits for LZMA, in the order of trials.
constexpr int kLiteralBits[] = {3, 0, 4};

/// Splits symbols into byte planes: plane p holds byte p of every symbol.
void toPlanes(std::span<const std::uint32_t> symbols, int width, std::byte* planes) {
    for (int p = 0; p < width; ++p, planes += symbols.size())
        for (std::size_t i = 0; i < symbols.size(); ++i) planes[i] = static_cast<std::byte>(symbols[i] >> (8 * p));
}

void fromPlanes(const std::byte* planes, int width, std::span<std::uint32_t> symbols) {
    for (std::size_t i = 0; i < symbols.size(); ++i) symbols[i] = static_cast<std::uint32_t>(planes[i]);
    for (int p = 1; p < width; ++p) {
        planes += symbols.size();
        for (std::size_t i = 0; i < symbols.size(); ++i) symbols[i] |= static_cast<std::uint32_t>(planes[i]) << (8 * p);
    }
}

bool take(std::span<const std::byte>& in, std::size_t count, std::span<const std::byte>& taken) {
    if (in.size() < count) return false;
    taken = in.first(count);
    in = in.subspan(count);
    return true;
}

} // namespace

struct Compressor::Impl {
    std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context{ZSTD_createCCtx(), &ZSTD_freeCCtx};
    int level = 3;
    bool thorough = false;
};

Compressor::Compressor(int zstdLevel, bool thorough) : impl_(std::make_unique<Impl>()) {
    if (!impl_->context) throw std::bad_alloc();
    impl_->level = zstdLevel;
    impl_->thorough = thorough;
}
Compressor::~Compressor() = default;
Compressor::Compressor(Compressor&&) noexcept = default;
Compressor& Compressor::operator=(Compressor&&) noexcept = default;

void Compressor::setLevel(int zstdLevel) {
    impl_->level = zstdLevel;
}
int Compressor::level() const {
    return impl_->level;
}
bool Compressor::triesLzma() const {
    return impl_->thorough && impl_->level >= kMostZstdLevel;
}

Bytes Compressor::compress(std::span<const std::byte> in) {
    Bytes out(ZSTD_compressBound(in.size()));
    const std::size_t size =
        ZSTD_compressCCtx(impl_->context.get(), out.data(), out.size(), in.data(), in.size(), impl_->level);
    if (ZSTD_isError(size) != 0) throw std::bad_alloc(); // the only possible failure with a buffer of this size
    out.resize(size < in.size() ? size : 0);
    return out;
}

DecodeStatus decompress(std::span<const std::byte> in, std::span<std::byte> out) noexcept {
    const std::size_t size = ZSTD_decompress(out.data(), out.size(), in.data(), in.size());
    if (ZSTD_isError(size) != 0) return DecodeStatus::BadData;
    return size == out.size() ? DecodeStatus::Ok : DecodeStatus::BadLength;
}

void encodeStream(std::span<const std::uint32_t> symbols, Compressor& compressor, Bytes& out) {
    if (symbols.empty()) return;
    std::uint32_t bits = 0, differing = 0;
    for (const std::uint32_t symbol : symbols) bits |= symbol, differing |= symbol ^ symbols[0];
    if (bits == 0) {
        out.push_back(std::byte{kZero});
        return;
    }
    if (differing == 0) {
        out.push_back(std::byte{kConstant});
        appendU32(out, symbols[0]);
        return;
    }
    const int width = (static_cast<int>(std::bit_width(bits)) + 7) / 8;
    Bytes planes(symbols.size() * static_cast<std::size_t>(width));
    toPlanes(symbols, width, planes.data());
    const Bytes packed = compressor.compress(planes);
    const bool smaller = !packed.empty() && packed.size() + 4 < planes.size();
    Bytes best = smaller ? packed : planes;
    Mode mode = smaller ? kPlanesZstd : kPlanes;
    int literalBits = 0;
    for (const int tried : kLiteralBits) {
        // If one context does not help, the others will not either.
        if (!compressor.triesLzma() || (tried != kLiteralBits[0] && mode != kPlanesLzma)) break;
        Bytes lzma = encodeLzma(planes, tried);
        if (lzma.size() + 1 >= best.size()) continue;
        best = std::move(lzma), mode = kPlanesLzma, literalBits = tried;
    }
    out.push_back(std::byte{mode});
    out.push_back(static_cast<std::byte>(width));
    if (mode == kPlanesLzma) {
        out.push_back(static_cast<std::byte>(literalBits));
        appendLength(out, static_cast<std::uint32_t>(best.size()));
    } else if (mode == kPlanesZstd) {
        appendU32(out, static_cast<std::uint32_t>(best.size()));
    }
    out.insert(out.end(), best.begin(), best.end());
}

DecodeStatus decodeStream(std::span<const std::byte>& in, std::span<std::uint32_t> symbols) noexcept {
    if (symbols.empty()) return DecodeStatus::Ok;
    std::span<const std::byte> head, body;
    if (!take(in, 1, head)) return DecodeStatus::Truncated;
    const auto mode = static_cast<std::uint8_t>(head[0]);
    if (mode == kZero) {
        std::fill(symbols.begin(), symbols.end(), 0u);
        return DecodeStatus::Ok;
    }
    if (mode == kConstant) {
        if (!take(in, 4, body)) return DecodeStatus::Truncated;
        std::fill(symbols.begin(), symbols.end(), readU32(body.data()));
        return DecodeStatus::Ok;
    }
    if (mode != kPlanes && mode != kPlanesZstd && mode != kPlanesLzma) return DecodeStatus::BadMode;
    if (!take(in, 1, head)) return DecodeStatus::Truncated;
    const int width = static_cast<int>(head[0]);
    if (width < 1 || width > 4) return DecodeStatus::BadLength;
    const std::size_t size = symbols.size() * static_cast<std::size_t>(width);
    if (mode == kPlanes) {
        if (!take(in, size, body)) return DecodeStatus::Truncated;
        fromPlanes(body.data(), width, symbols);
        return DecodeStatus::Ok;
    }
    int literalBits = 0;
    std::uint64_t length = 0;
    if (mode == kPlanesLzma) {
        if (!take(in, 1, head)) return DecodeStatus::Truncated;
        literalBits = static_cast<int>(head[0]);
        if (const DecodeStatus status = takeLength(in, length); status != DecodeStatus::Ok) return status;
    } else {
        if (!take(in, 4, head)) return DecodeStatus::Truncated;
        length = readU32(head.data());
    }
    if (!take(in, length, body)) return DecodeStatus::Truncated;
    const std::unique_ptr<std::byte[]> planes(new (std::nothrow) std::byte[size]);
    if (!planes) return DecodeStatus::BadLength;
    const std::span<std::byte> all(planes.get(), size);
    const DecodeStatus status = mode == kPlanesLzma ? decodeLzma(body, literalBits, all) : decompress(body, all);
    if (status == DecodeStatus::Ok) fromPlanes(planes.get(), width, symbols);
    return status;
}

} // namespace tessera::codec
