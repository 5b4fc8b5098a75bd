#pragma once

#include <cstdio>
#include <iterator>
#include <string>

namespace tessera {

/// A number of bytes with three digits, for people: "12.3 MB".
inline std::string textOfBytes(double bytes) {
    static constexpr const char* units[] = {"B", "kB", "MB", "GB", "TB"};
    std::size_t unit = 0;
    while (bytes >= 999.5 && unit + 1 < std::size(units)) { // what would be rounded to 1000
        bytes /= 1000;
        ++unit;
    }
    char text[32];
    std::snprintf(text, sizeof text, unit == 0 || bytes >= 999.5 ? "%.0f %s" : "%.3g %s", bytes, units[unit]);
    return text;
}

} // namespace tessera
