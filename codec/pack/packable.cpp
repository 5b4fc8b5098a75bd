#include "codec/pack/packable.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace tessera::codec {

using volume::LatticeKind;

void requirePackable(const volume::DatasetInfo& source, const PackOptions& options) {
    if (source.parameters.empty() || source.times.empty()) throw Error("there is nothing to pack");
    for (int axis = 0; axis < 3; ++axis) {
        if (source.lattice.size[axis] < 1) throw Error("there are no samples to pack");
        const double spacing = source.lattice.spacing[axis];
        if (!(spacing > 0) || !std::isfinite(spacing)) throw Error("the spacing must be finite and greater than 0");
        if (!std::isfinite(source.lattice.origin[axis])) throw Error("the origin must be finite");
    }
    if (!std::ranges::all_of(source.times, [](double time) { return std::isfinite(time); }) ||
        std::ranges::adjacent_find(source.times, std::greater_equal<>{}) != source.times.end())
        throw Error("the times must be finite and rise");
    if (!(options.maxError >= 0 && options.maxError < 1)) throw Error("the error bound must be from 0 to below 1");
    if (!(options.absError >= 0) || !(options.psnr >= 0)) throw Error("error bounds must not be negative");
    if (hasThreshold(options) && (options.psnr > 0 || options.sizeMb > 0))
        throw Error("a threshold can be combined with a bound on the error of samples, but not with a PSNR or a size");
    if (!options.lossless && isExact(options) && options.discard == 0)
        throw Error("without lossless, an error bound, a threshold or a limit of importance is needed");
    if (options.lattice == StoredLattice::CC && source.lattice.kind == LatticeKind::BCC)
        throw Error("the data lies on BCC; it cannot be packed as CC");
}

} // namespace tessera::codec
