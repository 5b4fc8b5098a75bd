#include "app/importer/readers/dimension_units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string>

namespace tessera::importer {

namespace {

using Exponents = std::array<double, 7>;

/// "m2" for an exponent of 2.
std::string power(std::string_view base, double exponent) {
    std::string out(base);
    if (exponent == 1) return out;
    if (exponent == std::floor(exponent)) return out + std::to_string(int(exponent));
    char text[16];
    std::snprintf(text, sizeof text, "^%g", exponent);
    return out + text;
}

std::string composed(const Exponents& e) {
    static constexpr std::string_view kBases[] = {"kg", "m", "s", "K", "mol", "A", "cd"};
    std::string above, below;
    int denominators = 0;
    for (const std::size_t i : {4u, 0u, 5u, 6u, 1u, 2u, 3u}) { // mol and A first, as is usual
        if (e[i] > 0) above += (above.empty() ? "" : " ") + power(kBases[i], e[i]);
        if (e[i] >= 0) continue;
        below += (below.empty() ? "" : " ") + power(kBases[i], -e[i]);
        ++denominators;
    }
    if (below.empty()) return above;
    return (above.empty() ? "1" : above) + "/" + (denominators > 1 ? "(" + below + ")" : below);
}

/// Exponents of what is spelled "kg", "m^-1" or "Pa"; nothing for other words.
std::optional<Exponents> exponentsOfWord(std::string_view word) {
    static const struct {
        const char* name;
        Exponents exponents;
    } kWords[] = {{"kg", {1}},
                  {"m", {0, 1}},
                  {"s", {0, 0, 1}},
                  {"K", {0, 0, 0, 1}},
                  {"mol", {0, 0, 0, 0, 1}},
                  {"kmol", {0, 0, 0, 0, 1}},
                  {"A", {0, 0, 0, 0, 0, 1}},
                  {"Cd", {0, 0, 0, 0, 0, 0, 1}},
                  {"cd", {0, 0, 0, 0, 0, 0, 1}},
                  {"N", {1, 1, -2}},
                  {"Pa", {1, -1, -2}},
                  {"J", {1, 2, -2}},
                  {"W", {1, 2, -3}}};
    const std::size_t caret = word.find('^');
    double power = 1;
    if (caret != std::string_view::npos) {
        const std::string number(word.substr(caret + 1));
        char* end = nullptr;
        power = std::strtod(number.c_str(), &end);
        if (number.empty() || *end != 0) return std::nullopt;
    }
    for (const auto& [name, exponents] : kWords) {
        if (word.substr(0, caret) != name) continue;
        Exponents out = exponents;
        for (double& exponent : out) exponent *= power;
        return out;
    }
    return std::nullopt;
}

/// "[0 2 -1 0 0 0 0]" or "[m^2 s^-1]", with a name before it or not; nothing where it is something else.
std::optional<Exponents> exponentsOf(std::string_view text) {
    const std::size_t open = text.find('['), close = text.find(']');
    if (open == std::string_view::npos || close == std::string_view::npos || close < open) return std::nullopt;
    std::istringstream words{std::string(text.substr(open + 1, close - open - 1))};
    Exponents out{};
    std::size_t numbers = 0, names = 0;
    for (std::string word; words >> word;) {
        char* end = nullptr;
        const double number = std::strtod(word.c_str(), &end);
        if (*end == 0 && numbers < out.size()) {
            out[numbers++] = number;
            continue;
        }
        const std::optional<Exponents> named = exponentsOfWord(word);
        if (!named) return std::nullopt;
        ++names;
        for (std::size_t i = 0; i < out.size(); ++i) out[i] += (*named)[i];
    }
    // Five numbers are enough: current and light may be left out.
    if (names > 0 ? numbers > 0 : numbers != 0 && numbers < 5) return std::nullopt;
    return out;
}

} // namespace

std::optional<std::string> unitOfDimensions(std::string_view brackets) {
    const std::optional<Exponents> stated = exponentsOf(brackets);
    if (!stated) return std::nullopt;
    const Exponents& e = *stated;
    static const struct {
        const char* unit;
        Exponents exponents;
    } kNamed[] = {{"Pa", {1, -1, -2}},
                  {"Pa s", {1, -1, -1}},
                  {"J", {1, 2, -2}},
                  {"N", {1, 1, -2}},
                  {"W", {1, 2, -3}},
                  {"W/m2", {1, 0, -3}},
                  {"W/m3", {1, -1, -3}},
                  {"W/(m K)", {1, 1, -3, -1}},
                  {"J/(kg K)", {0, 2, -2, -1}},
                  {"V", {1, 2, -3, 0, 0, -1}},
                  {"S/m", {-1, -3, 3, 0, 0, 2}},
                  {"J/(m3 K)", {1, -1, -2, -1}},
                  {"J/(mol K)", {1, 2, -2, -1, -1}}};
    for (const auto& [unit, exponents] : kNamed)
        if (exponents == e) return unit;
    return composed(e);
}

} // namespace tessera::importer
