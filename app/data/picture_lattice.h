#pragma once

#include "app/session/session.h"
#include "volume/bricks/brick_source.h"

#include <memory>

namespace tessera::app {

/// Samples as pictures draw them; as they are where they lie on no regular grid, or on another machine, from which the
/// bricks around those that are seen would have to come, too. `lattice` as latticeFor() has it. `former`: pictures of
/// the same data before a change.
std::shared_ptr<const volume::BrickSource> drawnOn(const std::shared_ptr<const volume::BrickSource>& numbers,
                                                   PictureLattice lattice, const volume::BrickSource* former = nullptr);

/// The lattice that pictures of data are first drawn on, where none was chosen. Of uneven axes by cells where the
/// shortest cell is below a quarter of the mean one, so that thin layers are seen, else to scale; not body-centred,
/// since layers of a cell lie on one half of that lattice only and borders would look like a zigzag.
PictureLattice firstLattice(PictureLattice usual, const volume::DatasetInfo& numbers);

} // namespace tessera::app
