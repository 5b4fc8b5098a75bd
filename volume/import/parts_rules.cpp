#include "volume/import/parts_rules.h"

#include "volume/base/error.h"

#include <charconv>
#include <optional>
#include <set>

namespace tessera::volume {

namespace {

int parameterNamed(const DatasetInfo& info, const std::string& name, const std::string& place) {
    for (std::size_t i = 0; i < info.parameters.size(); ++i)
        if (info.parameters[i].name == name) return int(i);
    throw Error("there is no parameter \"" + name + "\"", {}, place);
}

std::optional<int> wholeNumber(std::string_view text) {
    int value = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
    if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size()) return std::nullopt;
    return value;
}

std::vector<std::string> split(std::string_view text, char by) {
    std::vector<std::string> out;
    while (true) {
        const std::size_t end = std::min(text.find(by), text.size());
        out.emplace_back(text.substr(0, end));
        if (end == text.size()) return out;
        text.remove_prefix(end + 1);
    }
}

std::string placeOf(const PartsRule& rule) {
    return "--parts " + rule.parameter + "=...";
}

Parts partsOfRule(const DatasetInfo& info, const PartsRule& rule) {
    if (rule.groups.size() < 2 && rule.label.empty()) return {};
    const Parameter& label = info.parameters[std::size_t(parameterNamed(info, rule.label, placeOf(rule)))];
    if (!label.categorical) throw Error("\"" + rule.label + "\" is not a label", {}, placeOf(rule));
    Parts parts{rule.label, {}};
    std::set<int> seen;
    for (const auto& group : rule.groups) {
        parts.regions.emplace_back();
        for (const std::string& text : group) {
            std::optional<int> value = wholeNumber(text);
            bool known = label.labels.empty();
            for (const Label& entry : label.labels)
                if ((value && entry.value == *value) || (!value && entry.name == text)) {
                    value = entry.value;
                    known = true;
                }
            if (!value || !known) throw Error("\"" + text + "\" is not a value of " + rule.label, {}, placeOf(rule));
            if (!seen.insert(*value).second) throw Error("\"" + text + "\" is stated twice", {}, placeOf(rule));
            parts.regions.back().push_back(*value);
        }
    }
    return parts.count() > 1 ? parts : Parts{};
}

} // namespace

PartsRule parsePartsRule(std::string_view text) {
    const std::string place = "--parts " + std::string(text);
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos || equals == 0 || equals + 1 == text.size())
        throw Error("needs NAME=LABEL:VALUES|VALUES, NAME=joined or NAME=jumps", {}, place);
    PartsRule rule;
    rule.parameter = std::string(text.substr(0, equals));
    const std::string_view right = text.substr(equals + 1);
    if (right == "joined") return rule;
    if (right == "jumps") {
        rule.jumps = true;
        return rule;
    }
    const std::size_t colon = right.find(':');
    if (colon == std::string_view::npos || colon == 0)
        throw Error("needs NAME=LABEL:VALUES|VALUES, NAME=joined or NAME=jumps", {}, place);
    rule.label = std::string(right.substr(0, colon));
    for (const std::string& group : split(right.substr(colon + 1), '|')) {
        rule.groups.push_back(split(group, ','));
        for (const std::string& value : rule.groups.back())
            if (value.empty()) throw Error("an empty value", {}, place);
    }
    return rule;
}

namespace {

/// "1,2 | 3" with " | " between the parts.
std::string groupsText(const Parts& parts, const char* between) {
    std::string text;
    for (std::size_t p = 0; p < parts.regions.size(); ++p) {
        if (p > 0) text += between;
        for (std::size_t i = 0; i < parts.regions[p].size(); ++i)
            text += (i > 0 ? "," : "") + std::to_string(parts.regions[p][i]);
    }
    return text;
}

} // namespace

std::string partsText(const Parameter& parameter) {
    const Parts& parts = parameter.parts;
    if (parts.count() < 2) return {};
    return std::to_string(parts.count()) + " parts by " +
           (parts.label == jumpsLabel(parameter.name) ? "jumps of the data" : parts.label) + ": " +
           groupsText(parts, " | ");
}

std::string partsRule(const Parameter& parameter) {
    const Parts& parts = parameter.parts;
    return parameter.name + "=" + (parts.count() < 2 ? "joined" : parts.label + ":" + groupsText(parts, "|"));
}

void setParts(DatasetInfo& info, const std::vector<PartsRule>& rules) {
    for (const PartsRule& rule : rules) {
        if (rule.jumps) continue;
        const Parts parts = partsOfRule(info, rule);
        if (rule.parameter != "*") {
            Parameter& parameter = info.parameters[std::size_t(parameterNamed(info, rule.parameter, placeOf(rule)))];
            if (parameter.categorical) throw Error("a label has no parts", {}, placeOf(rule));
            parameter.parts = parts;
            continue;
        }
        for (Parameter& parameter : info.parameters)
            if (!parameter.categorical) parameter.parts = parts;
    }
}

std::string jumpsLabel(const std::string& parameter) {
    return parameter + " jumps";
}

} // namespace tessera::volume
