#pragma once

#include "app/session/session.h"

#include <vector>

/// Edits of the brushes as a chain, in which each splits what the ones before it select.
namespace tessera::app {

/// Selects a branch: what is inside or outside of each of the first brushes, all of which must hold. The others are
/// switched off.
void selectBranch(Session& session, const std::vector<bool>& inside);

/// Switches the first `count` brushes on and the others off.
void selectLevel(Session& session, std::size_t count);

/// Moves a brush by one place in the chain. Does nothing where there is no such place.
void moveBrush(Session& session, std::size_t brush, int by);

} // namespace tessera::app
