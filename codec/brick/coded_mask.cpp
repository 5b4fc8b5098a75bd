#include "codec/brick/coded_mask.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace tessera::codec {

CodedMaskBrick encodeMask(std::span<const std::uint8_t> flags, Compressor& compressor) {
    CodedMaskBrick coded;
    Bytes bits((flags.size() + 7) / 8);
    for (std::size_t i = 0; i < flags.size(); ++i)
        if (flags[i] != 0) {
            bits[i / 8] |= static_cast<std::byte>(1u << (i % 8));
            ++coded.present;
        }
    if (coded.present == 0 || coded.present == flags.size()) return coded;
    const Bytes packed = compressor.compress(bits);
    coded.bytes.push_back(packed.empty() ? std::byte{0} : std::byte{1});
    const Bytes& body = packed.empty() ? bits : packed;
    coded.bytes.insert(coded.bytes.end(), body.begin(), body.end());
    return coded;
}

std::size_t takeBits(std::span<const std::byte> bits, std::span<std::uint8_t> flags) {
    std::size_t set = 0;
    for (std::size_t i = 0; i < flags.size(); i += 8) {
        const std::size_t count = std::min<std::size_t>(flags.size() - i, 8);
        const std::uint64_t byte = static_cast<std::uint64_t>(bits[i / 8]) & (0xffu >> (8 - count));
        set += std::size_t(std::popcount(byte));
        // Bit k to byte k of a word: a copy of all bits to each byte, there one of them, moved to the lowest place.
        const std::uint64_t single = byte * 0x0101010101010101u & 0x8040201008040201u,
                            spread = (single + 0x7f7f7f7f7f7f7f7fu) >> 7 & 0x0101010101010101u;
        if (count == 8 && std::endian::native == std::endian::little)
            std::memcpy(flags.data() + i, &spread, 8);
        else
            for (std::size_t k = 0; k < count; ++k) flags[i + k] = static_cast<std::uint8_t>(spread >> (8 * k) & 1u);
    }
    return set;
}

} // namespace tessera::codec
