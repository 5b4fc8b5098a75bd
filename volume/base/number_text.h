#pragma once

#include <array>
#include <charconv>
#include <string>

namespace tessera {

/// The shortest text that reads back as the same number: "0.1", "1e-30", "nan".
inline std::string exactText(double value) {
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

} // namespace tessera
