#include "volume/base/printable.h"

#include <algorithm>
#include <cstdint>

namespace tessera {

namespace {

/// A character of UTF-8 and its length in bytes; length 0 where the bytes are none.
struct Decoded {
    std::uint32_t code = 0;
    std::size_t length = 0;
};

Decoded characterAt(std::string_view text, std::size_t at) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const std::uint32_t lead = byte(at);
    if (lead < 0x80) return {lead, 1};
    const std::size_t length = lead >> 5 == 6 ? 2 : lead >> 4 == 14 ? 3 : lead >> 3 == 30 ? 4 : 0;
    if (length == 0 || at + length > text.size()) return {};
    std::uint32_t code = lead & (0x7Fu >> length);
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(at + i) & 0xC0) != 0x80) return {};
        code = code << 6 | (byte(at + i) & 0x3Fu);
    }
    constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
    return code < kLeast[length] || code > 0x10FFFF || surrogate ? Decoded{} : Decoded{code, length};
}

bool isHarmful(std::uint32_t code) {
    const auto within = [code](std::uint32_t first, std::uint32_t last) { return code >= first && code <= last; };
    return code < 0x20 || within(0x7F, 0x9F) || within(0x2028, 0x202E) || within(0x2066, 0x2069) ||
           within(0xFDD0, 0xFDEF) || code == 0xFEFF || (code & 0xFFFE) == 0xFFFE;
}

std::string cleaned(std::string_view text, bool keepsLines) {
    constexpr const char* kReplacement = "\xEF\xBF\xBD";
    std::string out;
    out.reserve(text.size());
    for (std::size_t at = 0; at < text.size();) {
        const char c = text[at];
        if (c == '\n' || c == '\t' || c == '\r') {
            // A carriage return takes a terminal back to the begin of the line.
            out += keepsLines && c != '\r' ? c : ' ';
            ++at;
            continue;
        }
        Decoded found = characterAt(text, at);
        const bool latin = found.length == 0;
        if (latin) found = {static_cast<unsigned char>(c), 1};
        if (isHarmful(found.code)) {
            out += kReplacement;
        } else if (latin) {
            out += static_cast<char>(0xC0 | found.code >> 6);
            out += static_cast<char>(0x80 | (found.code & 0x3F));
        } else {
            out += text.substr(at, found.length);
        }
        at += found.length;
    }
    return out;
}

} // namespace

std::string printable(std::string_view text) {
    return cleaned(text, false);
}

std::string printableLines(std::string_view text) {
    return cleaned(text, true);
}

} // namespace tessera
