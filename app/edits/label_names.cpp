#include "app/edits/label_names.h"

#include "app/session/label_colors.h"
#include "volume/field/labels.h"

#include <algorithm>

namespace tessera::app {

namespace {

/// True for a brush of this label value alone.
bool holdsRegion(const vis::Brush& brush, const std::string& label, std::optional<int> value) {
    const auto* region = std::get_if<vis::RangeRegion>(&brush.region);
    if (!region || region->intervals.size() != 1) return false;
    const vis::BrushInterval& interval = region->intervals[0];
    return interval.channel == label && interval.hi - interval.lo < 1 &&
           (!value || (interval.lo <= *value && *value <= interval.hi));
}

} // namespace

std::vector<volume::Label> statedLabels(const Session& session, const volume::Parameter& parameter) {
    volume::DatasetInfo info;
    info.parameters = {parameter};
    for (const std::string& text : session.data.import.labels) {
        const volume::LabelRule rule = volume::parseLabelRule(text);
        if (rule.parameter == parameter.name) volume::applyLabels(info, {rule});
    }
    return info.parameters[0].labels;
}

void stateLabel(Session& session, const volume::Parameter& parameter, const volume::Label& label) {
    volume::LabelRule rule{parameter.name, {label}};
    const std::string one = volume::toText(rule);
    if (one.empty()) return;
    rule.labels = volume::parseLabelRule(one).labels;
    std::vector<std::string>& rules = session.data.import.labels;
    for (const std::string& text : rules) {
        const volume::LabelRule before = volume::parseLabelRule(text);
        if (before.parameter != parameter.name) continue;
        for (const volume::Label& known : before.labels) {
            const auto same = std::ranges::find(rule.labels, known.value, &volume::Label::value);
            if (same == rule.labels.end()) {
                rule.labels.push_back(known);
                continue;
            }
            if (same->name.empty()) same->name = known.name;
            if (same->color.empty()) same->color = known.color;
        }
    }
    std::ranges::sort(rule.labels, {}, &volume::Label::value);
    std::erase_if(rules,
                  [&](const std::string& text) { return volume::parseLabelRule(text).parameter == parameter.name; });
    rules.push_back(volume::toText(rule));
    volume::Parameter named = parameter;
    named.labels = statedLabels(session, parameter);
    vis::TransferFunction& function = session.transfer[parameter.name];
    function.colormap = "labels";
    function.colors = labelStops(named, parameter.ranges.empty() ? Range{} : parameter.ranges[0]);
    for (vis::Brush& brush : session.selection.brushes)
        if (holdsRegion(brush, parameter.name, label.value)) {
            brush.name = rule.labels.empty()
                             ? brush.name
                             : std::ranges::find(named.labels, label.value, &volume::Label::value)->name;
            brush.color = labelColor(named, label.value);
        }
}

void unstateLabelName(Session& session, const volume::Parameter& parameter, int value) {
    std::vector<std::string>& rules = session.data.import.labels;
    for (std::string& text : rules) {
        volume::LabelRule rule = volume::parseLabelRule(text);
        if (rule.parameter != parameter.name) continue;
        std::erase_if(rule.labels, [&](volume::Label& label) {
            if (label.value == value) label.name.clear();
            return label.name.empty() && label.color.empty();
        });
        text = rule.labels.empty() ? std::string() : volume::toText(rule);
    }
    std::erase(rules, std::string());
    // The data's own name is known again after reopening.
    for (vis::Brush& brush : session.selection.brushes)
        if (holdsRegion(brush, parameter.name, value)) brush.name = parameter.name + " " + std::to_string(value);
}

bool regionBrushed(const Session& session, const volume::Parameter& parameter, int value) {
    return std::ranges::any_of(session.selection.brushes, [&](const vis::Brush& brush) {
        return brush.enabled && !brush.inverted && holdsRegion(brush, parameter.name, value);
    });
}

void toggleRegionBrush(Session& session, const volume::Parameter& parameter, int value) {
    std::vector<vis::Brush>& brushes = session.selection.brushes;
    if (std::erase_if(brushes, [&](const vis::Brush& brush) { return holdsRegion(brush, parameter.name, value); }) > 0)
        return;
    volume::Parameter named = parameter;
    named.labels = statedLabels(session, parameter);
    vis::Brush brush = vis::rangeBrush({{parameter.name, value - 0.25, value + 0.25, 0}});
    brush.name = parameter.name + " " + std::to_string(value);
    for (const volume::Label& label : named.labels)
        if (label.value == value && !label.name.empty()) brush.name = label.name;
    brush.color = labelColor(named, value);
    const bool others = std::ranges::any_of(brushes, [&](const vis::Brush& each) {
        return each.enabled && holdsRegion(each, parameter.name, std::nullopt);
    });
    if (others) brush.combine = vis::BrushCombine::Or;
    brushes.push_back(std::move(brush));
}

} // namespace tessera::app
