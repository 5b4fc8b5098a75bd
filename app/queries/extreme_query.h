#pragma once

#include "app/session/session.h"
#include "volume/analysis/extremes.h"
#include "volume/bricks/brick_source.h"

#include <memory>
#include <optional>
#include <string>

/// Where the least or greatest value of a parameter lies, so that the cross-hair can go there.
namespace tessera::app {

/// Which samples are looked at.
enum class ExtremeOf { All, Selected, Rest };

struct ExtremeQuestion {
    std::string channel;
    bool greatest = true;
    ExtremeOf of = ExtremeOf::All;
    std::optional<int> region = {}; ///< value of the label that says the regions; none: all regions
    bool everyTime = false;         ///< else the time of the session
    bool operator==(const ExtremeQuestion&) const = default;
};

/// "maximum of T in starved, cathode, over all times".
std::string textOf(const ExtremeQuestion& question, const Session& session, const volume::DatasetInfo& info);

struct ExtremePlace {
    double value = 0;
    glm::dvec3 position{0}; ///< physical
    double time = 0;        ///< in the unit of the data's times
};

/// Looks for it under the brushes and at the time of the session. Nothing where no sample of the parameter is looked
/// at. Throws Error where the data lack the parameter or a brick is damaged, Cancelled.
std::optional<ExtremePlace> findExtreme(const std::shared_ptr<const volume::BrickSource>& source,
                                        const Session& session, const ExtremeQuestion& question,
                                        const Progress& progress = {});

/// "352.9 K at x 12, y 4, z -1 mm, t = 0.5 s".
std::string textOf(const ExtremePlace& place, const ExtremeQuestion& question, const volume::DatasetInfo& info);

} // namespace tessera::app
