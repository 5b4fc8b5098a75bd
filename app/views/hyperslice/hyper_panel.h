#pragma once

#include "app/pane/view_context.h"
#include "app/planes/contour_labels.h"
#include "app/queries/async_query.h"
#include "app/views/hyperslice/hyper_data.h"
#include "vis/gl/plot_texture.h"

#include <array>
#include <functional>
#include <imgui.h>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// One panel of a matrix of slices: its picture, what lies over it, and the mouse in it.
namespace tessera::app {

/// What a panel keeps between frames.
struct HyperPanelState {
    AsyncQuery<HyperQuery, HyperValues> answers;
    /// What colours follow from.
    struct Look {
        vis::TransferFunction function;
        Range range;
        vis::Selection selection;
        vis::LensSpace lenses;
        bool operator==(const Look&) const = default;
    };
    std::shared_ptr<const HyperValues> pictured;
    Look look;
    vis::PlotTexture picture;

    std::shared_ptr<const HyperValues> lined; ///< that `pieces` and `labels` are of, on this page
    std::array<double, 9> page{};
    std::vector<double> levels;
    std::vector<std::vector<ImVec2>> pieces;
    std::vector<LineLabel> labels;
};

/// A panel as it is drawn.
struct HyperPanel {
    const HyperAxis &across, &up;
    PlotFrame frame;
    std::string key; ///< of its job
};

/// Draws the picture of a panel, its contour lines, the outlines of lenses and brushes where it is a plane of space,
/// and the cross-hair.
void drawHyperPanel(ViewContext& context, HyperPanelState& state,
                    const std::shared_ptr<const volume::BrickSource>& source, const HyperContent& content,
                    bool lineValues, const HyperPanel& panel);

struct HyperProfileState {
    AsyncQuery<ProfileAlongQuery, ProfileAlong> answers;
};

/// Draws the curve along an axis; values stand at the right.
void drawHyperProfile(ViewContext& context, HyperProfileState& state,
                      const std::shared_ptr<const volume::BrickSource>& source, int channel, const HyperAxis& axis,
                      const PlotFrame& frame, const std::string& key);

/// What the mouse does in the panels of a view: one drag at a time.
struct HyperDrag {
    int panel = -1;   ///< of the drag; -1: there is none
    bool box = false; ///< of a part to be shown, else of the cross-hair
    ImVec2 from{};
};

/// Takes the mouse over a panel: a drag moves the cross-hair and the time along its axes, with Shift it draws a box
/// which is shown whole then; the wheel zooms about the mouse, the middle button pans, and its double click shows all
/// of the axes. `up`: null for a profile. `menu`: what the right button opens.
void useHyperMouse(ViewContext& context, HyperSliceView& view, HyperDrag& drag, int index, const HyperAxis& across,
                   const HyperAxis* up, const PlotFrame& frame, const std::function<void()>& menu);

} // namespace tessera::app
