#pragma once

#include "app/queries/geometry_query.h"
#include "app/queries/strokes_query.h"

/// The scene that a 3D view draws, including everything computed outside the renderer.
namespace tessera::app {

class AsyncScene {
public:
    /// The session's scene with the theme's colours and the geometry and strokes of its layers, as far as they are
    /// made. Sets context.answers.awaiting while better shapes are on their way. `moving`: take what draws fast.
    vis::Scene get(ViewContext& context, const std::string& pane, bool moving);

private:
    AsyncGeometry geometry_;
    AsyncStrokes strokes_;
};

} // namespace tessera::app
