#pragma once

#include "app/drawing/drawing.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <string>
#include <vector>

/// Several pages as the panels of one figure, lettered a, b, c.
namespace tessera::app {

struct PanelPlace {
    glm::ivec2 lo{0}, hi{0}; ///< pixels, from the upper left corner
    glm::ivec2 letter{0};    ///< on the base line
};

/// The most columns whose panels are not much higher than wide.
int usualColumns(int panels);

/// Places of `panels` equal panels in rows in a figure of `size` pixels, each below a strip for its letter; `text`:
/// size of an em in pixels. Throws Error where that leaves panels less than 16 pixels high or wide.
std::vector<PanelPlace> panelPlaces(glm::ivec2 size, int panels, int columns, double text);

/// What a title above a figure takes of its height, points; `text`: size of an em.
double titleHeight(const std::string& title, double width, double text);
/// A page with a title above it, in the middle: so much higher than the page.
VectorPage titledPage(VectorPage page, const std::string& title, double text, glm::vec4 ground, glm::vec4 ink);

/// The letters of panels: a to z, then aa.
std::string panelLetter(int panel);

/// A figure of `size` points with pages at their places, `points` per pixel, and letters of `text` points. Pages fill
/// their places in one direction.
VectorPage figureOfPanels(glm::dvec2 size, const std::vector<PanelPlace>& places, const std::vector<VectorPage>& pages,
                          double points, double text, glm::vec4 ground, glm::vec4 ink);

} // namespace tessera::app
