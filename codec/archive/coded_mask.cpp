#include "codec/archive/coded_mask.h"

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

} // namespace tessera::codec
