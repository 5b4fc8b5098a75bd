#include "app/views/worth/worth_data.h"

#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/values/place_text.h"
#include "app/values/selection_text.h"
#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace tessera::app {

namespace {

using volume::Finding;
using volume::FindingKind;

constexpr double kFineNumbers = 16e6, kCoarseNumbers = 4e5; ///< samples times parameters
constexpr std::array kKindWords{"dependence", "contrast", "non-linear", "outliers", "jump",
                                "change",     "differs",  "around",     "region",   "time"};

std::string twoDigits(double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", number);
    return text;
}

/// A chance in few characters: "0.013", "3e-09".
std::string chanceText(double p) {
    if (p < 1e-99) return "below 1e-99";
    char text[32];
    std::snprintf(text, sizeof text, p > 0 && p < 1e-3 ? "%.0e" : "%.2g", p);
    return text;
}

std::string worthValue(const volume::DatasetInfo& info, int channel, double value) {
    const Range range = info.channelRange(info.channel(channel));
    return formatQuantity(value, info.channel(channel).unit, (range.hi - range.lo) / 1000);
}

std::string worthRegion(const volume::DatasetInfo& info, const Finding& finding) {
    const auto label = volume::labelChannel(info);
    return finding.region && label ? volume::labelName(volume::parameterOf(info, *label), *finding.region)
                                   : std::string();
}

std::string inRegion(const volume::DatasetInfo& info, const Finding& finding) {
    const std::string region = worthRegion(info, finding);
    return region.empty() ? "" : " in " + region;
}

/// " at x 1.1, y 0.65, z 12 mm".
std::string worthPlace(const volume::DatasetInfo& info, glm::dvec3 place) {
    return " at " + pointText(info, place, 0.01);
}

/// Whether all steps are of one length: then the greatest change is the fastest.
bool stepsAreEven(const std::vector<double>& times) {
    double least = 1e300, most = 0;
    for (std::size_t t = 1; t < times.size(); ++t) {
        least = std::min(least, times[t] - times[t - 1]);
        most = std::max(most, times[t] - times[t - 1]);
    }
    return most <= 1.01 * least;
}

std::string changeSentence(const Finding& of, const volume::DatasetInfo& info) {
    const auto when = [&](int time) { return timeValueText(info, info.times[std::size_t(time)]); };
    const std::string name = info.channel(of.x).name,
                      by = (of.number > 0 ? "+" : "") + worthValue(info, of.x, of.number);
    const std::string most = "between " + when(of.time - 1) + " and " + when(of.time);
    const bool even = stepsAreEven(info.times);
    if (of.last - of.first == 1)
        return name + (even ? " changes most " : " changes more and faster than usual ") + most + ": " + by +
               worthPlace(info, of.place) + inRegion(info, of);
    return name + " changes from " + when(of.first) + " to " + when(of.last) + (even ? ", most " : ", fastest ") +
           most + " (" + by + "); it begins" + worthPlace(info, of.place) + inRegion(info, of);
}

} // namespace

WorthQuestion worthQuestion(const Session& session, const volume::DatasetInfo& info, const WorthSeeingView& view,
                            const std::vector<int>& channels) {
    WorthQuestion out;
    out.list = view.list;
    out.channels = channels;
    out.label = volume::labelChannel(info).value_or(-1);
    if (view.list != WorthList::When) out.time = volume::timesAround(info.times, session.time).nearest();
    out.selected = view.selected && view.list != WorthList::WhatElse;
    out.rate = double(view.falseDiscoveries);
    out.most = view.most;
    if (out.selected || view.list == WorthList::WhatElse) {
        out.brushes = brushedQuery(session, info, {}, {}, 1, false);
        out.brushes.time = {}; // the time is the question's own
        out.selection = selectionName(session);
    }
    return out;
}

