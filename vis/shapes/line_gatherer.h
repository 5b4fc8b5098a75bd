#pragma once

#include "vis/scene/geometry.h"
#include "vis/shapes/flow_data.h"

#include <string>
#include <vector>

namespace tessera::vis {

/// Gathers lines that are found in space, each vertex of its own time, and colours them.
class LineGatherer {
public:
    explicit LineGatherer(const volume::BrickSource& source);
    void add(glm::dvec3 place, double moment);
    /// Ends a line, which is left out if it has fewer vertices than that.
    void endLine(std::size_t least = 2);
    /// The lines on the sheet of the axes, with the values of a channel.
    LineSet finish(const std::string& channel, int level, const Progress& progress);

private:
    const volume::BrickSource& source_;
    LineSet lines_;
    std::vector<glm::vec3> inSpace_;
    std::vector<double> moments_;
};

} // namespace tessera::vis
