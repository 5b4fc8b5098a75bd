#pragma once

#include "vis/model/preintegration.h"
#include "vis/model/ray_setup.h"
#include "vis/model/shade.h"
#include "vis/reference/raycast.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tessera::vis::reference {

/// A layer with all that it needs to be drawn.
struct DrawnLayer {
    const Technique* technique = nullptr;
    const Samples* samples = nullptr;
    Range range;
    const TransferFunction* function = nullptr;
    Plane plane;                                ///< of a slice
    std::optional<IntegralFunctions> integrals; ///< of a pre-integrated layer
    Classification classification = Classification::Post;

    /// Place in the range of the transfer function, before it is clamped to 0..1; the middle where that has no width.
    double unclamped(double value) const;
    /// Place in the range of the transfer function, 0..1.
    double place(double value) const;
    /// Colour (linear light) and opacity of a value by the curve.
    glm::dvec4 classify(double value) const;
    /// The same of a place in the range, 0..1.
    glm::dvec4 classifyPlace(double place) const;
};

/// A scene made ready for its rays.
struct Prepared {
    const Scene& scene;
    Options options;
    volume::Lattice lattice;
    WorldFrame frame;
    glm::dvec3 cell{1};
    Illumination light;
    std::vector<PlacedClip> clips;
    std::map<std::string, std::unique_ptr<Samples>> samples;    ///< by channel name
    std::map<std::string, std::unique_ptr<Samples>> rawSamples; ///< without prefilter, for pre-classification
    std::vector<DrawnLayer> layers;
    DoiFunction interestOf;
    std::vector<const Samples*> brushed; ///< of interestOf.channels(); null: unknown

    /// Throws Error when the source does.
    Prepared(const Scene& drawn, const volume::BrickSource& source, const Options& wanted);

    glm::dvec3 cells(glm::dvec3 world) const { return lattice.toCells(frame.toPhysical(world)); }
    /// Matter of every cell of a light grid, as vis/model/light_volume.h says.
    Matter<double> matter(const LightGrid& grid) const;
    /// Degree of interest of a world point.
    double interest(glm::dvec3 world) const;
    /// Length of the change over one worldCell edge per axis, in ranges of the layer's transfer function.
    double steepness(const DrawnLayer& layer, glm::dvec3 world) const;
    /// Place of a gradient's magnitude, 0..1 and beyond.
    double steepPlace(const DrawnLayer& layer, glm::dvec3 world) const {
        return steepness(layer, world) / double(layer.function->gradientTop);
    }
    /// Colour (linear light) and opacity of a volume layer at a place, classified after interpolation.
    glm::dvec4 colorAt(const DrawnLayer& layer, double value, glm::dvec3 world) const;
    /// Gradient of a channel, per cell of the sublattice and axis.
    glm::dvec3 gradient(const Samples& of, glm::dvec3 world) const {
        return volume::gradient([&](glm::dvec3 at) { return of.value(at); }, cells(world), gradientDelta(lattice.kind));
    }
    double opacityFactor(double doi) const { return glm::mix(double(scene.selection.contextOpacity), 1.0, doi); }
    glm::dvec3 saturated(glm::dvec3 color, double doi) const {
        return glm::mix(glm::dvec3(luminance(color)), color,
                        glm::mix(double(scene.selection.contextSaturation), 1.0, doi));
    }
};

} // namespace tessera::vis::reference
