#include "app/data/picture_lattice.h"

#include "volume/field/own_axes.h"
#include "volume/sources/centred_source.h"
#include "volume/sources/even_source.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

/// Samples on the even grid over the box of uneven axes. Frames are resampled as a whole: so many samples have room.
std::shared_ptr<const volume::BrickSource> resampledEven(const std::shared_ptr<const volume::BrickSource>& numbers) {
    const double samples = double(numbers->info().lattice.count());
    const volume::EvenLimits limits{.samples = std::clamp(8 * samples, 4e6, 16e6)};
    return volume::makeMemorySource(volume::onEvenGrid(numbers, limits), {});
}

} // namespace

std::shared_ptr<const volume::BrickSource> drawnOn(const std::shared_ptr<const volume::BrickSource>& numbers,
                                                   PictureLattice lattice, const volume::BrickSource* former) {
    constexpr std::size_t kBricksMade = std::size_t(1) << 29; // bytes kept
    lattice = latticeFor(lattice, numbers->info());
    if (lattice == PictureLattice::Even) return resampledEven(numbers);
    if (lattice != PictureLattice::BodyCentred || numbers->info().remote || !volume::canBeCentred(*numbers))
        return numbers;
    return volume::makeCentredSource(numbers, kBricksMade, former);
}

PictureLattice firstLattice(PictureLattice usual, const volume::DatasetInfo& numbers) {
    constexpr double kStrong = 4; // mean length of the cells along an axis, in the least
    if (numbers.lattice.isEven()) return latticeFor(usual, numbers);
    for (int axis = 0; axis < 3; ++axis) {
        if (!numbers.lattice.axes[axis]) continue;
        const double least = volume::cellLengthsAlong(numbers.lattice, axis).least;
        if (least * kStrong < std::abs(numbers.lattice.spacing[axis])) return PictureLattice::Grid;
    }
    return latticeFor(PictureLattice::Even, numbers);
}

} // namespace tessera::app
