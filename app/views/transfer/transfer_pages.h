#pragma once

#include "app/pane/view_context.h"
#include "app/queries/derivative_query.h"
#include "app/views/transfer/opacity_edit.h"
#include "app/views/transfer/region_edit.h"
#include "vis/gl/plot_texture.h"

#include <memory>
#include <vector>

/// The pages of the transfer function view that look at gradients. They edit a function of a channel's values.
namespace tessera::app {

/// Regions over the joint histogram of value and gradient magnitude.
struct RegionPage {
    RegionDrag drag;
    vis::PlotTexture picture;
    std::shared_ptr<const DerivativeResult> shown; ///< what the picture shows
    bool dark = true;                              ///< and for which theme
    bool fit = false; ///< find the top of the plane, and a first region where there is none
};
/// Does what page.fit asks for with the histogram of all gradients (its top reaches the largest), null while it is not
/// there.
void fitRegions(RegionPage& page, vis::TransferFunction& function,
                const std::shared_ptr<const DerivativeResult>& everything);
/// Whether a page of this width has the settings of the selected region beside the plane; else a tool opens them.
bool regionSettingsBeside(float room);
/// The settings of the selected region, and how one comes and goes.
void drawRegionSettings(ViewContext& context, RegionPage& page, vis::TransferFunction& function,
                        const volume::DatasetInfo& info);
void drawRegionPage(ViewContext& context, RegionPage& page, vis::TransferFunction& function,
                    const volume::DatasetInfo& info, int channel,
                    const std::shared_ptr<const DerivativeResult>& result);

/// The curves that find boundaries, and the emphasis b(x) that makes the opacity curve from them.
struct BoundaryPage {
    OpacityDrag drag;
    /// What the opacity curve was last made from: it is made again when one of these changes.
    std::vector<glm::vec2> emphasis;
    Range range;
    std::shared_ptr<const DerivativeResult> from;
    bool apply = false; ///< make it now, without a change: the page was just chosen
};
void drawBoundaryPage(ViewContext& context, BoundaryPage& page, vis::TransferFunction& function,
                      const volume::DatasetInfo& info, int channel,
                      const std::shared_ptr<const DerivativeResult>& result);

} // namespace tessera::app