int firstWorthLevel(const volume::BrickGrid& grid, std::size_t channels) {
    const int coarse = volume::worthLevel(grid, channels, kCoarseNumbers);
    return coarse > volume::worthLevel(grid, channels, kFineNumbers) ? coarse : 0;
}

volume::WorthFindings readWorth(const std::shared_ptr<const volume::BrickSource>& source, const WorthQuestion& question,
                                int level, const Progress& progress) {
    volume::WorthQuery query;
    query.search = static_cast<volume::WorthSearch>(question.list);
    query.channels = question.channels;
    query.label = question.label;
    query.time = question.time;
    query.selected = question.selected;
    query.rate = question.rate;
    query.most = static_cast<std::size_t>(question.most);
    query.level = level > 0 ? level : volume::worthLevel(source->grid(), question.channels.size(), kFineNumbers);
    if (question.brushes.selection.active()) {
        query.doiChannels = question.brushes.channels;
        query.doi = samplesQuery(question.brushes, source->info(), 0).doi;
    }
    return volume::findWorthSeeing(*source, query, progress);
}

std::string sentenceOf(const Finding& of, const WorthQuestion& question, const volume::DatasetInfo& info) {
    const auto name = [&](int channel) { return info.channel(channel).name; };
    const std::string pair = of.y >= 0 ? name(of.x) + " and " + name(of.y) + ": " : std::string();
    switch (of.kind) {
    case FindingKind::Dependence:
        return pair + "r = " + twoDigits(of.number) + inRegion(info, of);
    case FindingKind::Contrast:
        return pair + "r = " + twoDigits(of.number) + inRegion(info, of) + ", " + twoDigits(of.other) + " elsewhere";
    case FindingKind::Nonlinear:
        return pair + "dependent, but not along a line" + inRegion(info, of) + " (distance correlation " +
               twoDigits(of.number) + ", r = " + twoDigits(of.other) + ")";
    case FindingKind::Outliers:
        return name(of.x) + ": " + worthValue(info, of.x, of.number) + worthPlace(info, of.place) + inRegion(info, of) +
               ", far from the median " + worthValue(info, of.x, of.other);
    case FindingKind::Jump:
        return name(of.x) + " jumps to " + worthValue(info, of.x, of.number) + " beside " +
               worthValue(info, of.x, of.other) + worthPlace(info, of.place) + inRegion(info, of);
    case FindingKind::Change:
        return changeSentence(of, info);
    case FindingKind::Differs:
        return name(of.x) + ": " + worthValue(info, of.x, of.number) + " in " + question.selection + ", " +
               worthValue(info, of.x, of.other) + " in the rest (means)";
    case FindingKind::Around:
        return name(of.x) + ": " + worthValue(info, of.x, of.number) + " in " + question.selection + ", " +
               worthValue(info, of.x, of.other) + " right around it (means)";
    case FindingKind::Region:
        return formatShare(of.number) + " of " + question.selection + " lies in " + worthRegion(info, of) + ", " +
               formatShare(of.other) + " of the rest";
    case FindingKind::Time:
        return question.selection + ": most at " + timeText(info, info.times[std::size_t(of.time)]) + ", " +
               formatShare(of.number) + " of all samples; " + formatShare(of.other) + " at other times";
    }
    return {};
}

std::string evidenceOf(const Finding& of) {
    const std::string chance = chanceText(of.p);
    std::string text = (of.p < 1e-99 ? "p " : "p = ") + chance + ", false discovery rate " + chanceText(of.q) + "; " +
                       formatCount(of.samples) + " samples";
    switch (of.kind) {
    case FindingKind::Outliers:
    case FindingKind::Jump:
        return text + " in one place";
    case FindingKind::Around:
        return text + ", against " + formatCount(std::floor(of.effective)) + " other places";
    case FindingKind::Time:
        return text + ", " + formatCount(of.effective) + " times";
    default:
        return text + ", worth " + formatNumber(of.effective, 0.1) + " independent ones";
    }
}

