#pragma once

#include "app/session/picture_form.h"

#include <glm/vec2.hpp>
#include <string>
#include <vector>

namespace tessera::app {

/// A picture of the window, of one pane or of several, at any size.
struct PictureRequest {
    std::string pane; ///< "" = the whole window
    /// Panes that are the panels of one figure, lettered, in place of one pane.
    std::vector<std::string> panels = {};
    int columns = 0;             ///< of panels; 0: usualColumns
    glm::ivec2 size{1920, 1080}; ///< pixels
    float scale = 1;             ///< pixels per design pixel
    double dpi = 0; ///< pixels per inch on paper, where text has a size whatever that of the window; 0: none
    PictureGround ground = PictureGround::Shown;
    Decoration decoration = {};
    PictureFormat format = PictureFormat::Png; ///< proposed
    bool fixed = false;                        ///< a table has this height, too, and not that of its rows
};

/// The panes that a picture shows; none: the whole window.
std::vector<std::string> panesOf(const PictureRequest& request);

/// The picture of a pane in a form. Throws Error where it, or its text, cannot be drawn so large or small.
PictureRequest pictureRequest(const PictureForm& form, const std::string& pane);

} // namespace tessera::app
