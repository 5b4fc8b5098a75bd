#pragma once

#include "app/callouts/callout_place.h"
#include "app/pane/view_context.h"
#include "app/planes/plane_pane.h"
#include "app/queries/scene_query.h"
#include "app/queries/statistics_query.h"
#include "app/tools/camera_controller.h"

#include <string>

/// What stands in the box of a callout: a scene, a slice, a plot or a table.
namespace tessera::app {

/// A line of the data of which a callout shows a profile.
struct CalloutLine {
    int channel = 0;
    glm::dvec3 from{0}, to{0}; ///< physical
    volume::TimePair time;
    bool operator==(const CalloutLine&) const = default;
};

/// What a callout keeps between frames.
struct CalloutState {
    vis::ViewTargetPtr target;
    AsyncScene scene;
    PlaneState plane;
    AsyncStatistics statistics;
    AsyncQuery<CalloutLine, std::vector<double>> profile;
    ImVec2 last{0, 0}; ///< the mouse in the former frame
};

/// One callout in one frame of a view.
struct CalloutPart {
    Callout& callout;
    const CalloutPlace& place;
    CalloutState& state;
    std::string key;  ///< of its jobs
    PictureBox inner; ///< in its box, below the title
    double share = 0; ///< of the time for a frame
};

/// What it shows and where, to say as much as has room in `width` pixels: "T [K], z = 3.1 mm, 0.65 V".
std::string calloutTitle(const ViewContext& context, const Callout& callout, const CalloutPlace& place, float width);

/// Takes the mouse over its content: a drag turns a scene, with Ctrl the view too, and the wheel magnifies it; in a
/// slice a drag moves the cross-hair and the wheel a plane. True while something moves.
bool useCallout(ViewContext& context, const CalloutPart& shown);

/// Draws its content. `view`: the scene of the view, which callouts without layers and time of their own show.
void drawCallout(ViewContext& context, const CalloutPart& shown, const vis::Scene& view, bool moving);

} // namespace tessera::app
