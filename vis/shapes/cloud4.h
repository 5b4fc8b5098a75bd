#pragma once

#include "vis/scene/selection.h"
#include "vis/shapes/rotation4.h"
#include "vis/transfer/transfer_function.h"
#include "volume/analysis/samples4.h"

#include <cstdint>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <vector>

/// Samples in space and time as a 4D point cloud in a tesseract.
namespace tessera::vis {

/// A point in four dimensions, within the unit ball.
struct CloudPoint {
    glm::vec4 position{0};
    glm::vec4 color{1};       ///< linear light; opacity at the centre of the splat
    std::uint32_t sample = 0; ///< index into Samples4
};

/// Mapping of samples to positions in the box -half..half and to colours. Channels are indices into those of Samples4.
struct CloudStyle {
    volume::Box bounds;
    volume::AxisMaps axes = {}; ///< to draw samples as even as they are stored
    glm::dvec4 half{0.5};       ///< within the unit ball
    Range fourth{0, 1};         ///< values at the ends of the fourth axis
    int fourthChannel = -1;     ///< -1: time
    TransferFunction transfer;
    Range range; ///< of the first channel's colours: effectiveRange()
    /// Colours along the fourth axis; none: the transfer function of the first channel, which always gives the opacity.
    std::optional<TransferFunction> fourthColors;
    Selection selection;
    std::vector<int> doiChannels; ///< of DoiFunction::channels(); -1: not in the data set
    double density = 1;           ///< factor on the opacity of the transfer function for 60 000 points
    bool operator==(const CloudStyle&) const = default;
};

/// The visible samples, in order. Each has the opacity 1 - (1 - a)^(density * 60000 / samples), so that the density of
/// the picture does not depend on the number of samples; unselected samples are faded and desaturated as in other
/// views.
std::vector<CloudPoint> makeCloud(const volume::Samples4& samples, const CloudStyle& style);

/// The drawn point nearest to a position in the picture (-1..1, y up), within `reach`; among those at about the same
/// distance (a fifth of the reach) the one nearest to the viewer.
std::optional<std::size_t> nearestPoint(std::span<const CloudPoint> points, const glm::dmat4& rotation,
                                        const Projection4& projection, glm::dvec2 at, double reach);

} // namespace tessera::vis
