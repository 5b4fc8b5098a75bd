#pragma once

#include "app/queries/levelled_samples.h"
#include "app/views/parallel/parallel_axes.h"
#include "volume/field/time_pair.h"

#include <optional>
#include <string>
#include <vector>

/// The sample whose line in parallel coordinates runs nearest to the mouse.
namespace tessera::app {

/// A place among axes that are drawn equally high.
struct SampleQuery {
    std::vector<volume::DensityAxis> axes;
    std::vector<bool> flipped; ///< of each axis: the least value is at the top
    int left = 0;              ///< the axis, or the one left of the place
    double along = 0;          ///< from that axis, 0, to the next, 1
    double height = 0;         ///< 0..1 from below
    volume::TimePair time;
    bool operator==(const SampleQuery&) const = default;
};

struct SampleLine {
    std::vector<std::optional<double>> values; ///< by axis; nothing: absent
    glm::dvec3 position{0};                    ///< physical
    int level = 0;                             ///< of detail; 0: it is one of the stored samples
    double away = 0;                           ///< from the place, in heights of the axes
};

/// The place of the mouse between two axes, or on one where there is no next. Nothing above or below them.
std::optional<SampleQuery> sampleQuery(const std::vector<ParallelAxis>& axes, std::size_t left, double x, double y,
                                       const volume::TimePair& time);

/// The sample whose straight line between both axes is nearest to the place, the first of equal ones; nothing where
/// none has a line there. Throws Error, Cancelled.
std::optional<SampleLine> nearestSample(const volume::BrickSource& source, const SampleQuery& query, int level,
                                        const Progress& progress = {});

/// One per view, in its cache.
class AsyncSample {
public:
    std::shared_ptr<const std::optional<SampleLine>> get(ViewContext& context, const std::string& pane,
                                                         const SampleQuery& query);

private:
    LevelledSamples samples_;
    AsyncQuery<SampleQuery, std::optional<SampleLine>> query_;
};

/// "nearest line: the sample at x 1.2 mm, y 0.40 mm, z 3.0 mm".
std::string sampleText(const Session& session, const volume::DatasetInfo& info, const SampleLine& sample);

} // namespace tessera::app
