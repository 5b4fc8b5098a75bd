#pragma once

#include "vis/optics/adaptive_step.h"
#include "vis/optics/look_shading.h"
#include "vis/optics/preintegration.h"
#include "vis/optics/ray_setup.h"
#include "vis/optics/shade.h"
#include "vis/reference/options.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace tessera::vis::reference {

/// A layer with all that it needs to be drawn.
struct DrawnLayer {
    const Technique* technique = nullptr;
    const Samples* samples = nullptr;
    Range range;
    const TransferFunction* function = nullptr;
    BrushEffect brushes = BrushEffect::Fade;
    int lens = -1;                              ///< of Prepared::lenses that it is drawn in, -1: everywhere
    Plane plane;                                ///< of a slice
    std::optional<IntegralFunctions> integrals; ///< of a pre-integrated layer
    const Samples* colors = nullptr;            ///< that it is coloured by; null: by its own
    Range colorRange;
    const TransferFunction* colorFunction = nullptr;
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

/// Degree of interest of a place, and the colour (linear) of the brush that holds it most with how much it does.
struct Interest {
    double doi = 1;
    glm::dvec3 color{0};
    double held = 0;
    /// What out-of-focus blur sees of a layer.
    double seen(const DrawnLayer& layer) const { return layer.brushes == BrushEffect::None ? 1 : doi; }
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
    std::vector<PlacedLens> lenses;
    LookView look;
    glm::dvec3 middle{0, 0, -1}; ///< direction of the view
    /// By channel name, time, and 1 without prefilter, for pre-classification.
    std::map<std::tuple<std::string, double, bool>, std::unique_ptr<Samples>> samples;
    std::vector<DrawnLayer> layers;
    /// Codes of the steps of blocks (vis/optics/adaptive_step.h), x fastest; empty: there are no longer ones.
    std::vector<std::uint8_t> steps;
    glm::ivec3 blocks{0};
    DoiFunction interestOf;
    std::vector<const Samples*> brushed; ///< of interestOf.channels(); null: unknown

    /// Throws Error when the source does.
    Prepared(const Scene& drawn, const volume::BrickSource& source, glm::ivec2 size, const Options& wanted);

    /// Where the data lie that are seen at a world point: physical, and in cells.
    glm::dvec3 physical(glm::dvec3 world) const { return frame.toPhysical(bend(lenses, world, frame.halfSize)); }
    glm::dvec3 cells(glm::dvec3 world) const { return lattice.toCells(physical(world)); }
    void findSteps();
    /// The longest step through the block that holds a place, in world units.
    double stepAt(glm::ivec3 block) const;
    /// Matter of every cell of a light grid, as vis/optics/light_volume.h says.
    Matter<double> matter(const LightGrid& grid) const;
    /// Of a world point.
    Interest interest(glm::dvec3 world) const;
    /// Length of the change over one worldCell edge per axis, in ranges of the layer's transfer function.
    double steepness(const DrawnLayer& layer, glm::dvec3 world) const;
    /// Place of a gradient's magnitude, 0..1 and beyond.
    double steepPlace(const DrawnLayer& layer, glm::dvec3 world) const {
        return steepness(layer, world) / double(layer.function->gradientTop);
    }
    /// Colour (linear light) and opacity of a volume layer at a place, classified after interpolation.
    glm::dvec4 colorAt(const DrawnLayer& layer, double value, glm::dvec3 world) const;
    /// Colour (linear light) of a layer for a value of what it is coloured by, nullopt where that is absent: then the
    /// layer's plain one.
    static glm::dvec3 tint(const DrawnLayer& layer, std::optional<double> value);
    /// Colour (linear light) of a layer at a place: `own`, unless another channel gives it.
    glm::dvec3 tinted(const DrawnLayer& layer, glm::dvec3 own, glm::dvec3 world) const {
        return layer.colors ? tint(layer, layer.colors->value(cells(world))) : own;
    }
    /// Gradient of a channel as it is seen, per cell of the sublattice and axis, by the samples of one part.
    glm::dvec3 gradient(const Samples& of, glm::dvec3 world, int part) const {
        const auto seen = [&](glm::dvec3 at) {
            return of.ofPart(part, cells(frame.toWorld(lattice.origin + at * lattice.spacing)));
        };
        return volume::gradient(seen, lattice.toCells(frame.toPhysical(world)),
                                volume::gradientStencil(lattice.kind, scene.render.gradient));
    }
    /// That of the part which the place belongs to.
    glm::dvec3 gradient(const Samples& of, glm::dvec3 world) const {
        return gradient(of, world, of.part(cells(world)));
    }
    LensAction lensAction(const DrawnLayer& layer, glm::dvec3 world) const {
        return vis::lensAction(lenses, layer.lens, world);
    }
    /// Factor on a layer's opacity.
    double opacityFactor(const DrawnLayer& layer, const Interest& doi) const {
        return brushedOpacity(layer.brushes, double(scene.selection.contextOpacity), doi.doi);
    }
    /// A layer's colour as brushes and lenses leave it.
    glm::dvec3 focused(const DrawnLayer& layer, glm::dvec3 color, const Interest& doi, double saturation) const;
};

} // namespace tessera::vis::reference
