#pragma once

#include "vis/transfer/transfer_function.h"
#include "volume/field/dataset.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// Adaptive sampling: in regions that are smooth under the transfer functions, one sample represents several.
///
/// The values in a block lie within known bounds, and therefore so do extinction t and emission t * colour per world
/// unit. Replacing shorter steps by one of length l changes the transmittance of its segment, and the light from it, by
/// less than l S, where S is the largest range of these bounds over all components; in a shaded layer light may change
/// by t, with less weight where values change by less than kFlatGradient per cell. For several layers S is the sum; and
/// since layers are composited one after the other within the segment, the result changes by another l^2 times the sum
/// over pairs of the product of their largest t. A block's step is the longest for which both together are at most
/// RenderParams::adaptiveStep. Along a ray the changes add up, each weighted by the transmittance before it.
///
/// Blocks have kStepBlock full-resolution texels a side; bounds cover all samples that interpolation inside reads. If a
/// channel has absent samples, the smallest t is 0. Sample k represents itself and the following samples inside its
/// block, in front of the next slice or surface, and within the block's step. Blocks that an iso-surface may cross keep
/// normal steps. Since looking up a block takes time, the shader uses longer steps only if at most about 0.6 of the
/// samples remain.
namespace tessera::vis {

struct Scene;

inline constexpr int kStepBlock = 4;

/// Bounds on the optical properties in a block, per world unit.
struct BlockMedium {
    double spread = 0;   ///< largest range of extinction, or of emission in a component
    double greatest = 0; ///< largest extinction
};

/// Bounds for the values in an interval, under a composite layer's transfer function.
class CurveMedium {
public:
    CurveMedium(const TransferFunction& function, Range range, double density, bool shaded);
    /// For an interval of positions in the transfer function (0..1 and beyond), in any order. `absent`: samples may be
    /// absent.
    BlockMedium between(double a, double b, bool absent) const;

private:
    using Bounds = std::array<float, 8>; ///< emission and extinction: minimum, maximum
    static Bounds both(const Bounds& a, const Bounds& b);
    std::vector<std::vector<Bounds>> levels_; ///< sparse table: entry i of level l covers nodes i .. i + 2^l - 1
    bool shaded_;
};

/// The longest step in world units through a block with these bounds per layer.
double longestStep(std::span<const BlockMedium> layers, double accepted);

/// Code of a step length: 0 if not longer than `unit`, else eighths of octaves above it, rounded down, at most
/// kMostSteps.
inline constexpr int kMostSteps = 127;
int stepCode(double step, double unit);
double stepOfCode(int code, double unit);
/// A unit shorter than any step worth representing.
double stepUnit(glm::dvec3 worldCell);

/// Whether a scene can have adaptive steps: only composite layers with 1D transfer functions (post- or pre-classified)
/// coloured by themselves, and iso-surfaces; no looks, lenses, clip holes, light volume or brushes that affect them.
bool stepsAdapt(const Scene& scene, const volume::DatasetInfo& info);

} // namespace tessera::vis
