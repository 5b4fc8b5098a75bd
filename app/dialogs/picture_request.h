#pragma once

#include <glm/vec2.hpp>
#include <string>

namespace tessera::app {

/// A picture of the window, or of one pane, at any size.
struct PictureRequest {
    std::string pane;            ///< "" = the whole window
    glm::ivec2 size{1920, 1080}; ///< pixels
    float scale = 1;             ///< pixels per design pixel
    bool controls = false;       ///< one pane with its rows of tools
};

} // namespace tessera::app
