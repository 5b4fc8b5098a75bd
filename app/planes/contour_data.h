#pragma once

#include "app/pane/oblique_plane.h"
#include "app/session/session.h"
#include "volume/analysis/contours.h"
#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"
#include "volume/field/time_pair.h"

#include <optional>
#include <string>
#include <vector>

/// Contour lines of a parameter in a slice, as numbers.
namespace tessera::app {

/// A slice: the axes that run to the right and up, and the one it is perpendicular to.
struct SliceAxes {
    int right = 0, up = 1, normal = 2;
    bool operator==(const SliceAxes&) const = default;
};

/// Values that lines are drawn at: multiples of a step that is 1, 2 or 5 times a power of ten.
struct ContourLevels {
    std::vector<double> values; ///< rising, inside of the range
    double step = 0;
};
/// At most `count` of them, but one where a range has any; none for an empty range.
ContourLevels contourLevels(Range range, int count);

/// A level as it is written on its line.
std::string contourText(double level, double step);

/// What is asked for; equal queries have equal answers.
struct ContourQuery {
    int channel = 0; ///< index of DatasetInfo::channels()
    PicturePlane plane;
    Range x, y; ///< what the picture spans along the plane's directions
    volume::TimePair time;
    std::vector<double> levels;
    volume::AxisMaps maps = {}; ///< from the sheet that the plane is of to space: those of the picture
    bool operator==(const ContourQuery&) const = default;
};

struct Contours {
    std::vector<volume::ContourLine> lines; ///< points: distances along the plane's directions
};

/// Traces the lines on a grid as fine as the samples or finer, up to the faces of the data. Where regions are kept
/// apart (volume/field/parts.h) each has lines of its own. Throws Error, Cancelled.
Contours readContours(const volume::BrickSource& source, const ContourQuery& query, const Progress& progress = {});

/// The parameter that has the lines of a view: the one shown where ContourSettings::channel is "", else that one.
/// Nothing where the data lack it, it is a label, or no lines are wanted.
std::optional<int> contourChannel(const volume::DatasetInfo& info, const ContourSettings& settings, int shown);

/// The levels of a parameter over the range of its colours.
ContourLevels contourLevels(const Session& session, const volume::DatasetInfo& info, int channel, int count);

/// Which parameter the lines are of and how far apart they lie, e.g. "lines: T [K], 10 apart".
std::string contourTitle(const volume::Channel& channel, const ContourLevels& levels);

} // namespace tessera::app
