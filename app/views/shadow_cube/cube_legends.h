#pragma once

#include "app/pane/legend.h"
#include "app/views/shadow_cube/cube_faces.h"

#include <string>
#include <vector>

/// What the faces of the shadow cube show, in words, and what their colours mean.
namespace tessera::app {

/// A visible face that shows a parameter.
struct ShownFace {
    std::size_t face = 0; ///< in kCubeFaces
    int channel = 0;
    std::string title; ///< "mean T"; with the name of the face where another function colours the same on another face
};
std::vector<ShownFace> shownFaces(const Session& session, const CubeFrame& frame, const ShadowCubeView& view);

/// "slice", "mean", "maximum", "absorption", "shadow".
std::string kindName(WallKind kind);
/// What a face shows of a parameter: "mean T", "mean T over the drawing" where cells of its axis are not drawn to
/// scale.
std::string kindText(WallKind kind, const volume::DatasetInfo& info, int axis, const std::string& parameter);
/// As the session names a face of kCubeFaces: "left", "right", ...
std::string faceName(std::size_t face);

/// The legends of these faces, one for each function. One that is not that of the whole picture for its parameter, or
/// shows the share that is absorbed, has for its title those of its faces.
std::vector<LegendEntry> faceLegends(const Session& session, const volume::DatasetInfo& info,
                                     const ShadowCubeView& view, const std::vector<ShownFace>& faces);

} // namespace tessera::app
