#include "volume/field/labels.h"

#include "volume/base/error.h"
#include "volume/base/trimmed.h"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace tessera::volume {

namespace {

constexpr std::size_t kColorLength = 7; // "#rrggbb"

bool isColor(std::string_view text) {
    return text.size() == kColorLength && text[0] == '#' && std::all_of(text.begin() + 1, text.end(), [](char c) {
               return std::isxdigit(static_cast<unsigned char>(c));
           });
}

} // namespace

Label labelOf(int value, std::string_view text) {
    text = trimmed(text);
    if (text.size() < kColorLength || !isColor(text.substr(text.size() - kColorLength)))
        return {value, std::string(text)};
    return {value, std::string(trimmed(text.substr(0, text.size() - kColorLength))),
            std::string(text.substr(text.size() - kColorLength))};
}

std::string labelText(const Label& label) {
    return label.name + label.color;
}

LabelRule parseLabelRule(std::string_view text) {
    const std::string place = "--label " + std::string(text);
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos || colon == 0)
        throw Error("needs PARAMETER:VALUE=NAME#COLOUR,..., e.g. region:0=cathode,1=anode#e07b39", {}, place);
    LabelRule rule{std::string(trimmed(text.substr(0, colon))), {}};
    std::string_view rest = text.substr(colon + 1);
    while (true) {
        const std::size_t comma = rest.find(',');
        const std::string_view item = trimmed(rest.substr(0, comma));
        const std::size_t equals = item.find('=');
        int value = 0;
        const std::string_view number = trimmed(item.substr(0, std::min(equals, item.size())));
        const auto parsed = std::from_chars(number.data(), number.data() + number.size(), value);
        if (equals == std::string_view::npos || parsed.ec != std::errc() ||
            parsed.ptr != number.data() + number.size() || number.empty())
            throw Error("\"" + std::string(item) + "\" is not VALUE=NAME with a whole number", {}, place);
        Label label = labelOf(value, item.substr(equals + 1));
        const std::size_t mark = label.name.find('#');
        if (label.color.empty() && mark != std::string::npos)
            throw Error("\"" + label.name.substr(mark) + "\" is not a colour: six digits 0-9, a-f after the #", {},
                        place);
        if (label.name.empty() && label.color.empty())
            throw Error("value " + std::to_string(value) + " has neither a name nor a colour", {}, place);
        if (std::ranges::any_of(rule.labels, [&](const Label& other) { return other.value == value; }))
            throw Error("value " + std::to_string(value) + " is present twice", {}, place);
        rule.labels.push_back(std::move(label));
        if (comma == std::string_view::npos) break;
        rest = rest.substr(comma + 1);
    }
    std::ranges::sort(rule.labels, {}, &Label::value);
    return rule;
}

std::string toText(const LabelRule& rule) {
    std::string text;
    for (const Label& label : rule.labels) {
        std::string name = label.name;
        std::erase_if(name, [](char c) { return c == ',' || c == '=' || c == '#'; });
        name = trimmed(name);
        if (!name.empty() || isColor(label.color))
            text +=
                (text.empty() ? rule.parameter + ":" : ",") + std::to_string(label.value) + "=" + name + label.color;
    }
    return text;
}

void applyLabels(DatasetInfo& info, const std::vector<LabelRule>& rules, bool samplesKnown) {
    for (const LabelRule& rule : rules) {
        const auto found = std::ranges::find(info.parameters, rule.parameter, &Parameter::name);
        if (found == info.parameters.end())
            throw Error("there is no parameter \"" + rule.parameter + "\"", {}, "--label " + toText(rule));
        if (!found->categorical && samplesKnown)
            throw Error("\"" + rule.parameter + "\" is not a label: a label has at most 64 values, all whole numbers",
                        {}, "--label " + toText(rule));
        for (const Label& stated : rule.labels) {
            auto known = std::ranges::find(found->labels, stated.value, &Label::value);
            if (known == found->labels.end())
                known = found->labels.insert(found->labels.end(),
                                             {stated.value, found->name + " " + std::to_string(stated.value)});
            if (!stated.name.empty()) known->name = stated.name;
            if (!stated.color.empty()) known->color = stated.color;
        }
        std::ranges::sort(found->labels, {}, &Label::value);
    }
}

} // namespace tessera::volume
