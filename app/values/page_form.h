#pragma once

#include "app/session/figure_settings.h"

#include <glm/vec2.hpp>

/// In what form a plot, a table or a slice is drawn on a page.
namespace tessera::app {

struct PageForm {
    glm::dvec2 size{0}; ///< of the page in points of 1/72 inch; 0: as large as what it shows is by itself
    double text = 9;    ///< size of text, points
    bool dark = false;  ///< light lines and text on the dark ground of the window
    bool legend = true, axes = true, title = true, cursor = true, outlines = true; ///< what is drawn over the data
    FigureSettings figure = {};                                                    ///< captions and numbers of axes
    bool fixed =
        false; ///< a table has the size, too: smaller texts where its rows need it; else it is as high as these
};

} // namespace tessera::app
