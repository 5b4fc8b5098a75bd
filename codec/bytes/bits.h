#pragma once

#include "codec/bytes/entropy.h"

#include <cstdint>
#include <span>

/// LSB-first bit stream, zero-padded to whole bytes.
namespace tessera::codec {

class BitWriter {
public:
    void put(std::uint32_t value, int bits) {
        for (int i = 0; i < bits; ++i, ++at_) {
            if (at_ % 8 == 0) bytes.push_back(std::byte{0});
            if ((value >> i & 1u) != 0) bytes.back() |= static_cast<std::byte>(1u << (at_ % 8));
        }
    }
    Bytes bytes;

private:
    std::size_t at_ = 0;
};

class BitReader {
public:
    explicit BitReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
    std::uint32_t get(int bits) {
        std::uint32_t value = 0;
        for (int i = 0; i < bits; ++i, ++at_) {
            if (at_ / 8 >= bytes_.size()) {
                failed = true;
                return 0;
            }
            value |= (static_cast<std::uint32_t>(bytes_[at_ / 8]) >> (at_ % 8) & 1u) << i;
        }
        return value;
    }
    std::size_t bytesRead() const { return (at_ + 7) / 8; }
    /// Whether all bytes have been read and the padding is zero.
    bool atEnd() {
        const auto left = static_cast<int>(8 * bytesRead() - at_);
        return get(left) == 0 && !failed && at_ == 8 * bytes_.size();
    }
    bool failed = false;

private:
    std::span<const std::byte> bytes_;
    std::size_t at_ = 0;
};

} // namespace tessera::codec
