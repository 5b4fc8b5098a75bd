#pragma once

#include "app/session/session.h"

#include "volume/bricks/brick_source.h"

#include <string>
#include <vector>

/// The opacity curve by which a parameter is first shown, chosen from its values.
namespace tessera::app {

/// Whether a coarse level of the data can be read while the user waits: they are on this machine, and no larger than a
/// few million samples, or an archive.
bool isQuick(const Session& session, const volume::BrickSource& source);

/// The times that a curve is chosen from, so that it suits others than the one shown, too: the one shown and, of data
/// that are small or an archive, the first, the middle and the last.
std::vector<std::size_t> timesToLookAt(const Session& session, const volume::BrickSource& source);

/// Chooses the opacity curve of a channel's function; a function that is not the default one but for its colours stays,
/// as do those of labels. A scan, and what else is made of materials, shows all above its surroundings; values of both
/// signs get diverging colours about 0, and all other fields are a translucent body in which every value is seen
/// (vis/transfer/body_opacity.h). Whether it chose one; if a brick is damaged, nothing changes.
bool aimFunction(Session& session, const volume::BrickSource& source, const std::string& channel);

} // namespace tessera::app
