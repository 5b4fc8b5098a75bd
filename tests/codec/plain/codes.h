#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <vector>

/// Bytes, streams of symbols (FORMAT.md 4.2) and codes of numbers (3).
namespace tessera::codec::plain {

using Octets = std::vector<std::uint8_t>;

/// A place of the lattice or a coefficient: nothing where absent.
using Cell = std::optional<std::uint32_t>;

/// Throws std::runtime_error unless the condition holds.
void need(bool condition, const char* what);

/// Reads little-endian numbers from the front.
struct Reader {
    const std::uint8_t* at;
    const std::uint8_t* end;

    explicit Reader(const Octets& bytes) : at(bytes.data()), end(bytes.data() + bytes.size()) {}
    std::uint64_t number(int bytes) {
        need(end - at >= bytes, "truncated");
        std::uint64_t value = 0;
        for (int i = 0; i < bytes; ++i) value |= std::uint64_t(*at++) << (8 * i);
        return value;
    }
    std::uint32_t u32() { return std::uint32_t(number(4)); }
    std::size_t length() { // 7 bits a byte
        std::uint64_t value = 0;
        for (int shift = 0;; shift += 7) {
            need(shift < 35, "length");
            const std::uint64_t byte = number(1);
            value |= (byte & 127) << shift;
            if (byte < 128) return std::size_t(value);
        }
    }
    double f64() { return std::bit_cast<double>(number(8)); }
    Octets take(std::size_t count) {
        need(std::size_t(end - at) >= count, "truncated");
        Octets bytes(at, at + count);
        at += count;
        return bytes;
    }
};

Octets unzstd(const Octets& packed, std::size_t size);
/// 1.5
Octets piece(const Octets& bytes);

/// 4.2
std::vector<std::uint32_t> stream(Reader& in, std::size_t count);

std::uint32_t unzigzag(std::uint32_t symbol);
std::int64_t asSigned(std::uint32_t code);
float floatOf(std::uint32_t code);
std::uint32_t codeOf(float value);

} // namespace tessera::codec::plain
