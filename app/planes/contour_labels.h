#pragma once

#include <cstddef>
#include <functional>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

/// Where the values of contour lines are written. A page has pixels or points, y downwards; nothing here draws.
namespace tessera::app {

struct PageLine {
    std::string text; ///< its value
    std::vector<glm::dvec2> points;
};

/// A text turned along its line, upright: its box is centred on a point of the line.
struct LineLabel {
    std::string text;
    std::size_t line = 0; ///< of the lines given
    double along = 0;     ///< length of the line up to its middle
    glm::dvec2 at{0};
    double angle = 0;   ///< radians, clockwise on the page, in (-pi/2, pi/2]
    glm::dvec2 half{0}; ///< half width and height of the box, which has a little room around the text
    bool operator==(const LineLabel&) const = default;
};

struct LabelPage {
    glm::dvec2 lo{0}, hi{0}; ///< corners that no box leaves
    double height = 0;       ///< of a text
    std::function<double(const std::string&)> width;
};

/// One label for each line that is long enough, more on very long ones: where it is straight, inside of the page, and
/// no other line or label is in the way. Lines where there is no such place have none.
std::vector<LineLabel> placeLabels(const std::vector<PageLine>& lines, const LabelPage& page);

/// The lines without what lies beneath their labels.
std::vector<std::vector<glm::dvec2>> linesAround(const std::vector<PageLine>& lines,
                                                 const std::vector<LineLabel>& labels);

} // namespace tessera::app
