#include "bench/bench.h"

#include <cstdio>

namespace tessera::app {

std::string decimals(double value, int digits) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

} // namespace tessera::app
