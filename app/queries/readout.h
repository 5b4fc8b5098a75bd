#pragma once

#include "app/pane/legend.h"
#include "app/queries/async_query.h"
#include "app/values/table.h"
#include "volume/bricks/brick_cache.h"
#include "volume/field/time_pair.h"
#include "volume/reconstruct/probe.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tessera::app {

/// Values of every parameter at the linked cross-hair, read in the background when cross-hair or time change; until
/// then the previous values are shown.
struct Readout {
    struct Query {
        glm::dvec3 position{0};
        volume::TimePair time;
        bool operator==(const Query&) const = default;
    };
    std::vector<volume::Channel> channels;
    std::vector<volume::ProbeValue> values; ///< by channel; empty until they are read
    /// By channel: how far samples may be from those that were packed; 0 = exact or not known.
    std::vector<double> bounds = {};
    std::string boundKind = {}; ///< what these are: "bound of the archive"
    AsyncQuery<Query, std::vector<volume::ProbeValue>> answers;
    std::shared_ptr<volume::BrickCache> cache;         ///< bricks around the cursor, so that dragging it decodes few
    std::shared_ptr<const volume::BrickSource> source; ///< of the cache

    /// Interpolated value of a channel at the cursor; nothing where it is absent or not yet read.
    std::optional<double> value(const std::string& channel) const;
};

/// Starts reading if the cursor or time is new. Headless, reads at once; throws Error.
void updateReadout(ViewContext& context, Readout& readout);
/// The updated read-out that all views share: each value is read once.
const Readout& sharedReadout(ViewContext& context);

/// Legends with the values at the cross-hair of the parts of glyphs, where somebody can move it.
std::vector<LegendEntry> withValuesAtCursor(ViewContext& context, std::vector<LegendEntry> legends);

/// Table of position, index and values; in a narrow room the values in running lines.
void drawReadout(ViewContext& context, const Readout& readout);
/// Position and values in running lines. Where these need more than `height` pixels they lack the position, which
/// titles of slices tell, then units, then values; all is under the mouse.
void drawRunningReadout(const ViewContext& context, const Readout& readout, float height);
/// Position and values, one in each line.
std::string readoutText(const ViewContext& context, const Readout& readout);
/// Pixels that the table needs.
float readoutHeight(const Readout& readout);

/// "± 0.05 K" of a channel, by its index; "" where it is exact or nothing is known.
std::string boundText(const Readout& readout, std::size_t channel, bool unit);

/// Every parameter's value, the nearest sample's, how far packed samples may be off and, where a label says regions,
/// the region that the point lies in (of a parameter whose regions are kept apart, by their label).
Table readoutTable(const volume::DatasetInfo& info, const Readout& readout);
/// The same as CSV, after rows for the place, the time and the quantities over time.
std::string readoutCsv(const Session& session, const volume::DatasetInfo& info, const Readout& readout);

} // namespace tessera::app
