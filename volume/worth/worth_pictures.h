#pragma once

#include "volume/worth/finding.h"
#include "volume/worth/worth_samples.h"

#include <vector>

/// Small pictures of findings, as numbers.
namespace tessera::volume {

/// Either a density of two parameters, or one or two rows of heights: a histogram, or a curve over the times.
struct WorthPicture {
    int side = 0;           ///< of a density: cells along each axis; 0: heights
    std::vector<float> all; ///< 0..1; of a density x fastest, row 0 = the lowest y; of curves from the first time,
                            ///< NaN where there is nothing
    std::vector<float> part = {}; ///< of a histogram: of what was found or is selected, 0..1
    int mark = -1;                ///< of a curve: the time found
    bool operator==(const WorthPicture&) const = default;
};

/// Of two parameters their density in the region; of places the values around in the region, and of the place; of what
/// is selected and of the rest; of changes and times the series that the finding brings.
WorthPicture pictureOf(const WorthSamples& samples, const Finding& finding);

} // namespace tessera::volume
