#pragma once

#include "app/pane/view_context.h"
#include "app/tools/camera_controller.h"

#include <optional>

/// The chain in the corner of a volume view: whether its camera, layers and time are shared, and a menu that changes
/// it.
namespace tessera::app {

class LinkControl {
public:
    /// `picture`: of the view, in whose upper right corner the chain hangs.
    LinkControl(const ViewContext& context, const VolumeView& view, const PictureBox& picture);

    /// Takes the mouse over it; before the item of the picture, which lies below.
    void take();
    /// Draws it over the picture; returns its corners, nothing where there is no chain.
    std::optional<std::pair<ImVec2, ImVec2>> draw(ImDrawList& list) const;
    /// Where the room beside it ends, pixels.
    float left() const { return shown_ ? min_.x : min_.x + size_.x; }

private:
    const ViewContext& context_;
    const VolumeView& view_;
    ImVec2 min_, size_;
    bool shown_ = false, hovered_ = false;
};

/// Draws the menu of the control, which edits the view. Call it outside of ShownScene.
void drawLinkMenu(ViewContext& context, VolumeView& view);

} // namespace tessera::app
