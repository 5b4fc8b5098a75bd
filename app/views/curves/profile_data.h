#pragma once

#include "app/pages/plot_page.h"
#include "app/session/session.h"
#include "app/values/table.h"
#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"
#include "volume/field/time_pair.h"

#include <optional>
#include <string>
#include <vector>

/// Data of a line profile.
namespace tessera::app {

/// What is asked for; equal queries have equal answers.
struct ProfileQuery {
    ProfileOver over = ProfileOver::Line;
    std::vector<int> channels;               ///< indices of DatasetInfo::channels()
    std::vector<glm::dvec3> corners;         ///< of the line; over time: the one place
    int samples = 0;                         ///< places along the line
    std::vector<volume::TimePair> times{{}}; ///< along the line alone, a curve each
    bool operator==(const ProfileQuery&) const = default;
};

struct Profile {
    ProfileQuery query;
    std::vector<double> distance; ///< of the places along the line, in the data's length unit
    std::vector<glm::dvec3> positions;
    std::vector<double> times; ///< the stored times where it runs over time, else those of the query
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

/// A row for each place, or time, or time and place; several times along the line are named.
Table profileTable(const volume::DatasetInfo& info, const Session& session, const Profile& profile);
/// A plot for each channel: curves, one for each time of a line, or over distance and time a plot without its picture.
std::vector<Plot> profilePlots(const volume::DatasetInfo& info, const Session& session, const Profile& profile,
                               bool dark);
/// The element of Profile::across() at the session's time, or nearest to its cursor where that lies near the line.
std::optional<std::size_t> markedPlace(const volume::DatasetInfo& info, const Session& session, const Profile& profile);
/// Marks an element of Profile::across() in the plots, and the session's time in pictures.
void markPlots(std::vector<Plot>& plots, const volume::DatasetInfo& info, const Session& session,
               const Profile& profile, std::optional<std::size_t> place);
/// The plots on a page, those over distance and time with pictures coloured by the session's transfer functions.
VectorPage profileDrawing(const volume::DatasetInfo& info, const Session& session, const Profile& profile,
                          const PageForm& form = {});

/// A picture of a channel over distance (to the right) and time (upwards, row 0 at the top is the last time): RGBA,
/// a row per stored time, transparent where absent.
std::vector<std::uint8_t> profileImage(const volume::DatasetInfo& info, const Session& session, const Profile& profile,
                                       std::size_t channel);

} // namespace tessera::app
