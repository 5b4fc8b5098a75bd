#pragma once

#include <cstdint>

namespace tessera::codec {

/// Result of decoding untrusted bytes. Decoders never throw because of their contents and never read beyond them.
enum class [[nodiscard]] DecodeStatus : std::uint8_t{
    Ok,
    Truncated, ///< fewer bytes than stated
    Trailing,  ///< bytes after the end
    BadMode,   ///< unknown coding
    BadLength, ///< impossible length
    BadData,   ///< rejected by the entropy decoder
};

constexpr const char* reason(DecodeStatus status) {
    switch (status) {
    case DecodeStatus::Ok:
        return "ok";
    case DecodeStatus::Truncated:
        return "coded brick is truncated";
    case DecodeStatus::Trailing:
        return "coded brick has trailing bytes";
    case DecodeStatus::BadMode:
        return "coded brick uses an unknown coding";
    case DecodeStatus::BadLength:
        return "coded brick states an invalid length";
    case DecodeStatus::BadData:
        break;
    }
    return "coded brick is damaged";
}

} // namespace tessera::codec
