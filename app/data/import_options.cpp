#include "app/data/import_options.h"

#include "app/data/format.h"
#include "app/data/spacing_text.h"
#include "app/described/describe_cli.h"
#include "codec/container/json_text.h"
#include "codec/remote/consent.h"
#include "volume/base/byte_text.h"
#include "volume/base/error.h"
#include "volume/field/axes_json.h"
#include "volume/import/find_parts.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace tessera::app {

namespace {

/// "a=b" -> {a, b}; throws what CLI11 turns into a usage error.
std::pair<std::string, std::string> splitPair(const std::string& option, const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
        throw CLI::ValidationError(option, "needs NAME=VALUE, not \"" + text + "\"");
    return {text.substr(0, equals), text.substr(equals + 1)};
}

glm::ivec3 parseGrid(const std::string& text) {
    int values[3] = {};
    int used = 0;
    const int found = std::sscanf(text.c_str(), "%dx%dx%d%n", &values[0], &values[1], &values[2], &used);
    if (found != 3 || static_cast<std::size_t>(used) != text.size())
        throw CLI::ValidationError("--grid", "needs planes, even, or XxYxZ, not \"" + text + "\"");
    for (const int value : values)
        if (value < 1 || value > 4096) throw CLI::ValidationError("--grid", "each size must be 1..4096");
    return {values[0], values[1], values[2]};
}

/// A choice by its name, or the size of an even grid.
void chooseGrid(const std::string& text, volume::ImportOptions& options) {
    const auto named = std::ranges::find(volume::kGridChoiceNames, text);
    if (named == std::end(volume::kGridChoiceNames))
        options.gridSize = parseGrid(text);
    else
        options.grid = volume::GridChoice(named - std::begin(volume::kGridChoiceNames));
}

} // namespace

std::vector<std::string> importArguments(const volume::ImportOptions& options) {
    std::vector<std::string> out;
    const auto add = [&out](const char* option, const std::string& value) {
        if (!value.empty()) out.insert(out.end(), {option, value});
    };
    add("--raw", options.raw);
    if (options.gridSize.x > 0)
        add("--grid", std::to_string(options.gridSize.x) + "x" + std::to_string(options.gridSize.y) + "x" +
                          std::to_string(options.gridSize.z));
    else if (options.grid != volume::GridChoice::Planes)
        add("--grid", std::string(volume::kGridChoiceNames[std::size_t(options.grid)]));
    for (const std::string& rule : options.absent) add("--absent", rule);
    if (!options.autoAbsent) out.push_back("--no-auto-absent");
    for (const std::string& rule : options.labels) add("--label", rule);
    for (const std::string& rule : options.parts) add("--parts", rule);
    add("--time-name", options.timeName);
    add("--time-unit", options.timeUnit);
    add("--over-time", options.overTime);
    for (const auto& [from, to] : options.rename) add("--rename", from + "=" + to);
    for (const auto& [parameter, unit] : options.units) add("--unit", parameter + "=" + unit);
    add("--length-unit", options.lengthUnit);
    std::string times, parameters;
    for (const double time : options.times) times += (times.empty() ? "" : ",") + jsonText(time);
    for (const std::string& parameter : options.parameters) parameters += (parameters.empty() ? "" : ",") + parameter;
    if (options.allowOutside) out.push_back("--allow-outside");
    add("--times", times);
    add("--parameters", parameters);
    return out;
}

void addRemoteOptions(CLI::App& command, codec::RemoteOptions& options) {
    addDescribed(command, options, "remote.");
}

void addAllowRemoteOption(CLI::App& command) {
    command.add_flag_callback("--allow-remote", codec::allowAllMachines,
                              "Ask any machine that a session or a picture names for its data; without it, only those "
                              "from which you have opened something yourself");
}

