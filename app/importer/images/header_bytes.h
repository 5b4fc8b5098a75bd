#pragma once

#include "app/importer/readers/source.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

namespace tessera::importer {

/// Numbers at fixed places of a binary header, in either byte order.
struct HeaderBytes {
    std::string bytes;
    bool swap = false; ///< another order than this machine's

    template <class T> T at(std::size_t place) const {
        if (place + sizeof(T) > bytes.size()) throw std::runtime_error("ends within its header: truncated");
        char one[sizeof(T)];
        std::memcpy(one, bytes.data() + place, sizeof(T));
        if (swap) std::reverse(one, one + sizeof(T));
        return std::bit_cast<T>(one);
    }
    /// A float32 as the decimal number it was made from, as far as that can be told.
    double real(std::size_t place) const { return meantTime(double(at<float>(place))); }
    /// A text of so many bytes at most, up to its first zero.
    std::string text(std::size_t place, std::size_t most) const {
        const std::string_view part = std::string_view(bytes).substr(std::min(place, bytes.size()), most);
        return std::string(part.substr(0, part.find('\0')));
    }
};

} // namespace tessera::importer
