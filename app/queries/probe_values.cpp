#include "app/queries/probe_values.h"

#include "volume/field/quantities.h"
#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

namespace tessera::app {

std::size_t addProbe(Session& session, const volume::DatasetInfo& info) {
    const auto taken = [&](const std::string& name) {
        return std::ranges::find(session.probes, name, &Probe::name) != session.probes.end();
    };
    std::size_t number = session.probes.size() + 1;
    while (taken("probe " + std::to_string(number))) ++number;
    const glm::dvec4 point = info.pointAt(session.cursor, session.time);
    session.probes.push_back({"probe " + std::to_string(number), glm::dvec3(point), point.w});
    return session.probes.size() - 1;
}

std::optional<glm::dvec3> positionOf(const Probe& probe, const volume::DatasetInfo& info) {
    if (!info.plane) return probe.position;
    const glm::dvec4 point(probe.position, probe.time);
    return info.plane->holds(point) ? std::optional(info.plane->positionOf(point)) : std::nullopt;
}

std::size_t probeHere(const Session& session, const volume::DatasetInfo& info) {
    const glm::dvec3 same = info.plane ? 1e-9 * info.bounds.size() : glm::dvec3(0); // a position in a plane is computed
    const auto here = [&](const Probe& probe) {
        const auto at = positionOf(probe, info);
        return at && glm::all(glm::lessThanEqual(glm::abs(*at - session.cursor), same)) &&
               (info.plane || probe.time == session.time);
    };
    return std::size_t(std::ranges::find_if(session.probes, here) - session.probes.begin());
}

std::vector<std::vector<volume::ProbeValue>> readProbes(const volume::BrickSource& source,
                                                        const std::vector<Probe>& probes) {
    std::vector<std::vector<volume::ProbeValue>> values;
    const volume::DatasetInfo& info = source.info();
    for (const Probe& probe : probes) {
        const auto position = positionOf(probe, info);
        const volume::TimePair time = info.plane ? volume::TimePair{} : volume::timesAround(info.times, probe.time);
        values.push_back(position ? volume::probe(source, *position, time)
                                  : std::vector<volume::ProbeValue>(info.channels().size()));
    }
    return values;
}

Table probesTable(const volume::DatasetInfo& info, const std::vector<Probe>& probes,
                  const std::vector<std::vector<volume::ProbeValue>>& values, const std::vector<int>& channels) {
    Table table;
    addColumn(table, probes, {.name = "probe", .head = "Probe"}, &Probe::name);
    if (info.times.size() > 1 || info.plane) {
        addColumn(table, probes, {.name = info.timeName, .unit = info.timeUnit}, &Probe::time);
        for (const volume::Quantity& quantity : info.quantities)
            addColumn(table, probes, {.name = quantity.name, .unit = quantity.unit},
                      [&](const Probe& probe) { return volume::valueAt(info.times, quantity.values, probe.time); });
    }
    for (int axis = 0; axis < 3; ++axis)
        addColumn(table, probes, {.name = std::string(1, char('x' + axis)), .unit = info.lengthUnit},
                  [axis](const Probe& probe) { return probe.position[axis]; });
    const auto valueOf = [&](std::size_t row, int channel) -> std::optional<double> {
        const auto at = std::size_t(channel);
        return row < values.size() && at < values[row].size() ? values[row][at].interpolated : std::nullopt;
    };
    if (const auto label = volume::labelChannel(info)) {
        TableColumn region{.name = "region", .head = "Region"};
        for (std::size_t row = 0; row < probes.size(); ++row) {
            const auto value = valueOf(row, *label);
            region.texts.push_back(
                value ? volume::labelName(volume::parameterOf(info, *label), int(std::lround(*value))) : "");
        }
        table.columns.push_back(std::move(region));
    }
    for (const int channel : channels) {
        const volume::Channel own = info.channel(channel);
        const Range range = info.channelRange(own);
        TableColumn column{.name = own.name, .unit = own.unit};
        for (std::size_t row = 0; row < probes.size(); ++row) {
            const auto value = valueOf(row, channel);
            column.numbers.push_back(value.value_or(std::nan("")));
            if (!value) column.words[row] = positionOf(probes[row], info) ? "absent" : "not in the plane";
        }
        column.resolutions.assign(probes.size(), (range.hi - range.lo) / 10000);
        table.columns.push_back(std::move(column));
    }
    return table;
}

} // namespace tessera::app
