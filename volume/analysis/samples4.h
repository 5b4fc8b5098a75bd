#pragma once

#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"

#include <cstddef>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string_view>
#include <vector>

namespace tessera::volume {

/// Samples of several channels in space and time, for pictures made of points.
struct Samples4 {
    std::vector<glm::vec3> positions; ///< physical
    std::vector<float> times;
    std::vector<float> values; ///< [sample * channels + channel]; NaN where that channel is absent
    /// Of SamplesQuery::gradientOf along the sheet's x, y and z, per length, and along time: differences of the
    /// neighbours on both sides in the same sublattice, or of one, and 0 where both are absent. Empty unless asked for,
    /// and in coarse steps.
    std::vector<glm::vec4> gradients;
    int channels = 0;
    int level = 0;      ///< of detail they were read at
    int timesRead = 0;  ///< how many times were read
    double skipped = 0; ///< share of that level's samples left out for the budget, by bricks and by the lattice
    /// Share of all samples of the grid at all times asked for that were chosen, absent ones with them.
    double share = 1;
    std::size_t count() const { return positions.size(); }
};

/// Which samples stand for the data.
enum class SampleLattice {
    Stored, ///< those of the data: CC in four dimensions, or BCC in space
    D4      ///< half of them: of a grid those whose indices have an even sum, of BCC one sublattice at each time
};
inline constexpr std::string_view kSampleLatticeNames[] = {"stored", "d4"};

struct SamplesQuery {
    std::vector<int> channels; ///< of DatasetInfo::channels(); samples without the first are left out
    std::vector<int> times;    ///< indices
    std::size_t budget = 200000;
    SampleLattice lattice = SampleLattice::Stored;
    bool gradients = false;
    int gradientOf = 0; ///< channel
    bool operator==(const SamplesQuery&) const = default;
};

/// How much of the data is read for one answer.
struct SampleStep {
    int level = 0;
    std::vector<int> times; ///< indices, evenly spread over those asked for
    std::size_t bricks = 0; ///< of each time
    bool operator==(const SampleStep&) const = default;
};

/// Steps from coarse to fine: 0 is the answer, of the finest level with at most eight samples per sample of the budget,
/// at all times; steps 1 .. coarseSteps() read at the coarsest level about 128 * 4^k bricks, k = coarseSteps() - step,
/// of 2 * 4^k times or more: the last step reads least, for a first picture.
SampleStep sampleStep(const BrickGrid& grid, const SamplesQuery& query, int step);
int coarseSteps(const BrickGrid& grid, const SamplesQuery& query);

/// Reads the bricks of a step, completely and one after the other, and keeps as many samples as the budget allows,
/// chosen by a hash of their position (equal queries give equal results), in an order of which every prefix is a fair
/// sample.
///
/// SampleLattice::D4: of a grid the samples whose indices along x, y, z and time have an even sum, the checkerboard of
/// four dimensions, which but for a turn and a scale is D4* (Conway and Sloane 1999, chapter 4.7). Of BCC the even
/// sublattice at even times and the odd one at odd times, which is D4* (volume/field/lattice4.h): of an archive on D4*
/// these are the samples that it stores. Throws Error, Cancelled.
Samples4 gatherSamples(const BrickSource& source, const SamplesQuery& query, int step = 0,
                       const Progress& progress = {});

} // namespace tessera::volume
