#pragma once

#include "app/session/session.h"
#include "vis/shapes/rotation_n.h"
#include "volume/field/dataset.h"

#include <optional>
#include <string>
#include <vector>

/// The axes of a tesseract: x, y and z, time or a parameter, further parameters.
namespace tessera::app {

struct TesseractAxis {
    std::string name;           ///< as it stands on sliders and edges
    std::optional<int> channel; ///< of a parameter
    Range range;                ///< at its ends: places on the sheet, times, values
    double perUnit = 1;         ///< numbers shown per unit of the range
    std::string unit;           ///< of these
    bool even = true;           ///< numbers grow along it as places do
    bool operator==(const TesseractAxis&) const = default;
};

/// Four to eight; parameters that the data lack are left out, and time is in the place of a fourth one.
std::vector<TesseractAxis> tesseractAxes(const volume::DatasetInfo& info, const TesseractView& view);

/// Half the edges within the unit ball.
vis::PointN halfEdges(const TesseractView& view, const volume::Box& bounds, glm::dvec3 stretch, std::size_t axes);

/// The factor on the length of an axis.
double stretchOf(const TesseractView& view, std::size_t axis);

} // namespace tessera::app