std::string numberOf(const Finding& of, const volume::DatasetInfo& info) {
    switch (of.kind) {
    case FindingKind::Dependence:
    case FindingKind::Contrast:
        return "r = " + twoDigits(of.number);
    case FindingKind::Nonlinear:
        return "dCor " + twoDigits(of.number);
    case FindingKind::Region:
    case FindingKind::Time:
        return formatShare(of.number);
    default:
        return worthValue(info, of.x, of.number);
    }
}

Table worthTable(const volume::WorthFindings& answer, const WorthQuestion& question, const volume::DatasetInfo& info) {
    Table table;
    const std::vector<Finding>& rows = answer.found;
    std::vector<double> ranks;
    for (std::size_t i = 0; i < rows.size(); ++i) ranks.push_back(double(i + 1));
    table.columns.push_back({.name = "rank", .head = "Rank", .kind = NumberKind::Count, .numbers = ranks});
    const auto kind = [](const Finding& of) { return std::string(kKindWords[std::size_t(of.kind)]); };
    addColumn(table, rows, {.name = "kind", .head = "Kind"}, kind);
    addColumn(table, rows, {.name = "finding", .head = "Finding"},
              [&](const Finding& of) { return sentenceOf(of, question, info); });
    addColumn(table, rows, {.name = "number", .head = "Number"}, [](const Finding& of) { return of.number; });
    addColumn(table, rows, {.name = "p"}, [](const Finding& of) { return of.p; });
    addColumn(table, rows, {.name = "q"}, [](const Finding& of) { return of.q; });
    addColumn(table, rows, {.name = "samples", .head = "Samples", .kind = NumberKind::Count},
              [](const Finding& of) { return of.samples; });
    addColumn(table, rows, {.name = "independent samples", .head = "Independent"},
              [](const Finding& of) { return of.effective; });
    for (const std::size_t c : {std::size_t(4), std::size_t(5)})
        for (std::size_t i = 0; i < rows.size(); ++i)
            table.columns[c].words[i] = chanceText(table.columns[c].numbers[i]);
    for (std::size_t i = 0; i < rows.size(); ++i) table.columns[3].words[i] = numberOf(rows[i], info);
    for (std::size_t i = 0; i < rows.size(); ++i) table.columns[7].words[i] = formatNumber(rows[i].effective, 0.1);
    table.names = 3;
    table.notes = {"worth seeing: " + searchedText(answer, question, info),
                   "q: false discovery rate (Benjamini, Hochberg 1995) at which a row is a finding",
                   "samples beside each other are alike: independent samples by their correlation lengths (Clifford, "
                   "Richardson, Hemon 1989)"};
    return table;
}

std::string searchedText(const volume::WorthFindings& answer, const WorthQuestion& question,
                         const volume::DatasetInfo& info) {
    std::string text;
    if (info.times.size() > 1)
        text = question.list == WorthList::When ? formatCount(double(info.times.size())) + " times, "
                                                : "at " + timeText(info, info.times[std::size_t(question.time)]) + ", ";
    if (question.selected) text += "in " + question.selection + ", ";
    text += formatCount(answer.samples) + " samples";
    if (answer.level > 0) text += " (level " + std::to_string(answer.level) + ")";
    if (answer.regionsLeft > 0)
        text += ", without the " + formatCount(double(answer.regionsLeft)) + " smallest regions";
    return text + ", " + formatCount(double(answer.tests)) + " tests, false discovery rate " +
           formatShare(question.rate);
}

std::string searchedOrigin(const std::string& origin, const WorthQuestion& question, const volume::DatasetInfo& info,
                           const std::string& axis) {
    if (info.times.size() < 2 || question.list == WorthList::When) return origin;
    const double time = info.times[std::size_t(question.time)];
    const std::string quantities = quantitiesText(info, time, axis);
    return origin + ", at " + timeText(info, time) + (quantities.empty() ? "" : " (" + quantities + ")");
}

} // namespace tessera::app
