#pragma once

#include "app/session/session.h"
#include "volume/worth/finding.h"

#include <string>

/// Opens the view that shows a finding of the list of what is worth seeing.
namespace tessera::app {

/// Makes a brush the only one that is enabled; adds it where no equal region is brushed.
void brushAlone(Session& session, vis::Brush brush);

/// The view that shows a finding: scatterplots of a pair, slices through a place, the histogram of a parameter in the
/// selection, the table of regions, curves over the times.
ViewState viewOfFinding(const volume::Finding& finding, const volume::DatasetInfo& info);

/// Opens that view as a tab of the largest stack without the pane `from`, or brings an equal one to the front; moves
/// the cross-hair and the time to those of the finding. A place or a region of its own gets a brush, which becomes the
/// only one that is enabled. `searched`: index of the time that findings without one of their own are of. Returns the
/// pane.
std::string openFinding(Session& session, const volume::DatasetInfo& info, const volume::Finding& finding, int searched,
                        const std::string& from);

} // namespace tessera::app
