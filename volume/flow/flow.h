#pragma once

#include "volume/base/load_once.h"
#include "volume/flow/runge_kutta.h"
#include "volume/reconstruct/sample_grid.h"

#include <atomic>
#include <functional>
#include <optional>
#include <span>
#include <vector>

/// Vector fields between their samples, and streamlines.
namespace tessera::volume {

/// The interpolated value as in probe.h, using only the part of the nearest sample; empty where absent.
std::optional<double> valueAt(const SampleGrid& grid, glm::dvec3 position);

/// A vector parameter at one time and level of detail, in memory.
struct VectorGrid {
    SampleGrid x, y, z;
    Box bounds; ///< of the data set: nothing flows beyond it
    /// The interpolated vector as in probe.h, in the parameter's unit; empty outside the bounds and where a component
    /// is absent.
    std::optional<glm::dvec3> at(glm::dvec3 position) const;
};

/// `parameter`: index of DatasetInfo::parameters, with three components. Throws Error, Cancelled.
VectorGrid readVector(const BrickSource& source, int parameter, int time, int level, const Progress& progress = {});

using VectorField = std::function<std::optional<glm::dvec3>(glm::dvec3 position)>;

/// A vector parameter at all its times, read on demand, kept, and interpolated linearly in time. Keeps a reference to
/// the source. Thread-safe. Throws what readVector does.
class VectorSeries {
public:
    VectorSeries(const BrickSource& source, int parameter, int level);
    /// Empty before the first and after the last time, and where either neighbour has no vector. A single time is that
    /// of a steady flow: always.
    std::optional<glm::dvec3> at(glm::dvec3 position, double time) const;
    /// All of it at a stored time.
    const VectorGrid& frame(std::size_t time) const;

private:
    std::vector<double> times_;
    mutable LoadOnce<std::size_t, VectorGrid, std::hash<std::size_t>> frames_;
    mutable std::vector<std::atomic<const VectorGrid*>> loaded_; ///< those of frames_, to be found without its lock
};

struct StreamlineSettings {
    glm::dvec3 cell{1}; ///< steps and errors are measured in these lengths
    /// In the lengths of its cells at each place instead; with uneven axes no step crosses more than `longestStep` of
    /// cells, however short those on its way are.
    std::optional<Lattice> lattice = {};
    double tolerance = 1e-4;  ///< error of a step, cells
    double longestStep = 0.5; ///< cells
    double longest = 1e300;   ///< of a line, each way, physical
    double slowest = 0;       ///< a line ends where the field is no faster
    int mostSteps = 5000;     ///< each way
    /// Counts lines that end after that many steps, by their ends, on any thread; null: nobody asks.
    std::atomic<std::size_t>* stopped = nullptr;
};

/// The streamline through a point, from its upstream to its downstream end; the point is one of its vertices. Ends
/// where the field does, to 1/256 of a cell, and where it rests. Empty if the vector at the point is absent or too
/// small. Steps are those of flowStep().
std::vector<glm::dvec3> streamline(const VectorField& field, glm::dvec3 seed, const StreamlineSettings& settings);

/// Streamlines of all seeds, in order; the result does not depend on the number of threads. `field` is called from
/// several threads. Throws Cancelled.
std::vector<std::vector<glm::dvec3>> streamlines(const VectorField& field, std::span<const glm::dvec3> seeds,
                                                 const StreamlineSettings& settings, const Progress& progress = {});

} // namespace tessera::volume
