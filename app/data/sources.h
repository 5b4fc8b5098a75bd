#pragma once

#include "app/data/shown_sources.h"
#include "app/session/session.h"
#include "volume/base/progress.h"

#include <memory>
#include <string>
#include <vector>

namespace tessera::app {

/// What a session names, as it is drawn and as numbers are read from it; ranges known. Throws Error.
Sources openSources(const DataRef& data, std::vector<std::string>& messages, const Progress& progress = {});

/// An archive, with the names of regions that the session states, without derived parameters. Throws Error.
Sources openArchived(const DataRef& data, std::vector<std::string>& messages);

/// The same data with other derived parameters: `sources` have none. They are computed from the numbers, and drawn as
/// all others are; where pictures are no pictures of the numbers, from these as well, with the ranges of the numbers.
Sources deriveBoth(const Sources& sources, const std::vector<volume::DerivedParameter>& wanted,
                   std::vector<std::string>& messages, const Progress& progress = {});

/// The same without derived parameters.
Sources underived(const Sources& sources);

/// Whether pictures of data can be drawn on either lattice (DataRef::lattice): of a regular grid, also one that an
/// archive stores.
bool canChooseLattice(const DataRef& data, const volume::BrickSource& numbers, const NumberOrigin& origin);

/// The lattice that the pictures of data are drawn on.
PictureLattice latticeOf(const Sources& sources);
/// The same data drawn on another lattice; nothing is read again.
Sources drawnOn(PictureLattice lattice, const Sources& sources);

/// Data beside other data.
struct ComparedData {
    Sources sources;
    std::string channel; ///< whose difference has been derived; "" = none can be
};

/// Opens data with their other data (`data.other`), and with the difference of the channel that a session compares,
/// which is added to data.derived. Says where both are the same, and where nothing can be compared. Throws Error.
ComparedData openCompared(DataRef& data, const Session& session, std::vector<std::string>& messages,
                          const Progress& progress = {});

/// Data as they are drawn alone.
std::shared_ptr<const volume::BrickSource> openSource(const DataRef& data, std::vector<std::string>& messages,
                                                      const Progress& progress = {});

/// True where files or a model are named; true for one file that is an archive.
bool hasData(const DataRef& data);
bool isArchive(const DataRef& data);

} // namespace tessera::app
