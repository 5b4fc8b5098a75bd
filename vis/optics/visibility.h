#pragma once

#include "vis/scene/camera.h"
#include "vis/transfer/transfer_function.h"
#include "volume/reconstruct/sample_grid.h"

#include <vector>

namespace tessera::vis {

/// Input of a visibility histogram of a composite layer.
struct VisibilityQuery {
    Camera camera;
    double aspect = 1; ///< width of the picture over its height
    glm::dvec3 stretch{1};
    TransferFunction function;
    Range range;        ///< of the bins: that of the transfer function
    double density = 1; ///< of the layer
    int bins = 96;
    int rays = 64; ///< rays along either edge of the picture

    bool operator==(const VisibilityQuery&) const = default;
};

/// Visibility histogram: per bin, the opacity that its samples contribute to the picture, the sum of alpha (1 -
/// accumulated alpha) along the rays over the number of rays that hit the box; the sum over all bins is the mean
/// opacity there. (C. D. Correa, K.-L. Ma: Visibility histograms and visibility-driven transfer functions, TVCG 17(2),
/// 2011.) Uses the 1D transfer function only, not regions. `bounds`: of the data set. Throws Cancelled.
std::vector<double> visibilityHistogram(const volume::SampleGrid& grid, const volume::Box& bounds,
                                        const VisibilityQuery& query, const Progress& progress = {});

} // namespace tessera::vis
