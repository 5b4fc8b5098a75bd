#pragma once

#include "app/drawing/drawing.h"
#include "app/pane/plot.h"
#include "app/session/session.h"
#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"
#include "volume/field/time_pair.h"

#include <string>
#include <vector>

/// Data of a line profile.
namespace tessera::app {

/// What is asked for; equal queries have equal answers.
struct ProfileQuery {
    ProfileOver over = ProfileOver::Line;
    std::vector<int> channels;       ///< indices of DatasetInfo::channels()
    std::vector<glm::dvec3> corners; ///< of the line; over time: the one place
    int samples = 0;                 ///< places along the line
    volume::TimePair time;           ///< along the line alone
    bool operator==(const ProfileQuery&) const = default;
};

struct Profile {
    ProfileQuery query;
    std::vector<double> distance; ///< of the places along the line, in the data's length unit
    std::vector<glm::dvec3> positions;
    std::vector<double> times; ///< stored times, where it runs over time
    /// By channel, then by time, then by place (fastest); NaN where absent.
    std::vector<std::vector<double>> values;

    /// Along the line or over time, whichever the curves run over.
    const std::vector<double>& across() const { return query.over == ProfileOver::Time ? times : distance; }
};

/// Reads the values. Throws Error, Cancelled.
Profile readProfile(const volume::BrickSource& source, const ProfileQuery& query, const Progress& progress = {});

/// What runs along the line: a distance; a time, where time takes the place of an axis and the line runs along that one
/// alone; a share of the line where it runs through both.
struct LineAxis {
    std::string title, unit;
    std::vector<double> values; ///< at each place, in `unit`
    bool distance = true;
};
LineAxis lineAxis(const Session& session, const volume::DatasetInfo& info, const Profile& profile);

/// One line per place, or per time, or per time and place.
std::string profileCsv(const volume::DatasetInfo& info, const Session& session, const Profile& profile);
/// A panel per channel: curves, or pictures coloured by the session's transfer functions.
VectorPage profileDrawing(const volume::DatasetInfo& info, const Session& session, const Profile& profile);

/// A picture of a channel over distance (to the right) and time (upwards, row 0 at the top is the last time): RGBA,
/// a row per stored time, transparent where absent.
std::vector<std::uint8_t> profileImage(const volume::DatasetInfo& info, const Session& session, const Profile& profile,
                                       std::size_t channel);

/// The corner of a plot, as shares of its width and height, in which a text of a size in pixels hides the fewest points
/// of a line: the upper left one if no other is better, then the lower left one.
ImVec2 freeCorner(const PlotFrame& frame, ImVec2 size, const std::vector<ImVec2>& line);

} // namespace tessera::app
