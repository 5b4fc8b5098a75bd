#include "app/views/curves/section_data.h"

#include "app/pane/plot.h"
#include "app/session/label_colors.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "volume/base/error.h"
#include "volume/bricks/source_at_time.h"
#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tessera::app {

namespace {

/// The degree of interest of a selection as a function of the channels it names.
void setInterest(volume::SectionQuery& query, const SectionCurvesQuery& asked, const volume::DatasetInfo& info) {
    if (!asked.selection.active()) return;
    const vis::DoiFunction doi(asked.selection, asked.lenses);
    std::vector<int> places; // in the values, -1: not there, absent everywhere
    for (const std::string& name : doi.channels()) {
        const auto channel = info.findChannel(name);
        places.push_back(channel ? static_cast<int>(query.doiChannels.size()) : -1);
        if (channel) query.doiChannels.push_back(*channel);
    }
    query.doi = [doi, places](std::span<const float> values, glm::dvec3 position) {
        std::vector<double> given;
        given.reserve(places.size());
        for (const int place : places)
            given.push_back(place < 0 ? std::nan("") : static_cast<double>(values[static_cast<std::size_t>(place)]));
        return doi(given, position);
    };
}

std::string velocityUnit(const volume::DatasetInfo& info, const std::string& velocity) {
    for (const volume::Parameter& parameter : info.parameters)
        if (parameter.name == velocity && !parameter.unit.empty()) return parameter.unit;
    return info.speedUnit();
}

} // namespace

SectionCurves readSections(const std::shared_ptr<const volume::BrickSource>& source, const SectionCurvesQuery& asked,
                           const Progress& progress, const NumberOrigin& origin) {
    const volume::DatasetInfo& info = source->info();
    volume::SectionQuery query;
    query.channels = asked.channels;
    query.axis = asked.axis;
    query.weight = asked.weight;
    if (asked.line.size() == 2) query.line = {asked.line[0], asked.line[1]};
    query.planes = asked.planes;
    SectionCurves out{asked, {}, {}, {}};
    const volume::SourceAtTime shown = volume::sourceAt(source, asked.time);
    if (asked.label >= 0 && asked.regions.empty())
        out.query.regions = volume::labelValues(*shown.source, asked.label, shown.time, progress.part(0, 0.2));
    query.label = asked.label;
    query.regions = out.query.regions;
    if (const auto velocity = volume::velocityChannels(info, asked.velocity)) {
        query.velocity = *velocity;
        out.velocity = volume::parameterOf(info, (*velocity)[0]).name;
    } else if (!asked.velocity.empty()) {
        throw Error("there is no vector \"" + asked.velocity + "\"");
    } else if (asked.weight == volume::SectionWeight::MassFlow) {
        throw Error("a mean by mass flow needs a velocity, and no vector has the name or unit of one");
    }
    if (asked.weight == volume::SectionWeight::MassFlow) query.density = volume::densityChannel(info).value_or(-1);
    setInterest(query, asked, info);
    query.time = shown.time;
    for (const int channel : asked.channels) out.errors.push_back(numberError(origin, info, info.channel(channel)));
    if (asked.selection.active() || std::ranges::none_of(out.errors, [](double error) { return error > 0; }))
        out.errors.clear();
    query.errors = out.errors;
    for (std::size_t axis = 0; !out.errors.empty() && query.velocity[0] >= 0 && axis < 3; ++axis)
        query.velocityError[axis] = numberError(origin, info, info.channel(query.velocity[axis]));
    out.sections = volume::computeSections(*shown.source, query, progress.part(0.2, 1));
    return out;
}

volume::ComposedUnit measureUnit(const volume::DatasetInfo& info, int channel, const std::string& velocity,
                                 SectionMeasure measure) {
    const std::string own = info.channel(channel).unit, speed = velocityUnit(info, velocity);
    const volume::UnitPower area{info.lengthFactor(), 2};
    std::vector<volume::UnitPower> factors;
    switch (measure) {
    case SectionMeasure::Mean:
    case SectionMeasure::Least:
    case SectionMeasure::Most:
        return {1, own};
    case SectionMeasure::Integral:
        factors = {{own, 1}, area};
        break;
    case SectionMeasure::Flux:
        factors = {{own, 1}, {speed, 1}, area};
        break;
    case SectionMeasure::Flow:
        factors = {{speed, 1}, area};
        break;
    case SectionMeasure::Area:
        factors = {{info.lengthUnit, 2}}; // a number alone where no unit is stated
        break;
    }
    return volume::composedUnit(factors);
}

