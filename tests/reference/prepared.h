#pragma once

#include "tests/reference/options.h"
#include "vis/optics/adaptive_step.h"
#include "vis/optics/look_sample.h"
#include "vis/optics/preintegration.h"
#include "vis/optics/ray_setup.h"
#include "vis/optics/shade.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace tessera::vis::reference {

/// A layer with everything needed to draw it.
struct DrawnLayer {
    const Technique* technique = nullptr;
    const Samples* samples = nullptr;
    Range range;
    const TransferFunction* function = nullptr;
    BrushEffect brushes = BrushEffect::Fade;
    int lens = -1; ///< index into Prepared::lenses of the lens that it is drawn in, -1: everywhere
    Plane plane;   ///< of a slice
    const StrokePicture* strokes = nullptr;     ///< of a slice
    std::optional<IntegralFunctions> integrals; ///< for pre-integrated layers
    const Samples* colors = nullptr;            ///< the channel that colours it; null: its own
    Range colorRange;
    const TransferFunction* colorFunction = nullptr;
    Classification classification = Classification::Post;

    /// Position in the transfer function's range, not clamped to 0..1; 1/2 if the range has no width.
    double unclamped(double value) const;
    /// Position in the transfer function's range, 0..1.
    double place(double value) const;
    /// Colour (linear light) and opacity of a value by the 1D transfer function.
    glm::dvec4 classify(double value) const;
    /// The same for a position in the range, 0..1.
    glm::dvec4 classifyPlace(double place) const;
};

/// Degree of interest of a position; colour (linear) of the brush that holds it most, and how much that is.
struct Interest {
    double doi = 1;
    glm::dvec3 color{0};
    double held = 0;
    /// Degree of interest used for context blur of a layer.
    double seen(const DrawnLayer& layer) const { return layer.brushes == BrushEffect::None ? 1 : doi; }
};

/// A scene prepared for casting rays.
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
    glm::dvec3 middle{0, 0, -1}; ///< central view direction
    /// By channel name, time, and whether unfiltered, for pre-classification.
    std::map<std::tuple<std::string, double, bool>, std::unique_ptr<Samples>> samples;
    std::vector<DrawnLayer> layers;
    /// Step codes of blocks (vis/optics/adaptive_step.h), x fastest; empty: no adaptive steps.
    std::vector<std::uint8_t> steps;
    glm::ivec3 blocks{0};
    DoiFunction interestOf;
    std::vector<const Samples*> brushed; ///< of interestOf.channels(); null: unknown

    /// Throws Error when the source does.
    Prepared(const Scene& drawn, const volume::BrickSource& source, glm::ivec2 size, const Options& wanted);

    /// The position whose data are seen at a world point: physical, and in cells.
    glm::dvec3 physical(glm::dvec3 world) const { return frame.toPhysical(bend(lenses, world, frame.halfSize)); }
    glm::dvec3 cells(glm::dvec3 world) const { return straightCells(bend(lenses, world, frame.halfSize)); }
    /// The same where no lens bends the picture.
    glm::dvec3 straightCells(glm::dvec3 world) const { return lattice.cellsOfSheet(frame.worldToSheet(world)); }
    void findSteps();
    /// The longest step in world units through a block.
    double stepAt(glm::ivec3 block) const;
    /// Extinction of every cell of a light grid, see vis/optics/light_volume.h.
    Medium<double> medium(const LightGrid& grid) const;
    /// Degree of interest at a world point.
    Interest interest(glm::dvec3 world) const;
    /// Length of the change over one worldCell edge per axis, in ranges of the layer's transfer function.
    double steepness(const DrawnLayer& layer, glm::dvec3 world) const;
    /// Gradient magnitude relative to gradientTop, 0..1 or above.
    double steepPlace(const DrawnLayer& layer, glm::dvec3 world) const {
        return steepness(layer, world) / double(layer.function->gradientTop);
    }
    /// Colour (linear light) and opacity of a volume layer at a position, post-classified.
    glm::dvec4 colorAt(const DrawnLayer& layer, double value, glm::dvec3 world) const;
    /// Colour (linear light) of a layer for a value of its colour channel; nullopt: absent, then the layer's plain
    /// colour.
    static glm::dvec3 tint(const DrawnLayer& layer, std::optional<double> value);
    /// Colour (linear light) of a layer at a position; `own` if no other channel gives it.
    glm::dvec3 tinted(const DrawnLayer& layer, glm::dvec3 own, glm::dvec3 world) const {
        return layer.colors ? tint(layer, layer.colors->value(cells(world))) : own;
    }
    /// Gradient of a channel as displayed, per cell of the sublattice and axis, from the samples of one part.
    glm::dvec3 gradient(const Samples& of, glm::dvec3 world, int part) const {
        const auto seen = [&](glm::dvec3 at) {
            return of.ofPart(part, cells(frame.sheetToWorld(lattice.sheetOfCells(at))));
        };
        return volume::gradient(seen, straightCells(world),
                                volume::gradientStencil(lattice.kind, scene.render.gradient));
    }
    /// The same of the field smoothed over `width` voxels, from positions within the box. `narrow`: the unsmoothed one.
    glm::dvec3 smoothGradient(const Samples& of, glm::dvec3 world, int part, double width, glm::dvec3 narrow) const {
        const auto seen = [&](glm::dvec3 at) {
            const glm::dvec3 place = frame.sheetToWorld(lattice.sheetOfCells(at));
            return of.ofPart(part, cells(glm::clamp(place, -frame.halfSize, frame.halfSize)));
        };
        return volume::smoothGradient(seen, straightCells(world), volume::smoothReach(lattice.kind, width), narrow);
    }
    /// The value of a part beside a place, within the box.
    volume::FoundValue<double, bool> beside(const Samples& of, glm::dvec3 world, int part, glm::dvec3 offset) const {
        const auto found = of.ofPart(part, cells(glm::clamp(world + offset, -frame.halfSize, frame.halfSize)));
        return {found.value_or(0), found.has_value()};
    }
    /// The gradient within the part that the position belongs to.
    glm::dvec3 gradient(const Samples& of, glm::dvec3 world) const {
        return gradient(of, world, of.part(cells(world)));
    }
    LensAction lensAction(const DrawnLayer& layer, glm::dvec3 world, double doi) const {
        return vis::lensAction(lenses, layer.lens, world, doi);
    }
    /// Opacity factor of a layer from its degree of interest and lenses.
    double opacityFactor(const DrawnLayer& layer, const Interest& doi) const {
        return brushedOpacity(layer.brushes, double(scene.selection.contextOpacity), doi.doi);
    }
    /// A layer's colour after brushes and lenses.
    glm::dvec3 focused(const DrawnLayer& layer, glm::dvec3 color, const Interest& doi, double saturation) const;
};

} // namespace tessera::vis::reference
