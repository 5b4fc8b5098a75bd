#pragma once

#include "tests/codec/plain/codes.h"

#include <algorithm>
#include <utility>

/// Adaptive bits (FORMAT.md 4.9).
namespace tessera::codec::plain {

/// A bit's probability and the number of bits seen.
struct Chance {
    std::uint32_t p = 32768;
    int n = 0;
};

class Bits {
public:
    explicit Bits(Octets bytes) : bytes_(std::move(bytes)) {
        for (int i = 0; i < 8; ++i) code_ = code_ * 256 + take();
    }
    bool bit(Chance& chance) {
        const bool one = bitOf(std::clamp(chance.p, 64u, 65472u));
        const int rate = chance.n < 2 ? 2 : chance.n < 5 ? 3 : chance.n < 11 ? 4 : chance.n < 23 ? 5 : 6;
        chance.p = one ? chance.p + (65535 - chance.p) / (1u << rate) : chance.p - chance.p / (1u << rate);
        chance.n = std::min(chance.n + 1, 23);
        return one;
    }
    /// A bit that is 1 with probability p / 65536.
    bool bitOf(std::uint64_t p) {
        const std::uint64_t part = range_ / 65536 * p;
        const bool one = code_ < part;
        if (!one) code_ -= part;
        range_ = one ? part : range_ - part;
        fill();
        return one;
    }
    std::uint64_t raw(int count) {
        std::uint64_t value = 0;
        for (; count > 0; --count) {
            range_ /= 2;
            const bool one = code_ >= range_;
            if (one) code_ -= range_;
            value = 2 * value + (one ? 1 : 0);
            fill();
        }
        return value;
    }
    void finish() const {
        need(at_ >= bytes_.size(), "trailing bytes");
        need(at_ <= bytes_.size() + 8, "truncated");
    }

private:
    std::uint64_t take() {
        const std::size_t at = at_++;
        return at < bytes_.size() ? bytes_[at] : 0u;
    }
    void fill() {
        if (range_ >= std::uint64_t(1) << 32) return;
        range_ <<= 32;
        for (int i = 0; i < 4; ++i) code_ = code_ * 256 + take();
    }
    Octets bytes_;
    std::size_t at_ = 0;
    std::uint64_t range_ = ~std::uint64_t(0), code_ = 0;
};

} // namespace tessera::codec::plain
