#pragma once

#include "app/views/shadow_cube/cube_faces.h"

#include <array>

/// The menu of one face of the shadow cube: what it shows. A click on its title opens it, or the right button on it.
namespace tessera::app {

struct FaceMenu {
    std::size_t face = 0; ///< whose menu is open
    /// Corners of the titles in the last frame, in the order of kCubeFaces; none of faces without one.
    std::array<std::optional<std::pair<ImVec2, ImVec2>>, 6> titles;
};

/// The face that a pixel belongs to: by its title, or else by what of it is seen there.
std::optional<std::size_t> titledFace(const FaceMenu& menu, ImVec2 at);
std::optional<std::size_t> faceAt(const FaceMenu& menu, const CubeFrame& frame, ImVec2 at);

void openFaceMenu(FaceMenu& menu, std::size_t face);
void drawFaceMenu(const FaceMenu& menu, const CubeFrame& frame, Session& session, ShadowCubeView& view);

/// The settings of the cube and of all its faces.
void drawFaceSettings(Session& session, const volume::DatasetInfo& info, ShadowCubeView& view);

/// A title under the mouse is lit: it can be clicked.
void lightFaceTitle(ImDrawList& draw, const FaceMenu& menu, std::size_t face);

} // namespace tessera::app
