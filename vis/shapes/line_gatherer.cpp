#include "vis/shapes/line_gatherer.h"

#include "volume/mesh/surface_mesh.h"

#include <utility>

namespace tessera::vis {

LineGatherer::LineGatherer(const volume::BrickSource& source) : source_(source) {
    lines_.origin = volume::originFor(source.info().bounds);
}

void LineGatherer::add(glm::dvec3 place, double moment) {
    inSpace_.emplace_back(place - lines_.origin);
    lines_.positions.emplace_back(source_.info().lattice.axes.toSheet(place) - lines_.origin);
    moments_.push_back(moment);
}

void LineGatherer::endLine(std::size_t least) {
    const std::size_t begin = lines_.ends.empty() ? 0 : lines_.ends.back();
    if (lines_.positions.size() - begin >= least) {
        if (lines_.positions.size() > begin) lines_.ends.push_back(std::uint32_t(lines_.positions.size()));
        return;
    }
    lines_.positions.resize(begin);
    inSpace_.resize(begin);
    moments_.resize(begin);
}

LineSet LineGatherer::finish(const std::string& channel, int level, const Progress& progress) {
    lines_.scalars = valuesOver(source_, channel, level, inSpace_, moments_, progress);
    return std::move(lines_);
}

} // namespace tessera::vis
