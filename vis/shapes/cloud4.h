#pragma once

#include "vis/scene/selection.h"
#include "vis/shapes/projection4.h"
#include "vis/transfer/transfer_function.h"
#include "volume/analysis/samples4.h"

#include <cstdint>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <vector>

/// Samples in space and time as a 4D point cloud in a tesseract.
namespace tessera::vis {

/// A point within the unit ball.
struct CloudPoint {
    glm::vec4 position{0};    ///< along the first four axes
    glm::vec4 color{1};       ///< linear light; opacity at the centre of the splat
    glm::vec4 further{0};     ///< along axes 5 to 8
    glm::vec4 normal{0};      ///< in the first four dimensions, length 1; 0: none
    std::uint32_t sample = 0; ///< index into Samples4
};

/// A parameter along an axis.
struct CloudAxis {
    int channel = 0;
    Range range; ///< at the ends of the axis
    bool operator==(const CloudAxis&) const = default;
};

/// Mapping of samples to positions in the box -half..half and to colours. Channels are indices into those of Samples4.
struct CloudStyle {
    volume::Box bounds;
    volume::AxisMaps axes = {};      ///< to draw samples as even as they are stored
    PointN half{0.5, 0.5, 0.5, 0.5}; ///< within the unit ball
    Range fourth{0, 1};              ///< values at the ends of the fourth axis
    int fourthChannel = -1;          ///< -1: time
    std::vector<CloudAxis> further;  ///< axes 5 to 8
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
/// views. Samples that lack the value of the first channel or of an axis are left out.
///
/// Normals, where the samples have gradients: with time along the fourth axis those of the surfaces of equal value,
/// which have three dimensions; with a parameter there, whose gradients they must be, those of the one surface that the
/// samples form. (A. Hanson, P. Heng: Illuminating the fourth dimension, 1992.)
std::vector<CloudPoint> makeCloud(const volume::Samples4& samples, const CloudStyle& style);

/// A light in four dimensions, fixed to the picture.
struct Light4 {
    glm::dvec4 towards{0}; ///< in the picture's four axes, length 1; 0: none
    double ambient = 0.3;  ///< share that comes from everywhere
    bool operator==(const Light4&) const = default;
};
/// What is left of a colour with this normal, turned as the picture: ambient + (1 - ambient) |n . l|; 1 without light
/// or normal.
double litBy(const Light4& light, glm::dvec4 turned);

/// The drawn point nearest to a position in the picture (-1..1, y up), within `reach`; among those at about the same
/// distance (a fifth of the reach) the one nearest to the viewer.
std::optional<std::size_t> nearestPoint(std::span<const CloudPoint> points, const RotationN& rotation,
                                        const Projection4& projection, glm::dvec2 at, double reach);

} // namespace tessera::vis
