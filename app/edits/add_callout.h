#pragma once

#include "app/session/session.h"

#include <string>

/// Callouts that are added by one click, and that go with the lens or brush that they show.
namespace tessera::app {

/// Whether another callout has room.
bool takesCallout(const Session& session);

/// Adds a callout of a lens, brush or plane: the scene of a body, the slice of a plane. A further one of the same
/// placeholder shows a slice of a parameter that none of them shows yet. Volume views show callouts from then on.
/// Returns its place in the list.
std::size_t addCallout(Session& session, const volume::DatasetInfo& info, CalloutOf of, const std::string& placeholder);

/// The first scalar parameter that no callout of a placeholder shows yet; where all are shown, the first. "" if there
/// is none. Callouts that show what the view shows have the parameter of its first layer.
std::string parameterToCompare(const Session& session, const volume::DatasetInfo& info, CalloutOf of,
                               const std::string& placeholder);

/// The plane that a callout shows without being told which: an oblique slice, else that of the first visible slice of
/// an axis, else across z.
std::string firstPlane(const Session& session);

/// The callouts of a placeholder follow its new name, or go with it.
void renameCallouts(Session& session, CalloutOf of, const std::string& before, const std::string& now);
void removeCallouts(Session& session, CalloutOf of, const std::string& placeholder);

} // namespace tessera::app
