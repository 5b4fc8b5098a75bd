#include "codec/bytes/bytes.h"

namespace tessera::codec {

void appendU32(Bytes& out, std::uint32_t value) {
    for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::byte>(value >> (8 * i)));
}

std::uint32_t readU32(const std::byte* at) {
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i) value |= static_cast<std::uint32_t>(at[i]) << (8 * i);
    return value;
}

void appendLength(Bytes& out, std::uint32_t length) {
    for (; length >= 128; length >>= 7) out.push_back(static_cast<std::byte>(length | 128u));
    out.push_back(static_cast<std::byte>(length));
}

DecodeStatus takeLength(std::span<const std::byte>& in, std::uint64_t& length) noexcept {
    constexpr int kMostShift = 28;
    length = 0;
    for (int shift = 0;; shift += 7) {
        if (in.empty()) return DecodeStatus::Truncated;
        if (shift > kMostShift) return DecodeStatus::BadLength;
        const auto byte = static_cast<std::uint64_t>(in[0]);
        in = in.subspan(1);
        length |= (byte & 127u) << shift;
        if (byte < 128) return DecodeStatus::Ok;
    }
}

} // namespace tessera::codec
