#pragma once

#include "vis/scene/flow_layer.h"
#include "vis/scene/selection.h"
#include "volume/flow/even_lines.h"
#include "volume/flow/flow.h"

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

/// What flow layers are made of: their vector in memory, their seeds, values along them.
namespace tessera::vis {

/// The data of a flow layer. Refers to the source.
struct FlowData {
    int parameter = 0, level = 0;
    double fastest = 0, slowest = 0; ///< of all times, and below which nothing flows; as the vector
    double perTime = 1;              ///< lengths in one unit of time that a vector of 1 moves a particle
    volume::Lattice lattice;         ///< in whose cells steps are measured
    volume::VectorField field;       ///< at the time shown
    std::shared_ptr<const volume::VectorSeries> series; ///< of kinds that follow particles
    /// Counts ends of lines, or particles, that stop for the number of their steps.
    std::shared_ptr<std::atomic<std::size_t>> stopped = std::make_shared<std::atomic<std::size_t>>(0);
    /// Velocity of particles.
    volume::ChangingField velocity() const;
};

/// Data of a layer at a time, of the unit of the data. Nothing where they have no such vector. Throws Error, Cancelled.
std::optional<FlowData> readFlow(const volume::BrickSource& source, const FlowLayer& layer, double moment,
                                 const Progress& progress);

/// Points where lines, particles or glyphs begin, and the lines through them that keep a distance.
struct FlowSeeds {
    std::vector<glm::dvec3> places;
    std::vector<std::vector<glm::dvec3>> lines; ///< of seeds with even distances, kinds that follow the flow; else none
};

/// Lines of seeds are straight in space; other shapes are those of the drawing, in which seeds are as dense everywhere.
/// Those of particles lie where there is a vector now and it flows at some time.
FlowSeeds seedsOf(const volume::BrickSource& source, const FlowData& data, const FlowLayer& layer, double moment,
                  glm::dvec3 stretch, const Progress& progress, const DoiFunction* interest);

/// Factor on widths and lengths at places in space: FlowLayer::contextWidth where the degree of interest is 0, 1 where
/// it is 1. Null where it is 1 everywhere. Throws Error, Cancelled.
std::function<double(glm::dvec3 place)> widthsOf(const volume::BrickSource& source, const FlowData& data,
                                                 const FlowLayer& layer, double moment, const DoiFunction* interest,
                                                 const Progress& progress);

/// Settings of the streamlines of a layer.
volume::StreamlineSettings streamlinesOf(const volume::BrickSource& source, const FlowData& data,
                                         const FlowLayer& layer);

/// Values of the layer's channel at places in space less the origin of the data, each at its own moment, between stored
/// times mixed linearly; NaN if absent.
std::vector<float> valuesOver(const volume::BrickSource& source, const std::string& channel, int level,
                              const std::vector<glm::vec3>& places, const std::vector<double>& moments,
                              const Progress& progress);

/// What users have to know of a layer's geometry: that it is of coarser samples, that lines stop early, that the
/// vectors of a plane in space and time are of several times.
std::vector<std::string> flowNotes(const volume::DatasetInfo& info, const FlowLayer& layer, const FlowData& data);

/// Level at which a layer is computed, so that its vector fits into memory at the times it needs.
int levelOf(const volume::BrickSource& source, const FlowLayer& layer);

} // namespace tessera::vis
