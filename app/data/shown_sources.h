#pragma once

#include "app/data/number_origin.h"
#include "volume/bricks/brick_source.h"

#include <memory>
#include <utility>

namespace tessera::app {

/// The sources of a document. Both have the same parameters (including derived ones) and times.
struct Sources {
    std::shared_ptr<const volume::BrickSource>
        pictures; ///< on the lattice that pictures are drawn from, packed if asked
    /// Read by statistics, plots, profiles, read-outs and exports: the samples as computed where available (data files
    /// on their own grid, built-in models), else those of the archive. May be `pictures`.
    std::shared_ptr<const volume::BrickSource> numbers;
    NumberOrigin origin = {}; ///< of the numbers
    /// Of data shown as an archive would store them (DataRef::packed): what the archive gives at the points of the
    /// file. Null for others, and where they are shown beside the originals.
    std::shared_ptr<const volume::BrickSource> packed = {};

    Sources() = default;
    /// Numbers come from what is drawn.
    template <class Source>
    Sources(std::shared_ptr<Source> both) // NOLINT: as implicit as the pointers' own conversions
        : pictures(std::move(both)), numbers(pictures) {}
    Sources(std::shared_ptr<const volume::BrickSource> drawn, std::shared_ptr<const volume::BrickSource> read,
            NumberOrigin readFrom = {})
        : pictures(std::move(drawn)), numbers(read ? std::move(read) : pictures), origin(std::move(readFrom)) {}
};

} // namespace tessera::app
