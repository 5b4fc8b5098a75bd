#include "app/views/volume/probe_marks.h"

#include "app/pane/plot.h"
#include "app/queries/probe_values.h"

namespace tessera::app {

void drawProbes(ImDrawList& draw, const SpaceFrame& space, const std::vector<Probe>& probes,
                const volume::DatasetInfo& info) {
    for (const Probe& probe : probes) {
        const auto position = positionOf(probe, info);
        const auto at = position ? space.pixel(*position) : std::nullopt;
        if (!at) continue;
        draw.AddCircleFilled(*at, em() * 0.25f, plotColors().backdrop);
        draw.AddCircleFilled(*at, em() * 0.18f, plotColors().cursor);
        addTextWithBackdrop(draw, {at->x + em() * 0.5f, at->y}, {0, 0.5f}, plotColors().text, probe.name.c_str());
    }
}

} // namespace tessera::app
