#include "app/views/curves/section_data.h"

#include "app/pane/plot.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/values/selection_text.h"
#include "volume/base/error.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr SectionMeasure kMeasures[] = {SectionMeasure::Mean,     SectionMeasure::Least, SectionMeasure::Most,
                                        SectionMeasure::Integral, SectionMeasure::Flux,  SectionMeasure::Flow,
                                        SectionMeasure::Area};

/// The region that a curve is of, whatever else tells it from others.
std::vector<CurveLook> regionLooks(const volume::DatasetInfo& info, const SectionCurves& curves, bool mixed) {
    SectionCurvesQuery asked = curves.query;
    if (mixed) asked.selection = {};
    return curveLooks(info, asked);
}

/// Whether some states are of a selection and others are not of the same one.
bool mixedSelections(const std::vector<SectionCurves>& states) {
    return std::ranges::any_of(
        states, [&](const SectionCurves& state) { return !(state.query.selection == states.front().query.selection); });
}

bool mixedTimes(const std::vector<SectionCurves>& states) {
    return std::ranges::any_of(states,
                               [&](const SectionCurves& each) { return each.query.time != states.front().query.time; });
}

bool hasValues(const SectionCurves& curves, std::size_t region, std::size_t channel) {
    return std::ranges::any_of(curves.sections.values[region][channel],
                               [](const auto& plane) { return plane.area > 0; });
}

} // namespace

std::vector<std::string> sectionStateNames(const volume::DatasetInfo& info, const std::vector<SectionCurves>& states) {
    std::vector<double> times;
    for (const SectionCurves& state : states) times.push_back(volume::timeAt(info.times, state.query.time));
    std::vector<std::string> names(states.size());
    if (mixedTimes(states)) names = stateNames(info, times);
    for (std::size_t i = 0; i < states.size() && mixedSelections(states); ++i)
        names[i] += (names[i].empty() ? "" : ", ") +
                    (states[i].query.selection.active() ? states[i].query.selection.name : "everything");
    return names;
}

Table sectionTable(const volume::DatasetInfo& info, const std::vector<SectionCurves>& states) {
    const SectionCurvesQuery& asked = states.front().query;
    const std::string& velocity = states.front().velocity;
    const bool mixed = mixedSelections(states);
    const std::vector<std::string> names = sectionStateNames(info, states);
    struct Row {
        std::size_t state, region, channel, plane;
    };
    std::vector<Row> rows;
    std::vector<std::vector<CurveLook>> looks; // by state
    for (std::size_t s = 0; s < states.size(); ++s) {
        looks.push_back(regionLooks(info, states[s], mixed));
        for (std::size_t r = 0; r < looks[s].size(); ++r)
            for (std::size_t c = 0; c < asked.channels.size(); ++c)
                for (std::size_t p = 0; p < states[s].sections.place.size() && hasValues(states[s], r, c); ++p)
                    rows.push_back({s, r, c, p});
    }
    const auto channelAt = [&](const Row& row) { return info.channel(asked.channels[row.channel]); };
    const auto unitAt = [&](const Row& row, SectionMeasure measure) {
        return measureUnit(info, asked.channels[row.channel], velocity, measure);
    };
    const auto valuesAt = [&](const Row& row) {
        return states[row.state].sections.values[row.region][row.channel][row.plane];
    };
    Table table;
    if (info.times.size() > 1)
        addColumn(table, rows, {.name = info.timeName, .unit = info.timeUnit},
                  [&](const Row& row) { return volume::timeAt(info.times, states[row.state].query.time); });
    if (states.size() > 1) addColumn(table, rows, {.name = "state"}, [&](const Row& row) { return names[row.state]; });
    const LengthUnit along = placeUnit(info, asked);
    addColumn(table, rows, {.name = placeTitle(info, asked), .unit = along.name},
              [&](const Row& row) { return states[row.state].sections.place[row.plane] * along.perUnit; });
    addColumn(table, rows, {.name = "region"}, [&](const Row& row) { return looks[row.state][row.region].name; });
    addColumn(table, rows, {.name = "parameter"}, [&](const Row& row) { return channelAt(row).name; });
    addColumn(table, rows, {.name = "unit"}, [&](const Row& row) { return channelAt(row).unit; });
    addColumn(table, rows, {.name = "weight"}, [&](const Row&) {
        return std::string(volume::kSectionWeightNames[static_cast<std::size_t>(asked.weight)]);
    });
    addColumn(table, rows, {.name = "samples"}, [&](const Row& row) { return valuesAt(row).samples; });
    sayWeighted(table.columns.back());
    for (const SectionMeasure measure : kMeasures) {
        const std::string name(measure == SectionMeasure::Least  ? "min"
                               : measure == SectionMeasure::Most ? "max"
                                                                 : kSectionMeasureNames[std::size_t(measure)]);
        const bool carried = measure == SectionMeasure::Flux || measure == SectionMeasure::Flow;
        addColumn(table, rows, {.name = name}, [&](const Row& row) {
            if (carried && velocity.empty()) return std::nan("");
            return measured(valuesAt(row), measure, unitAt(row, measure).factor);
        });
        if (measure > SectionMeasure::Most)
            addColumn(table, rows, {.name = name + " unit"}, [&](const Row& row) { return unitAt(row, measure).unit; });
    }
    const bool bounded = std::ranges::any_of(states, [](const auto& state) { return !state.errors.empty(); });
    for (const SectionMeasure measure : kMeasures)
        if (bounded && measure != SectionMeasure::Area)
            addColumn(table, rows, {.name = "error of " + std::string(kSectionMeasureNames[std::size_t(measure)])},
                      [&](const Row& row) {
                          return errorOf(states[row.state], row.channel, valuesAt(row), measure,
                                         unitAt(row, measure).factor);
                      });
    return table;
}

