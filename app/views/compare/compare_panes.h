#pragma once

#include "app/views/compare/compare_layout.h"

/// Views other than the 3D scene, such as slices and plots, shown once for each variant.
namespace tessera::app {

/// Whether a view shows data in a way that variants can be compared by.
bool canBeCompared(const ViewState& view);

/// The mode that is drawn: of other views than the 3D scene side by side, or in turn.
CompareMode modeOf(const CompareView& view);

/// Draws the view of the pane `shows` in `box` with the session and data of a variant. What hands do there to the
/// time, the cross-hair, the camera, the brushes and the view itself is done to the session, so that all variants
/// follow. `pane` is that of the comparison.
void drawComparedPane(ViewContext& context, const std::string& pane, const std::string& shows, std::size_t index,
                      CompareCell& cell, const PictureBox& box);

/// The colour bars of that view for some variants, which drawComparedPane leaves out; see variantLegends.
CompareLegends paneLegends(const ViewContext& context, const std::string& shows,
                           const std::vector<std::shared_ptr<CompareCell>>& cells,
                           const std::vector<std::size_t>& shown);

} // namespace tessera::app
