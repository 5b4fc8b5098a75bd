#pragma once

#include "codec/bytes/bytes.h"
#include "volume/base/cpu.h"

#include <algorithm>
#include <array>
#include <span>

/// Binary range coding with adaptive probabilities, for data too small or too regular for tables of their own.
///
/// The coder is that of Martin (Range encoding, 1979) with 64 bits, refilled by 32, so that the test for it is nearly
/// always foreseen; a probability starts as the mean of the bits so far and becomes an exponential average. (FORMAT.md
/// "Adaptive bits".)
namespace tessera::codec {

/// The probability that a bit is 1, in units of 1/65536.
struct AdaptiveBit {
    std::uint16_t one = 32768;
    std::uint16_t seen = 0; ///< number of bits so far, at most kSlow

    static constexpr std::uint16_t kSlow = 23;
    /// log2 of the number of bits averaged after so many bits: about log2(seen + 2), at most 6.
    static constexpr std::array<std::uint8_t, kSlow + 1> kRates{2, 2, 3, 3, 3, 4, 4, 4, 4, 4, 4, 5,
                                                                5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 6};

    /// The share of the range, in units of 1/65536, so that neither symbol costs more than ten bits.
    TESSERA_INLINE std::uint32_t share() const {
        constexpr std::uint32_t kLeast = 64;
        return std::clamp<std::uint32_t>(one, kLeast, 65536 - kLeast);
    }
    TESSERA_INLINE void learn(std::uint32_t bit) {
        const int rate = kRates[seen];
        seen = static_cast<std::uint16_t>(seen + (seen < kSlow ? 1 : 0));
        one = static_cast<std::uint16_t>(bit != 0 ? one + ((65535 - one) >> rate) : one - (one >> rate));
    }
};

/// Zeros at the end that a writer leaves out, at most.
inline constexpr int kMostLeftOut = 8;

class RangeEncoder {
public:
    TESSERA_INLINE std::uint32_t bit(AdaptiveBit& about, std::uint32_t value) {
        bitOf(about.share(), value);
        about.learn(value);
        return value;
    }
    /// A bit that is 1 with a probability of `share` / 65536 (1..65535).
    TESSERA_INLINE std::uint32_t bitOf(std::uint32_t share, std::uint32_t value) {
        const std::uint64_t part = (range_ >> 16) * share;
        if (value != 0) {
            range_ = part;
        } else {
            add(part);
            range_ -= part;
        }
        if (range_ < kLeast) shift();
        return value;
    }
    /// Low bits of a number with equal probabilities, the highest first.
    std::uint32_t raw(std::uint32_t value, int bits) {
        for (int i = bits - 1; i >= 0; --i) {
            range_ >>= 1;
            if ((value >> i & 1u) != 0) add(range_);
            if (range_ < kLeast) shift();
        }
        return value;
    }
    bool goesOn() const { return true; }
    /// The bytes, without some zeros at the end.
    Bytes finish() {
        // Of the numbers in the range, one with as many zeros at the end as possible.
        for (int zeros = 64; zeros-- > 0;) {
            const std::uint64_t mask = (std::uint64_t(1) << zeros) - 1, up = (0 - low_) & mask;
            if (up >= range_) continue;
            add(up);
            break;
        }
        for (int i = 0; i < 2; ++i) shift();
        for (int i = 0; i < kMostLeftOut && !out_.empty() && out_.back() == std::byte{0}; ++i) out_.pop_back();
        return std::move(out_);
    }

private:
    static constexpr std::uint64_t kLeast = std::uint64_t(1) << 32;
    TESSERA_INLINE void add(std::uint64_t part) {
        low_ += part;
        if (low_ < part) carry();
    }
    void carry() {
        for (std::size_t i = out_.size(); i-- > 0;) {
            out_[i] = static_cast<std::byte>(static_cast<std::uint8_t>(out_[i]) + 1);
            if (out_[i] != std::byte{0}) break;
        }
    }
    void shift() {
        for (int i = 0; i < 4; ++i, low_ <<= 8) out_.push_back(static_cast<std::byte>(low_ >> 56));
        range_ <<= 32;
    }
    std::uint64_t low_ = 0, range_ = ~std::uint64_t(0);
    Bytes out_;
};

/// Reads what RangeEncoder wrote; bytes beyond the end are zeros.
class RangeDecoder {
public:
    explicit RangeDecoder(std::span<const std::byte> in) : next_(in.data()), end_(in.data() + in.size()) {
        for (int i = 0; i < 2; ++i) code_ = code_ << 32 | take();
    }
    TESSERA_INLINE std::uint32_t bit(AdaptiveBit& about, std::uint32_t = 0) {
        const std::uint32_t value = bitOf(about.share());
        about.learn(value);
        return value;
    }
    TESSERA_INLINE std::uint32_t bitOf(std::uint32_t share, std::uint32_t = 0) {
        const std::uint64_t part = (range_ >> 16) * share;
        const std::uint32_t value = code_ < part ? 1 : 0;
        range_ = value != 0 ? part : range_ - part;
        code_ -= value != 0 ? 0 : part;
        if (range_ < kLeast) refill();
        return value;
    }
    TESSERA_INLINE std::uint32_t raw(std::uint32_t, int bits) {
        std::uint32_t value = 0;
        for (int i = 0; i < bits; ++i) {
            range_ >>= 1;
            const std::uint32_t one = code_ >= range_ ? 1 : 0;
            code_ -= one != 0 ? range_ : 0;
            value = value << 1 | one;
            if (range_ < kLeast) refill();
        }
        return value;
    }
    /// Whether what was read so far can be what a writer wrote.
    bool goesOn() const { return beyond_ <= kMostLeftOut; }
    /// Ok if all bytes were read, and no more than a writer may have left out.
    DecodeStatus end() const {
        if (next_ != end_) return DecodeStatus::Trailing;
        return beyond_ > kMostLeftOut ? DecodeStatus::Truncated : DecodeStatus::Ok;
    }

private:
    static constexpr std::uint64_t kLeast = std::uint64_t(1) << 32;
    std::uint32_t take() {
        if (end_ - next_ >= 4) {
            const std::uint32_t word = readU32(next_);
            next_ += 4;
            return word << 24 | (word & 0xff00u) << 8 | (word >> 8 & 0xff00u) | word >> 24;
        }
        std::uint32_t word = 0;
        for (int i = 0; i < 4; ++i) {
            word <<= 8;
            next_ != end_ ? void(word |= static_cast<std::uint32_t>(*next_++)) : void(++beyond_);
        }
        return word;
    }
    void refill() {
        range_ <<= 32;
        code_ = code_ << 32 | take();
    }
    const std::byte *next_, *end_;
    std::uint64_t beyond_ = 0, range_ = ~std::uint64_t(0), code_ = 0;
};

/// A number of any size: n bits set, one that is not, the n - 1 low bits of the number + 1 of n + 1 bits. The first
/// of these is adaptive as well.
struct AdaptiveNumber {
    static constexpr int kMost = 31;
    std::array<AdaptiveBit, kMost + 1> longer, next;

    /// Codes `value` (below 2^31), or reads one.
    template <class Coder> std::uint32_t code(Coder& coder, std::uint32_t value) {
        ++value;
        int bits = 0;
        while (bits < kMost && coder.bit(longer[std::size_t(bits)], value >> bits > 1 ? 1 : 0) != 0) ++bits;
        if (bits == 0) return 0;
        std::uint32_t got = 2 | coder.bit(next[std::size_t(bits)], value >> (bits - 1) & 1u);
        got = got << (bits - 1) | coder.raw(value & ((1u << (bits - 1)) - 1), bits - 1);
        return got - 1;
    }
};

} // namespace tessera::codec