namespace {

/// Lays the lines of several states or regions into plots.
class SectionPanels {
public:
    SectionPanels(const volume::DatasetInfo& info, const std::vector<SectionCurves>& states, SectionMeasure measure,
                  bool dark)
        : info_(info), states_(states), asked_(states.front().query), measure_(measure), dark_(dark),
          names_(sectionStateNames(info, states)) {
        const bool mixed = mixedSelections(states);
        for (const SectionCurves& state : states) looks_.push_back(regionLooks(info, state, mixed));
        const auto& places = states.front().sections.place;
        length_ = placeUnit(info, asked_, places.empty() ? 0 : std::abs(places.back() - places.front()));
        if (!places.empty()) across_ = {places.front() * length_.perUnit, places.back() * length_.perUnit};
    }

    /// Adds the plots of the channel at a position of the query; those of several states have one range of values.
    void add(std::size_t channel, std::vector<Plot>& panels) const {
        const std::size_t first = panels.size();
        Range range{HUGE_VAL, -HUGE_VAL};
        if (states_.size() == 1) {
            Plot& panel = panels.emplace_back(empty(channel));
            for (std::size_t r = 0; r < looks_[0].size(); ++r) addLine(panel, range, {channel, 0, r});
            if (panel.series.size() == 1 && panel.series[0].name != "all") panel.title = panel.series[0].name;
        } else {
            for (const std::string& region : regionNames())
                if (Plot panel = ofRegion(region, channel, range); !panel.series.empty())
                    panels.push_back(std::move(panel));
            if (panels.size() == first) panels.push_back(empty(channel));
        }
        for (std::size_t i = first; i < panels.size(); ++i)
            panels[i].y.range = range.lo <= range.hi ? paddedRange(range, 0.05) : Range{0, 1};
    }

private:
    struct Place {
        std::size_t channel, state, region;
    };

    std::vector<std::string> regionNames() const {
        std::vector<std::string> names;
        for (const std::vector<CurveLook>& each : looks_)
            for (const CurveLook& look : each)
                if (std::ranges::find(names, look.name) == names.end()) names.push_back(look.name);
        return names;
    }

    /// A line for each state in which the region occurs.
    Plot ofRegion(const std::string& region, std::size_t channel, Range& range) const {
        Plot panel = empty(channel);
        for (std::size_t s = 0; s < states_.size(); ++s) {
            const auto own = std::ranges::find(looks_[s], region, &CurveLook::name);
            if (own != looks_[s].end()) addLine(panel, range, {channel, s, std::size_t(own - looks_[s].begin())});
        }
        if (region != "all") panel.title = region;
        return panel;
    }

    void addLine(Plot& panel, Range& range, Place of) const {
        const bool several = states_.size() > 1;
        const CurveLook& look = looks_[of.state][of.region];
        PlotSeries series{several ? names_[of.state] : look.name, {}, several ? ink(of.state) : look.color};
        const volume::Sections& sections = states_[of.state].sections;
        const double factor = unitOf(of.channel).factor;
        bool any = false;
        for (std::size_t p = 0; p < sections.place.size(); ++p) {
            const volume::SectionValues& values = sections.values[of.region][of.channel][p];
            const double value = values.area > 0 ? measured(values, measure_, factor) : std::nan("");
            series.points.push_back({sections.place[p] * length_.perUnit, value});
            if (!std::isfinite(value)) continue;
            range = {std::min(range.lo, value), std::max(range.hi, value)};
            any = true;
        }
        if (any) panel.series.push_back(std::move(series));
    }

    /// Times in order have colours in order; a selection beside everything has those they have elsewhere.
    glm::vec3 ink(std::size_t state) const {
        if (mixedTimes(states_)) return stateInk(state, states_.size(), dark_);
        SectionCurvesQuery asked = states_[state].query;
        asked.label = -1;
        return curveLooks(info_, asked).front().color;
    }

    volume::ComposedUnit unitOf(std::size_t channel) const {
        return measureUnit(info_, asked_.channels[channel], states_.front().velocity, measure_);
    }

    Plot empty(std::size_t channel) const {
        const std::string what = std::string(kSectionMeasureNames[static_cast<std::size_t>(measure_)]);
        const bool everywhere = measure_ != SectionMeasure::Flow && measure_ != SectionMeasure::Area;
        const std::string name = info_.channel(asked_.channels[channel]).name;
        Plot panel;
        panel.x = {.title = placeTitle(info_, asked_), .range = across_, .unit = length_.name};
        panel.y = {.title = what + (everywhere ? " of " + name : " where " + name + " exists"),
                   .range = {},
                   .unit = unitOf(channel).unit};
        return panel;
    }

    const volume::DatasetInfo& info_;
    const std::vector<SectionCurves>& states_;
    const SectionCurvesQuery& asked_;
    SectionMeasure measure_;
    bool dark_;
    std::vector<std::string> names_;
    std::vector<std::vector<CurveLook>> looks_; ///< of regions, by state
    LengthUnit length_;
    Range across_{};
};

} // namespace

std::vector<Plot> sectionPanels(const volume::DatasetInfo& info, const std::vector<SectionCurves>& states,
                                SectionMeasure measure, bool dark) {
    if (states.front().velocity.empty() && (measure == SectionMeasure::Flux || measure == SectionMeasure::Flow))
        throw Error("a flux needs a velocity, and no vector has the name or unit of one");
    const SectionPanels family(info, states, measure, dark);
    std::vector<Plot> panels;
    for (std::size_t c = 0; c < states.front().query.channels.size(); ++c) family.add(c, panels);
    return panels;
}

} // namespace tessera::app
