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

/// Samples in space and time as points of a tesseract.
namespace tessera::vis {

/// A point in four dimensions, within a ball of radius 1.
struct CloudPoint {
    glm::vec4 position{0};
    glm::vec4 color{1};       ///< linear light; opacity of the middle of the splat
    std::uint32_t sample = 0; ///< of Samples4
};

/// Where samples lie in the body -half..half and what they look like. Channels are positions in Samples4's.
struct CloudStyle {
    volume::Box bounds;
    glm::dvec4 half{0.5};   ///< within the unit ball
    Range fourth{0, 1};     ///< what lies at the ends of the fourth axis
    int fourthChannel = -1; ///< -1: time
    TransferFunction transfer;
    Range range; ///< of the first channel's colours: effectiveRange()
    /// Colour along the fourth axis; none: the transfer function of the first channel. Opacity is always that one's.
    std::optional<TransferFunction> fourthColors;
    Selection selection;
    std::vector<int> doiChannels; ///< of DoiFunction::channels(); -1: not in the data
    double density = 1;           ///< opacity in units of the transfer function's for 60 000 points
    bool operator==(const CloudStyle&) const = default;
};

/// The samples that are visible, in their order. The opacity of one is 1 - (1 - a)^(density * 60000 / samples), so the
/// picture does not grow denser with the budget; what is not brushed is faded and greyed as everywhere.
std::vector<CloudPoint> makeCloud(const volume::Samples4& samples, const CloudStyle& style);

/// The point drawn nearest to a place of the picture (-1..1, y up), within `reach` of it; of those at about the same
/// distance (a fifth of the reach) the one that is nearer to the viewer.
std::optional<std::size_t> nearestPoint(std::span<const CloudPoint> points, const glm::dmat4& rotation,
                                        const Projection4& projection, glm::dvec2 at, double reach);

} // namespace tessera::vis
