#pragma once

#include "vis/scene/camera.h"
#include "vis/transfer/transfer_function.h"
#include "volume/reconstruct/sample_grid.h"

#include <vector>

namespace tessera::vis {

/// How much of what a viewer sees of a composite layer comes from which values.
struct VisibilityQuery {
    Camera camera;
    double aspect = 1; ///< width of the picture over its height
    glm::dvec3 stretch{1};
    TransferFunction function;
    Range range;        ///< of the bins: the function's
    double density = 1; ///< of the layer
    int bins = 96;
    int rays = 64; ///< along either edge of the picture

    bool operator==(const VisibilityQuery&) const = default;
};

/// Of each bin, the opacity that its samples add to the picture: sum of alpha (1 - accumulated alpha) along the rays
/// over the number of rays that meet the box; the sum of all bins is the mean opacity there. (C. D. Correa, K.-L. Ma:
/// Visibility histograms and visibility-driven transfer functions, TVCG 17(2), 2011.) By the curve alone: regions of
/// gradients are not told apart. `bounds`: of the data set. Throws Cancelled.
std::vector<double> visibilityHistogram(const volume::SampleGrid& grid, const volume::Box& bounds,
                                        const VisibilityQuery& query, const Progress& progress = {});

} // namespace tessera::vis
