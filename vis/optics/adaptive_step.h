#pragma once

#include "vis/transfer/transfer_function.h"
#include "volume/field/dataset.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// Longer steps where volumes are smooth under their transfer functions: one sample, in the middle, stands for several.
///
/// Values within a block of samples lie between bounds, and so do extinction t and emission t * colour per world unit.
/// One step of length l in place of shorter ones changes the transparency of what it passes, and the light from it, by
/// less than l S, S the greatest difference between those bounds of any component; of a shaded layer light may change
/// by as much as t, fading out where values change by less than kFlatGradient per cell. Of several layers S is the sum,
/// and that the part of one now lies before that of the next changes them by less than l^2 times the sum over pairs of
/// the product of their greatest t. A block's step is the longest for which both together are no more than
/// RenderParams::adaptiveStep. What the steps of a ray change adds up, each weighted by the transparency before it.
///
/// Blocks are kStepBlock texels of full resolution a side; bounds are those of all samples that interpolation within
/// reads. Where a channel has absent samples the least t is 0. Sample k stands for itself and for those behind it that
/// lie in its block, before the next slice or surface, and within the block's step. Blocks that an iso-surface may pass
/// keep their steps. The shader, to which looking up a block costs time, has longer steps only in scenes where about
/// 0.6 of the samples or less are left.
namespace tessera::vis {

struct Scene;

inline constexpr int kStepBlock = 4;

/// Bounds of matter, per world unit.
struct BlockMatter {
    double spread = 0;   ///< greatest difference of extinction, or of emission in a component
    double greatest = 0; ///< extinction
};

/// What a composite layer's curve makes of values between two bounds.
class CurveMatter {
public:
    CurveMatter(const TransferFunction& function, Range range, double density, bool shaded);
    /// Of places of the transfer function (0..1 and beyond) between two, in any order. `absent`: samples may be too.
    BlockMatter between(double a, double b, bool absent) const;

private:
    using Bounds = std::array<float, 8>; ///< emission and extinction: the least, the greatest
    static Bounds both(const Bounds& a, const Bounds& b);
    std::vector<std::vector<Bounds>> levels_; ///< entry i of level l: of nodes i .. i + 2^l - 1
    bool shaded_;
};

/// The longest step, in world units, through a block with this matter of each layer.
double longestStep(std::span<const BlockMatter> layers, double accepted);

/// A step as one number: 0 where it is no longer than `unit`, else eighths of octaves over it, rounded down, at most
/// kMostSteps.
inline constexpr int kMostSteps = 127;
int stepCode(double step, double unit);
double stepOfCode(int code, double unit);
/// Shorter than any step that is worth it.
double stepUnit(glm::dvec3 worldCell);

/// Whether a scene has longer steps at all: composite layers by a curve of values (after interpolation or before it)
/// and of their own colours, and iso-surfaces, without looks, lenses, holes cut by clips, light inside the volume and
/// brushes that act on them.
bool stepsAdapt(const Scene& scene, const volume::DatasetInfo& info);

} // namespace tessera::vis
