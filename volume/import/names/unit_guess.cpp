#include "volume/import/names/unit_guess.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <string_view>

namespace tessera::volume {

namespace {

struct Usual {
    std::string_view unit;
    int components; ///< 0 = any
    std::array<std::string_view, 10> names;
};

constexpr Usual kUsual[] = {
    {"K", 1, {"t", "temp", "temperature", "static temperature", "static-temperature", "t_gas", "tgas"}},
    {"Pa", 1, {"p", "pressure", "p_rgh", "static pressure", "static-pressure", "absolute-pressure", "pabs"}},
    {"m/s", 0, {"u", "velocity", "vel", "u_gas", "velocity magnitude", "velocity-magnitude"}},
    {"kg/m3", 1, {"rho", "density"}},
};

/// In small letters, without the phase or region behind a dot: "T.air" is T.
std::string plainName(const std::string& name) {
    std::string word = name.substr(0, name.find('.'));
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return word;
}

bool contradicted(std::string_view unit, const Field& field) {
    double least = std::numeric_limits<double>::max(), most = std::numeric_limits<double>::lowest();
    for (std::size_t i = 0; i < field.count(); ++i) {
        if (!field.present(i) || !std::isfinite(field.value(i))) continue;
        least = std::min(least, field.value(i));
        most = std::max(most, field.value(i));
    }
    if (least > most) return true; // no values
    if (unit == "K") return least < 100;
    if (unit == "Pa") return std::max(std::abs(least), std::abs(most)) < 1000;
    return unit == "kg/m3" && least < 0;
}

} // namespace

std::string usualUnit(const Parameter& parameter) {
    if (parameter.categorical || parameter.type != ScalarType::F32) return {};
    const std::string word = plainName(parameter.name);
    for (const Usual& usual : kUsual)
        if ((usual.components == 0 || usual.components == parameter.components) && !word.empty() &&
            std::find(usual.names.begin(), usual.names.end(), word) != usual.names.end())
            return std::string(usual.unit);
    return {};
}

void guessUnits(Dataset& dataset, bool readSamples) {
    for (std::size_t p = 0; p < dataset.info.parameters.size(); ++p) {
        Parameter& parameter = dataset.info.parameters[p];
        const std::string unit = parameter.unit.empty() ? usualUnit(parameter) : std::string();
        if (unit.empty()) continue;
        if (unit != "m/s" && (!readSamples || contradicted(unit, dataset.read(static_cast<int>(p), 0, 0)))) continue;
        parameter.unit = unit;
        parameter.unitGuessed = true;
    }
}

} // namespace tessera::volume