void addImportOptions(CLI::App& command, volume::ImportOptions& options) {
    command
        .add_option("--raw", options.raw,
                    "Layout of a raw file without sidecar: "
                    "dims=XxYxZ,type=u8|i16|u16|i32|f32|f64,spacing=AxBxC,origin=AxBxC,components=N,times=N,big-endian,"
                    "skip=BYTES; or the name of a sidecar (.json) that states it")
        ->group("Import");
    command
        .add_option_function<std::string>(
            "--grid", [&options](const std::string& text) { chooseGrid(text, options); },
            "Samples of meshes: planes (between those where cells begin and end, so that layers keep their thickness; "
            "the default), even (at even distances, as many as cells), or an even grid XxYxZ; of grids with uneven "
            "spacing, planes keeps them as they are")
        ->group("Import");
    command
        .add_option("--absent", options.absent,
                    "Samples without a value: O2=region:0,3 (where the label region is 0 or 3), O2=0, O2=nan, O2=none "
                    "(all have one); may be repeated")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->group("Import");
    command
        .add_flag_function(
            "--no-auto-absent", [&options](std::int64_t) { options.autoAbsent = false; },
            "Do not treat samples as absent where a parameter is 0 in a whole region")
        ->group("Import");
    command
        .add_flag("--allow-outside", options.allowOutside,
                  "Let files name others that lie neither beside them nor in folders below; only for files of people "
                  "you trust, since they could show any file that you may read")
        ->group("Import");
    const auto repeated = [&command](const char* name, std::vector<std::string>& rules, const char* help) {
        command.add_option(name, rules, help)
            ->expected(1)
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
            ->group("Import");
    };
    repeated("--label", options.labels,
             "Names and colours of label values: region:0=cathode,1=anode#e07b39; may be repeated");
    repeated("--parts", options.parts,
             "Regions between which a parameter is never interpolated: p=region:1|3, T=joined (none), or p=jumps "
             "(found where its values jump); default: found with the help of a label; may be repeated");
    command.add_option("--time-name", options.timeName, "What the times of a series count, e.g. \"operating point\"")
        ->group("Import");
    command.add_option("--time-unit", options.timeUnit, "Unit of the times of a series")->group("Import");
    command.add_option("--over-time", options.overTime, "CSV file with quantities over time: voltage, current, ...")
        ->group("Import");
    command
        .add_option_function<std::vector<std::string>>(
            "--rename",
            [&options](const std::vector<std::string>& pairs) {
                for (const std::string& pair : pairs) options.rename.insert(splitPair("--rename", pair));
            },
            "Rename an array of the file: O2.air=O2; may be repeated")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->group("Import");
    command
        .add_option_function<std::vector<std::string>>(
            "--unit",
            [&options](const std::vector<std::string>& pairs) {
                for (const std::string& pair : pairs) options.units.insert(splitPair("--unit", pair));
            },
            "Unit of a parameter: O2=mol/m3; may be repeated")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->group("Import");
    command
        .add_option("--length-unit", options.lengthUnit,
                    "Unit of positions (default: that which the file states, else none)")
        ->group("Import");
    command.add_option("--times", options.times, "Times of the series, separated by commas")
        ->delimiter(',')
        ->group("Import");
    command.add_option("--parameters", options.parameters, "Only these parameters, separated by commas")
        ->delimiter(',')
        ->group("Import");
}

nlohmann::json quantitiesJson(const volume::DatasetInfo& info) {
    nlohmann::json out = nlohmann::json::array();
    for (const volume::Quantity& quantity : info.quantities) {
        nlohmann::json values = nlohmann::json::array();
        for (const double value : quantity.values)
            values.push_back(std::isfinite(value) ? nlohmann::json(value) : nlohmann::json());
        out.push_back({{"name", quantity.name}, {"unit", quantity.unit}, {"values", std::move(values)}});
    }
    return out;
}

std::string quantityLines(const volume::DatasetInfo& info) {
    std::string out;
    for (const volume::Quantity& quantity : info.quantities) {
        Range range{INFINITY, -INFINITY};
        std::size_t known = 0;
        for (const double value : quantity.values) {
            if (!std::isfinite(value)) continue;
            ++known;
            range = {std::min(range.lo, value), std::max(range.hi, value)};
        }
        out += "  over time  " + quantity.name + ": ";
        out += known == 0 ? "not known at any time" : numberText(range.lo) + " .. " + numberText(range.hi);
        if (!quantity.unit.empty()) out += " " + quantity.unit;
        if (known > 0 && known < quantity.values.size())
            out += ", known at " + std::to_string(known) + " of " + std::to_string(quantity.values.size()) + " times";
        out += "\n";
    }
    return out;
}

