#include "volume/import/stated_names.h"

#include "volume/base/error.h"
#include "volume/base/printable.h"
#include "volume/base/unit_conversion.h"
#include "volume/field/labels.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace tessera::volume {

namespace {

bool hasParameter(const DatasetInfo& info, const std::string& name) {
    return std::ranges::find(info.parameters, name, &Parameter::name) != info.parameters.end();
}

std::string lowerCased(std::string_view text) {
    std::string out(text);
    std::ranges::transform(out, out.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return out;
}

/// Lengths beyond those that convert to metres.
bool isLength(const std::string& unit) {
    static constexpr std::array<std::string_view, 34> kOthers = {"voxel",
                                                                 "voxels",
                                                                 "px",
                                                                 "pixel",
                                                                 "pixels",
                                                                 "cell",
                                                                 "cells",
                                                                 "sample",
                                                                 "samples",
                                                                 "lu",
                                                                 "1",
                                                                 "-",
                                                                 "\u00e5",
                                                                 "\u00c5",
                                                                 "\u212b",
                                                                 "a",
                                                                 "angstrom",
                                                                 "angstroms",
                                                                 "\u00e5ngstr\u00f6m",
                                                                 "bohr",
                                                                 "a0",
                                                                 "pc",
                                                                 "kpc",
                                                                 "mpc",
                                                                 "au",
                                                                 "ly",
                                                                 "yd",
                                                                 "yard",
                                                                 "mile",
                                                                 "mi",
                                                                 "nmi",
                                                                 "mil",
                                                                 "deg",
                                                                 "degrees"};
    return !lengthUnitNamed(unit).empty() || unitConversion(unit, "m") ||
           std::ranges::find(kOthers, lowerCased(unit)) != kOthers.end() ||
           lowerCased(unit).find("/h") != std::string::npos; // Mpc/h of cosmology
}

bool isTimeUnit(const std::string& unit) {
    static constexpr std::array<std::string_view, 39> kOthers = {
        "1",      "-",         "second",     "seconds", "minute", "minutes",    "mins",       "hr",
        "hrs",    "hour",      "hours",      "day",     "days",   "week",       "weeks",      "month",
        "months", "a",         "yr",         "year",    "years",  "ka",         "ma",         "ga",
        "kyr",    "myr",       "gyr",        "step",    "steps",  "cycle",      "cycles",     "frame",
        "frames", "iteration", "iterations", "deg",     "cad",    "revolution", "revolutions"};
    return unitConversion(unit, "s") || std::ranges::find(kOthers, lowerCased(unit)) != kOthers.end() ||
           unit.find(" since ") != std::string::npos;
}

} // namespace

std::string noSuchParameter(const std::string& name, const DatasetInfo& info) {
    constexpr std::size_t kMost = 12;
    std::string list;
    for (std::size_t p = 0; p < std::min(kMost, info.parameters.size()); ++p)
        list += (p > 0 ? ", " : "") + info.parameters[p].name;
    if (info.parameters.size() > kMost) list += ", ...";
    return "there is no parameter \"" + name + "\" (there are " + list + ")";
}

void checkStated(const DatasetInfo& info, const ImportOptions& options, const std::vector<AbsentRule>& absent,
                 const std::vector<PartsRule>& parts) {
    const auto want = [&](const std::string& name, const std::string& place) {
        if (name != "*" && !hasParameter(info, name)) throw Error(noSuchParameter(name, info), {}, place);
    };
    for (const auto& [name, unit] : options.units)
        if (std::ranges::find(info.quantities, name, &Quantity::name) == info.quantities.end())
            want(name, "--unit " + name + "=" + unit);
    for (const AbsentRule& rule : absent) {
        want(rule.parameter, "--absent " + toText(rule));
        if (!rule.label.empty()) want(rule.label, "--absent " + toText(rule));
    }
    for (const PartsRule& rule : parts) want(rule.parameter, "--parts " + rule.parameter + "=...");
    if (!options.lengthUnit.empty() && !isLength(options.lengthUnit))
        throw Error("\"" + options.lengthUnit + "\" is not a unit of length, such as m, mm or um", {}, "--length-unit");
    const bool counts = lowerCased(info.timeName) == DatasetInfo().timeName || lowerCased(info.timeName) == "t";
    if (!options.timeUnit.empty() && counts && !isTimeUnit(options.timeUnit))
        throw Error("\"" + options.timeUnit +
                        "\" is not a unit of time, such as s, min or h (of something else state its --time-name)",
                    {}, "--time-unit");
}

std::set<std::string> namesIn(const ImportOptions& options) {
    std::set<std::string> names(options.parameters.begin(), options.parameters.end());
    for (const auto& [name, unit] : options.units) names.insert(name);
    for (const std::string& rule : options.absent) {
        const AbsentRule parsed = parseAbsentRule(rule);
        names.insert({parsed.parameter, parsed.label});
    }
    for (const std::string& rule : options.parts) names.insert(parsePartsRule(rule).parameter);
    for (const std::string& rule : options.labels) names.insert(parseLabelRule(rule).parameter);
    for (const auto& [from, to] : options.rename) {
        names.insert(from);
        if (names.erase(to) > 0) names.insert(from);
    }
    return names;
}

void makePrintable(FileBlock& block) {
    for (std::string* const text :
         {&block.name, &block.lengthUnit, &block.timeUnit, &block.provenance, &block.timeName})
        *text = printable(*text);
    for (std::string& note : block.notes) note = printable(note);
    for (Array& array : block.arrays) {
        array.name = printable(array.name);
        array.unit = printable(array.unit);
        for (Label& label : array.labels) {
            label.name = printable(label.name);
            label.color = printable(label.color);
        }
    }
    for (Quantity& quantity : block.quantities) {
        quantity.name = printable(quantity.name);
        quantity.unit = printable(quantity.unit);
    }
}

} // namespace tessera::volume
