#pragma once

#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"

#include <array>
#include <vector>

/// Convective balances of regions: what a flow carries into and out of them, sample by sample.
namespace tessera::volume {

struct BalanceQuery {
    int channel = 0;                      ///< of what is carried, e.g. a concentration c
    std::array<int, 3> velocity{0, 0, 0}; ///< channels of the components of the velocity U
    int label = -1;                       ///< channel of a label; -1: the whole box is one region
    std::vector<int> regions;             ///< of its values, in the order wanted
    int time = 0;
    double carriedError = 0;                         ///< bound on the error of each sample of what is carried
    std::array<double, 3> velocityError{0, 0, 0};    ///< and of the components of the velocity
    std::size_t cacheBytes = std::size_t(256) << 20; ///< of bricks that are kept, since neighbours need them again
};

/// Flux through one surface of a region, as integrals of c U.n dA, with n pointing out of the region.
struct Crossing {
    double area = 0;        ///< where c and U exist (on both sides of a border, but for RegionBalance::absent)
    double in = 0, out = 0; ///< parts that flow in and out, neither negative where c is not
    double flow = 0;        ///< volume flow, out less in
    double error = 0;       ///< bound on the errors of in, out and net, if samples are within the bounds of the query
    double flowError = 0;   ///< and on that of flow
    double net() const { return out - in; }
};

struct BorderCrossing {
    int region = 0; ///< the label value on the other side
    Crossing crossing;
};

struct RegionBalance {
    int region = 0;
    std::array<Crossing, 6> faces;       ///< of the box: x from below, x from above, y ...
    std::vector<BorderCrossing> borders; ///< to other regions, by rising label value
    Crossing absent;                     ///< to where c or U is absent
    Crossing unlabelled;                 ///< to where the label is absent, but neither c nor U
    double volume = 0;                   ///< of its samples that have c
    double amount = 0;                   ///< integral of c over them
    double amountError = 0;              ///< bound on its error

    Crossing total() const;
    /// Outflow minus inflow: the amount produced inside (negative: consumed), if nothing is stored and all transport is
    /// convection.
    double residual() const { return total().net(); }
};

/// Flux through each surface by the midpoint rule: a face of the box uses the values of the first or last samples, each
/// times the area of its cell; the border between neighbouring samples of two regions uses the mean of c U.n of both,
/// on uneven axes the value of the straight line between both at the border. Where c or U is absent on the other side,
/// whatever region is there, c U.n is continued to the border by the straight line through the sample and the one
/// before it (constant where that is absent), so that nothing flows through walls. On BCC each sublattice is integrated
/// by itself and both are averaged. Convection only: diffusion, and changes of what is stored over time, are in the
/// residual. Throws Error, Cancelled.
std::vector<RegionBalance> computeBalance(const BrickSource& source, const BalanceQuery& query,
                                          const Progress& progress = {});

} // namespace tessera::volume