std::string timesText(const volume::DatasetInfo& info) {
    std::string out = std::to_string(info.times.size());
    if (info.times.size() == 1) return out;
    return out + ": " + (info.timeName == "time" ? "" : info.timeName + " ") + numberText(info.times.front()) + " .. " +
           numberText(info.times.back()) + (info.timeUnit.empty() ? "" : " " + info.timeUnit);
}

std::string describePreview(const volume::ImportPreview& preview) {
    const volume::DatasetInfo& info = preview.info;
    const volume::Lattice& lattice = info.lattice;
    const glm::dvec3 extent = info.bounds.size();
    const std::string unit = info.lengthUnit.empty() ? "" : " " + info.lengthUnit;
    std::string out = info.name + " (" + preview.format + ")\n";
    out += "  samples    " + std::to_string(lattice.size.x) + " x " + std::to_string(lattice.size.y) + " x " +
           std::to_string(lattice.size.z) + "\n";
    out += "  spacing    " +
           (lattice.isEven() ? numberText(lattice.spacing.x) + " x " + numberText(lattice.spacing.y) + " x " +
                                   numberText(lattice.spacing.z) + unit
                             : spacingText(info)) +
           "\n";
    out += "  extent     " + numberText(extent.x) + " x " + numberText(extent.y) + " x " + numberText(extent.z) + unit +
           "\n";
    out += "  times      " + timesText(info);
    out += "\n" + quantityLines(info);
    if (out.ends_with('\n')) out.pop_back();
    out += "\n  size       " + textOfBytes(preview.bytes) + "\n  parameters " + std::to_string(info.parameters.size()) +
           "\n";
    for (const volume::Parameter& parameter : info.parameters) {
        out += "    " + parameter.name +
               (parameter.unit.empty() ? "" : " [" + parameter.unit + (parameter.unitGuessed ? " (guessed)]" : "]")) +
               " " + std::string(volume::name(parameter.type));
        if (parameter.components > 1) out += ", vector of " + std::to_string(parameter.components);
        if (parameter.categorical) out += ", label";
        if (parameter.parts.count() > 1) out += ", " + volume::partsText(parameter);
        out += "\n";
    }
    for (const std::string& note : preview.notes) out += "  " + note + "\n";
    return out;
}

std::string describePreviewJson(const volume::ImportPreview& preview) {
    using json = nlohmann::ordered_json;
    const volume::DatasetInfo& info = preview.info;
    const auto triple = [](const auto& v) { return json::array({v.x, v.y, v.z}); };
    json out;
    out["kind"] = "data";
    out["name"] = info.name;
    out["format"] = preview.format;
    out["dims"] = triple(info.lattice.size);
    out["spacing"] = triple(info.lattice.spacing);
    out["origin"] = triple(info.lattice.origin);
    if (!info.lattice.isEven()) out["axes"] = json::parse(volume::axesJson(info.lattice.axes));
    out["lengthUnit"] = info.lengthUnit;
    out["times"] = info.times;
    out["timeName"] = info.timeName;
    out["timeUnit"] = info.timeUnit;
    out["quantities"] = quantitiesJson(info);
    out["bytes"] = preview.bytes;
    out["parameters"] = json::array();
    for (const volume::Parameter& parameter : info.parameters) {
        json entry;
        entry["name"] = parameter.name;
        entry["unit"] = parameter.unit;
        if (parameter.unitGuessed) entry["unitGuessed"] = true;
        entry["type"] = volume::name(parameter.type);
        entry["components"] = parameter.components;
        entry["label"] = parameter.categorical;
        entry["parts"] = {{"label", parameter.parts.label}, {"regions", parameter.parts.regions}};
        out["parameters"].push_back(std::move(entry));
    }
    out["notes"] = preview.notes;
    return jsonText(out, 1) + "\n";
}

} // namespace tessera::app