double measured(const volume::SectionValues& values, SectionMeasure measure, double factor) {
    switch (measure) {
    case SectionMeasure::Mean:
        return values.mean;
    case SectionMeasure::Least:
        return values.least;
    case SectionMeasure::Most:
        return values.most;
    case SectionMeasure::Integral:
        return values.integral * factor;
    case SectionMeasure::Flux:
        return values.flux * factor;
    case SectionMeasure::Flow:
        return values.flow * factor;
    case SectionMeasure::Area:
        return values.area * factor;
    }
    return std::nan("");
}

double errorOf(const SectionCurves& curves, std::size_t channel, const volume::SectionValues& values,
               SectionMeasure measure, double factor) {
    const double error = curves.errors.empty() ? 0 : curves.errors[channel];
    switch (measure) {
    case SectionMeasure::Mean:
        return curves.query.weight == volume::SectionWeight::MassFlow && error > 0 ? std::nan("") : error;
    case SectionMeasure::Least:
    case SectionMeasure::Most:
        return error;
    case SectionMeasure::Integral:
        return error * values.area * factor;
    case SectionMeasure::Flux:
        return values.fluxError * factor;
    case SectionMeasure::Flow:
        return values.flowError * factor;
    case SectionMeasure::Area:
        return 0;
    }
    return std::nan("");
}

std::vector<CurveLook> curveLooks(const volume::DatasetInfo& info, const SectionCurvesQuery& asked) {
    const bool selected = asked.selection.active();
    if (asked.regions.empty() || asked.label < 0)
        return {{selected ? asked.selection.name : "all",
                 selected ? glm::vec3(0.90f, 0.45f, 0.05f) : glm::vec3(0.1f, 0.36f, 0.62f)}};
    std::vector<CurveLook> out;
    const volume::Parameter& label = volume::parameterOf(info, asked.label);
    for (const int value : asked.regions)
        out.push_back({volume::labelName(label, value) + (selected ? ", " + asked.selection.name : ""),
                       labelColor(label, value)});
    return out;
}

namespace {

bool runsAlongTime(const volume::DatasetInfo& info, const SectionCurvesQuery& asked) {
    return asked.line.size() != 2 && info.timeAxis() == static_cast<int>(asked.axis);
}

} // namespace

std::string placeTitle(const volume::DatasetInfo& info, const SectionCurvesQuery& asked) {
    if (asked.line.size() == 2) return "distance";
    return runsAlongTime(info, asked) ? timeWord(info)
                                      : std::string(volume::kSpaceAxisNames[static_cast<std::size_t>(asked.axis)]);
}

LengthUnit placeUnit(const volume::DatasetInfo& info, const SectionCurvesQuery& asked, std::optional<double> length) {
    if (runsAlongTime(info, asked)) return {info.timeUnit, info.plane->timePerLength};
    return length ? suitableLength(info.lengthUnit, *length) : LengthUnit{info.lengthUnit};
}

std::vector<std::string> sectionNotes(const volume::DatasetInfo& info, const SectionCurves& curves) {
    const SectionCurvesQuery& asked = curves.query;
    std::vector<std::string> notes;
    if (info.timeAxis())
        notes.push_back("an axis is " + timeWord(info) + ": in areas, integrals and distances 1 " +
                        (info.lengthUnit.empty() ? "of length" : info.lengthUnit) + " along it stands for " +
                        formatQuantity(info.plane->timePerLength, info.timeUnit));
    notes.push_back(asked.line.size() == 2
                        ? "planes across the line: every sample has the value of its cell, which the planes cut exactly"
                        : "planes through the samples; every sample counts with the area of its cell in the plane");
    if (asked.weight == volume::SectionWeight::MassFlow) {
        const auto density = volume::densityChannel(info);
        notes.push_back("mean by mass flow: weighted by |" +
                        (density ? info.channel(*density).name + " " : std::string()) + curves.velocity +
                        "| through the plane" + (density ? "" : " (no density: by volume flow)"));
    }
    if (!curves.velocity.empty()) {
        notes.push_back("flux and flow: carried by " + curves.velocity +
                        " (convection only), positive along the direction of the axis or line");
        for (const volume::Parameter& parameter : info.parameters)
            if (parameter.name == curves.velocity && parameter.unit.empty())
                notes.push_back(curves.velocity + " has no unit: taken as " + velocityUnit(info, curves.velocity));
    }
    return notes;
}

} // namespace tessera::app
