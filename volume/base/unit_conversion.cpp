#include "volume/base/unit_conversion.h"

#include "volume/base/unit_product.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

namespace tessera::volume {

namespace {

enum Base { Metre, Kilogram, Second, Kelvin, Mole, Ampere, Candela, kBases };
using BasePowers = std::array<int, kBases>;

struct Known {
    std::string_view name;
    double factor; ///< to the product of base units
    BasePowers powers;
    bool prefixed = false; ///< takes k, m, u, ...
};

constexpr double kDegree = 0.017453292519943295;
constexpr BasePowers kNumber{}, kLength{1}, kTime{0, 0, 1}, kTemperature{0, 0, 0, 1}, kPressure{-1, 1, -2}, kVolume{3},
    kMass{0, 1}, kForce{1, 1, -2}, kEnergy{2, 1, -2}, kPower{2, 1, -3}, kVoltage{2, 1, -3, 0, 0, -1},
    kCurrent{0, 0, 0, 0, 0, 1}, kCharge{0, 0, 1, 0, 0, 1}, kResistance{2, 1, -3, 0, 0, -2},
    kConductance{-2, -1, 3, 0, 0, 2};

constexpr Known kKnown[] = {
    {"m", 1, kLength, true},
    {"micron", 1e-6, kLength},
    {"in", 0.0254, kLength},
    {"ft", 0.3048, kLength},
    {"angstrom", 1e-10, kLength},
    {"\u00c5", 1e-10, kLength},
    {"bohr", 5.29177210903e-11, kLength},
    {"g", 1e-3, kMass, true},
    {"t", 1e3, kMass},
    {"s", 1, kTime, true},
    {"sec", 1, kTime},
    {"min", 60, kTime},
    {"h", 3600, kTime},
    {"d", 86400, kTime},
    {"K", 1, kTemperature, true},
    {"mol", 1, {0, 0, 0, 0, 1}, true},
    {"A", 1, kCurrent, true},
    {"cd", 1, {0, 0, 0, 0, 0, 0, 1}},
    {"l", 1e-3, kVolume, true},
    {"L", 1e-3, kVolume, true},
    {"N", 1, kForce, true},
    {"Pa", 1, kPressure, true},
    {"bar", 1e5, kPressure, true},
    {"atm", 101325, kPressure},
    {"Torr", 101325.0 / 760, kPressure},
    {"mmHg", 133.322387415, kPressure},
    {"psi", 6894.757293168, kPressure},
    {"J", 1, kEnergy, true},
    {"cal", 4.184, kEnergy, true},
    {"Wh", 3600, kEnergy, true},
    {"eV", 1.602176634e-19, kEnergy, true},
    {"W", 1, kPower, true},
    {"V", 1, kVoltage, true},
    {"C", 1, kCharge, true},
    {"Ohm", 1, kResistance, true},
    {"ohm", 1, kResistance, true},
    {"S", 1, kConductance, true},
    {"Hz", 1, {0, 0, -1}, true},
    {"P", 0.1, {-1, 1, -1}, true}, // poise
    {"rad", 1, kNumber},
    {"deg", kDegree, kNumber},
    {"%", 1e-2, kNumber},
    {"ppm", 1e-6, kNumber},
};

constexpr std::pair<std::string_view, double> kPrefixes[] = {
    {"n", 1e-9}, {"p", 1e-12}, {"u", 1e-6}, {"\u00b5", 1e-6}, {"\u03bc", 1e-6}, {"m", 1e-3},
    {"c", 1e-2}, {"d", 1e-1},  {"h", 1e2},  {"k", 1e3},       {"M", 1e6},       {"G", 1e9}};

/// Temperature scales with another zero: kelvin = factor * value + offset.
struct Scale {
    std::string_view name;
    UnitConversion toKelvin;
};
constexpr Scale kScales[] = {{"degC", {1, 273.15}},
                             {"\u00b0C", {1, 273.15}},
                             {"\u2103", {1, 273.15}},
                             {"deg C", {1, 273.15}},
                             {"Celsius", {1, 273.15}},
                             {"celsius", {1, 273.15}},
                             {"C", {1, 273.15}},
                             {"degF", {5.0 / 9, 459.67 * 5 / 9}},
                             {"\u00b0F", {5.0 / 9, 459.67 * 5 / 9}},
                             {"deg F", {5.0 / 9, 459.67 * 5 / 9}},
                             {"K", {1, 0}},
                             {"Kelvin", {1, 0}},
                             {"kelvin", {1, 0}},
                             {"degK", {1, 0}}};

std::optional<UnitConversion> toKelvin(const std::string& unit) {
    const auto* found = std::ranges::find(kScales, unit, &Scale::name);
    return found == std::end(kScales) ? std::nullopt : std::optional(found->toKelvin);
}

/// A unit as a factor times powers of base units and of unknown names.
struct Read {
    double factor = 1;
    BasePowers powers{};
    std::map<std::string, int> others;
};

void multiplyBase(Read& read, const std::string& name, int power) {
    const auto* known = std::ranges::find(kKnown, name, &Known::name);
    double factor = 1;
    if (known == std::end(kKnown))
        for (const auto& [prefix, size] : kPrefixes) {
            if (!name.starts_with(prefix)) continue;
            known = std::ranges::find_if(
                kKnown, [&](const Known& one) { return one.prefixed && one.name == name.substr(prefix.size()); });
            factor = size;
            if (known != std::end(kKnown)) break;
        }
    if (known == std::end(kKnown)) {
        read.others[name] += power;
        return;
    }
    read.factor *= std::pow(factor * known->factor, power);
    for (std::size_t base = 0; base < kBases; ++base) read.powers[base] += power * known->powers[base];
}

} // namespace

std::optional<UnitConversion> unitConversion(const std::string& from, const std::string& to) {
    if (from == to) return UnitConversion{};
    if (const auto own = toKelvin(from), wanted = toKelvin(to); own && wanted)
        return UnitConversion{own->factor / wanted->factor, (own->offset - wanted->offset) / wanted->factor};
    Read sides[2];
    for (const int side : {0, 1}) {
        const auto powers = unitPowers(side == 0 ? from : to);
        if (!powers) return std::nullopt;
        for (const auto& [name, power] : *powers) multiplyBase(sides[side], name, power);
        std::erase_if(sides[side].others, [](const auto& other) { return other.second == 0; });
    }
    if (sides[0].powers != sides[1].powers || sides[0].others != sides[1].others) return std::nullopt;
    return UnitConversion{sides[0].factor / sides[1].factor, 0};
}

std::string lengthUnitNamed(std::string_view word) {
    static constexpr std::pair<std::string_view, std::string_view> kWords[] = {
        {"meter", "m"},   {"millimeter", "mm"},     {"centimeter", "cm"},  {"kilometer", "km"}, {"micrometer", "um"},
        {"micron", "um"}, {"nanometer", "nm"},      {"foot", "ft"},        {"feet", "ft"},      {"inch", "in"},
        {"inches", "in"}, {"angstrom", "angstrom"}, {"\u00c5", "angstrom"}};
    std::string plain;
    for (const char c : word) plain += char(std::tolower(static_cast<unsigned char>(c)));
    if (plain.ends_with("metre") || plain.ends_with("metres")) plain.replace(plain.rfind("tre"), 3, "ter");
    if (plain.ends_with("s") && !plain.ends_with("es")) plain.pop_back();
    for (const auto& [known, unit] : kWords)
        if (plain == known) return std::string(unit);
    const std::string unit(word);
    const auto metres = unitConversion(unit, "m");
    return metres && unit.find_first_of("/ *^0123456789") == std::string::npos ? unit : std::string();
}

std::string lengthUnitOfAxes(std::span<const std::string> axes) {
    std::string all;
    for (const std::string& axis : axes) {
        const std::string unit = lengthUnitNamed(axis);
        if (unit.empty() || (!all.empty() && unit != all)) return {};
        all = unit;
    }
    return all;
}

} // namespace tessera::volume
