#pragma once

#include "volume/analysis/axis_densities.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

/// The picture between two axes of parallel coordinates: a band for each pair of bins that hold samples, whose
/// densities add up. It costs the same for any number of samples, and for more bins than rows hardly more.
namespace tessera::app {

/// Rows of a picture that places of an axis take.
struct PlaceRows {
    double axis = 0;                 ///< the bins take rows 0..axis, the last bin at the top
    bool flipped = false;            ///< the first bin at the top
    double markFrom = 0, markTo = 0; ///< of samples that lack the parameter
};

/// The rows of a place; nothing for what lies beyond the ends of the axis.
std::optional<Range> placeRows(const PlaceRows& rows, int bins, int place);

/// How many neighbouring bins are drawn as one where an axis takes so many rows: 1 while a bin has a row or more, else
/// so many that together they have one, and less than two.
int binsTogether(int bins, double rows);

/// Numbers of samples in each pixel: of every column the sum is that of all bands.
struct GapDensity {
    int width = 0, height = 0;
    std::vector<double> all;                   ///< width x height, x fastest, row 0 at the top
    std::vector<std::vector<double>> selected; ///< by group
};

/// A band runs straight from the rows of its left bin to those of the right one, and its samples are spread evenly
/// over its height in each column. Bins thinner than a row are joined: binsTogether. Samples that lack both parameters,
/// or lie beyond an end of either axis, have none.
GapDensity rasterGap(const volume::PlaceCounts& counts, int bins, const PlaceRows& left, const PlaceRows& right,
                     int width, int height);

using GapInk = std::array<double, 3>; ///< sRGB, 0..255

struct GapLook {
    bool logDensity = true;
    double most = 1;           ///< the density with full opacity: the greatest of all gaps
    double unit = 1;           ///< rows of a band on an axis: one sample has at least the density 1 / unit
    GapInk plain{}, context{}; ///< of samples while nothing is selected, and of those that are not
    std::vector<GapInk> focus; ///< by group
};

/// Colours, not premultiplied, row 0 at the top; transparent where no sample is. Few selected samples among many are
/// seen, too: what is selected lies above.
std::vector<std::uint8_t> gapPixels(const GapDensity& density, const GapLook& look);

double greatestDensity(const GapDensity& density);

} // namespace tessera::app
