#pragma once

#include "app/session/picture_form.h"

#include <glm/vec2.hpp>
#include <string>

namespace tessera::app {

/// A picture of the window, or of one pane, at any size.
struct PictureRequest {
    std::string pane;            ///< "" = the whole window
    glm::ivec2 size{1920, 1080}; ///< pixels
    float scale = 1;             ///< pixels per design pixel
    bool controls = false;       ///< one pane with its rows of tools
    double dpi = 0; ///< pixels per inch on paper, where text has a size whatever that of the window; 0: none
    PictureGround ground = PictureGround::Shown;
    Decoration decoration = {};
};

/// The picture of a pane in a form. Throws Error where it, or its text, cannot be drawn so large or small.
PictureRequest pictureRequest(const PictureForm& form, const std::string& pane);

} // namespace tessera::app
