#pragma once

#include "app/callouts/callout_place.h"
#include "app/pane/view_context.h"
#include "app/planes/plane_pane.h"
#include "app/queries/scene_query.h"
#include "app/queries/statistics_query.h"
#include "app/tools/camera_controller.h"

#include <string>

/// What is known of a callout in a frame, and kept between frames.
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

} // namespace tessera::app
