#pragma once

#include "app/session/session.h"
#include "volume/derived/derived_recipe.h"

#include <string>

/// What is drawn of a parameter that has just been made.
namespace tessera::app {

/// A layer's name that is made of its parameter ("O2", "O2 slice", "Volume of O2") follows when another is chosen.
void followChannel(std::string& name, const std::string& before, const std::string& now);

/// Shows a parameter, with its own colours, in the first volume and the first slice among the layers that belong to no
/// lens, and in the views of slices and of the transfer function. Where there is no such volume, it is added.
void showParameter(Session& session, const std::string& channel);

/// Where a difference from another time is 0 throughout or absent at the time shown, goes to the last time, or from
/// there to the first; where there is nothing before the first, to the second. True where the time has changed.
bool leaveReference(Session& session, const volume::DatasetInfo& info, const volume::TimeReference& from);

} // namespace tessera::app
