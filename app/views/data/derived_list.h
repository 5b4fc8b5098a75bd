#pragma once

#include "app/pane/view_context.h"
#include "volume/derived/derived.h"

/// The panel of parameters computed from others.
namespace tessera::app {

/// The edited parameters; copied to the session when no field is active any more, so that an incomplete formula is
/// never computed.
struct DerivedDraft {
    std::vector<volume::DerivedParameter> parameters;
    std::vector<std::string> problems; ///< of each, for `checked`
    std::vector<volume::DerivedParameter> checked;
    bool edited = false;
};

void drawDerivedList(ViewContext& context, DerivedDraft& draft);

/// A derived parameter of the kind with that index (volume::kDerivedKinds) that can be computed at once where the data
/// allow it, with a name that is free.
volume::DerivedParameter newDerived(const volume::DatasetInfo& info, std::size_t kind, const std::string& channel);

/// Changes the name and unit that were given to a derived parameter as they follow from its recipe: the unit of a
/// formula, name and unit of a difference. What the user typed stays. `before`: the same before its recipe changed.
void followRecipe(volume::DerivedParameter& own, const volume::DerivedParameter& before,
                  const volume::DatasetInfo& info);

/// The derived parameter "T minus first": a channel minus itself at another time.
volume::DerivedParameter newDifference(const volume::DatasetInfo& info, const std::string& channel,
                                       const volume::TimeReference& from);

/// Adds that parameter and shows it: in the volume, the slice and the views of slices, at a time at which it is not 0
/// throughout. Returns what to tell the user.
std::string showDifference(Session& session, const volume::DatasetInfo& info, const std::string& channel,
                           const volume::TimeReference& from);

/// Adds a parameter to the session's derived ones and gives it colours; one computed alike is not added again. Returns
/// its name.
std::string addDerived(Session& session, const volume::DerivedParameter& wanted);

} // namespace tessera::app
