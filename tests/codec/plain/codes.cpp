#include "tests/codec/plain/codes.h"

#include <zstd.h>

namespace tessera::codec::plain {

void need(bool condition, const char* what) {
    if (!condition) throw std::runtime_error(what);
}

Octets unzstd(const Octets& packed, std::size_t size) {
    Octets out(size);
    need(ZSTD_decompress(out.data(), size, packed.data(), packed.size()) == size, "zstd");
    return out;
}

std::vector<std::uint32_t> stream(Reader& in, std::size_t count) {
    std::vector<std::uint32_t> symbols(count);
    if (count == 0) return symbols;
    const auto mode = in.number(1);
    if (mode == 0) return symbols;
    if (mode == 1) return std::vector<std::uint32_t>(count, in.u32());
    need(mode == 2 || mode == 3, "mode");
    const auto width = std::size_t(in.number(1));
    need(width >= 1 && width <= 4, "width");
    Octets planes;
    if (mode == 2) {
        planes = in.take(width * count);
    } else {
        const std::size_t length = in.u32();
        planes = unzstd(in.take(length), width * count);
    }
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t p = 0; p < width; ++p) symbols[i] |= std::uint32_t(planes[p * count + i]) << (8 * p);
    return symbols;
}

std::uint32_t unzigzag(std::uint32_t symbol) {
    return symbol % 2 == 0 ? symbol / 2 : ~(symbol / 2);
}

std::int64_t asSigned(std::uint32_t code) {
    return std::int32_t(code);
}

float floatOf(std::uint32_t code) {
    return std::bit_cast<float>(code < 0x80000000u ? code : ~(code ^ 0x80000000u));
}

std::uint32_t codeOf(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    return bits < 0x80000000u ? bits : ~bits ^ 0x80000000u;
}

} // namespace tessera::codec::plain
