#pragma once

#include "app/session/session.h"
#include "app/values/table.h"
#include "volume/reconstruct/probe.h"

#include <optional>
#include <string>
#include <vector>

/// The list of probes: places and times whose values are kept. In a plane of space and time they are points of both, of
/// which the plane holds some.
namespace tessera::app {

/// Keeps the place of the cross-hair at the time shown, with a name of its own; returns its position in the list.
std::size_t addProbe(Session& session, const volume::DatasetInfo& info);

/// The probe at the cross-hair and the time shown, the list's size if there is none.
std::size_t probeHere(const Session& session, const volume::DatasetInfo& info);

/// Where a probe lies in the data: its place, of a plane in space and time its position in it; none if it is not in it.
std::optional<glm::dvec3> positionOf(const Probe& probe, const volume::DatasetInfo& info);

/// Values of every channel at each probe; none where the probe lies outside the box or the plane. Throws Error.
std::vector<std::vector<volume::ProbeValue>> readProbes(const volume::BrickSource& source,
                                                        const std::vector<Probe>& probes);

/// A row for each probe: name, time and quantities over time, place, region, and the interpolated values of channels.
Table probesTable(const volume::DatasetInfo& info, const std::vector<Probe>& probes,
                  const std::vector<std::vector<volume::ProbeValue>>& values, const std::vector<int>& channels);

} // namespace tessera::app
