#include "codec/bytes/lzma.h"

#include <algorithm>
#include <lzma.h>
#include <new>

namespace tessera::codec {

namespace {

/// Preset dictionary of strings common in archives; part of the format.
constexpr char kDictionary[] =
    "\0\0\0\0\xc2\x94\xd3\x38\x05\x80\x06\x2d" // an empty segment
    "\0\0\0\0\0\0\xf0\x3f"                     // 1.0
    "\0\0\x80\xbf\0\0\0\0"                     // an unknown change
    R"("labels":[{"name":"","value":1},{"name":"magnitude","ranges":[[0.0,1.0]],"type":"int32","type":"int16",)"
    R"("type":"float32","unit":"m/s","type":"uint16","kind":"bcc","kind":"d4","lossless":false,"categorical":true,)"
    R"({"data":{"bounds":{"hi":[63.0,63.0,63.0],"lo":[0.0,0.0,0.0]},"lattice":{"kind":"cc","origin":[0.0,0.0,0.0],)"
    R"("size":[64,64,64],"spacing":[1.0,1.0,1.0]},"lengthUnit":"","name":"","parameters":[{"categorical":false,)"
    R"("components":1,"labels":[],"name":"value","ranges":[[0.0,255.0]],"type":"uint8","unit":""}],"provenance":"",)"
    R"("timeUnit":""},"grid":{"brickSize":64,"levels":5,"phase":0.0},"lossless":true,"maxError":0.0,)"
    R"("options":{"lattice":"cc"},"program":"tessera","source":{"kind":"cc","origin":[0.0,0.0,0.0],)"
    R"("size":[64,64,64],"spacing":[1.0,1.0,1.0]}})";

std::span<const std::byte> dictionary() {
    return std::as_bytes(std::span(kDictionary).first(sizeof kDictionary - 1));
}

const std::uint8_t* octets(const std::byte* at) {
    return reinterpret_cast<const std::uint8_t*>(at);
}

/// Encoder options for `size` bytes after the dictionary `before`.
lzma_options_lzma optionsFor(int literalBits, std::size_t size, std::span<const std::byte> before) {
    lzma_options_lzma options{};
    lzma_lzma_preset(&options, 9 | LZMA_PRESET_EXTREME);
    options.lc = static_cast<std::uint32_t>(literalBits);
    options.lp = options.pb = 0;
    options.nice_len = 273;
    options.depth = 1000;
    options.dict_size = static_cast<std::uint32_t>(
        std::clamp<std::size_t>(size + before.size(), LZMA_DICT_SIZE_MIN, std::size_t(1) << 30));
    options.preset_dict = before.empty() ? nullptr : octets(before.data());
    options.preset_dict_size = static_cast<std::uint32_t>(before.size());
    options.ext_flags = 0; // no end marker
    lzma_set_ext_size(options, size);
    return options;
}

Bytes encode(std::span<const std::byte> in, int literalBits, std::span<const std::byte> before) {
    lzma_options_lzma options = optionsFor(literalBits, in.size(), before);
    const lzma_filter filters[] = {{LZMA_FILTER_LZMA1EXT, &options}, {LZMA_VLI_UNKNOWN, nullptr}};
    Bytes out(in.size() + in.size() / 8 + 64);
    std::size_t size = 0;
    const lzma_ret result = lzma_raw_buffer_encode(filters, nullptr, octets(in.data()), in.size(),
                                                   reinterpret_cast<std::uint8_t*>(out.data()), &size, out.size());
    if (result != LZMA_OK) throw std::bad_alloc(); // the only possible failure with a buffer of this size
    out.resize(size);
    return out;
}

DecodeStatus decode(std::span<const std::byte> in, int literalBits, std::span<const std::byte> before,
                    std::span<std::byte> out) noexcept {
    lzma_options_lzma options = optionsFor(literalBits, out.size(), before);
    const lzma_filter filters[] = {{LZMA_FILTER_LZMA1EXT, &options}, {LZMA_VLI_UNKNOWN, nullptr}};
    std::size_t read = 0, written = 0;
    const lzma_ret result = lzma_raw_buffer_decode(filters, nullptr, octets(in.data()), &read, in.size(),
                                                   reinterpret_cast<std::uint8_t*>(out.data()), &written, out.size());
    if (result != LZMA_OK) return DecodeStatus::BadData;
    if (written != out.size()) return DecodeStatus::BadLength;
    return read == in.size() ? DecodeStatus::Ok : DecodeStatus::Trailing;
}

} // namespace

Bytes encodeLzma(std::span<const std::byte> in, int literalBits) {
    return encode(in, literalBits, {});
}

DecodeStatus decodeLzma(std::span<const std::byte> in, int literalBits, std::span<std::byte> out) noexcept {
    if (literalBits < 0 || literalBits > kMostLiteralBits) return DecodeStatus::BadMode;
    return decode(in, literalBits, {}, out);
}

Bytes encodeBlock(std::span<const std::byte> in, bool plain) {
    Bytes out;
    appendLength(out, static_cast<std::uint32_t>(in.size()));
    Bytes packed;
    if (in.size() <= kLongBlock && !plain) packed = encode(in, 0, dictionary());
    const bool shorter = !packed.empty() && packed.size() < in.size();
    const auto body = shorter ? std::span<const std::byte>(packed) : in;
    out.insert(out.end(), body.begin(), body.end());
    return out;
}

DecodeStatus decodeBlock(std::span<const std::byte> in, Bytes& out) {
    std::uint64_t length = 0;
    if (const DecodeStatus status = takeLength(in, length); status != DecodeStatus::Ok) return status;
    if (length == in.size()) {
        out.assign(in.begin(), in.end());
        return DecodeStatus::Ok;
    }
    if (length > kLongBlock) return DecodeStatus::BadLength;
    out.resize(length);
    return decode(in, 0, dictionary(), out);
}

} // namespace tessera::codec
