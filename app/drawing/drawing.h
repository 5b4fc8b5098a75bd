#pragma once

#include "app/drawing/typeface.h"
#include "vis/image/image_io.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// A page as lines, rectangles, circles, texts and pictures: what plots and panes become in SVG and PDF. Lengths are
/// points of 1/72 inch from the upper left corner, y downwards; colours are sRGB with opacity, 0..1.
namespace tessera::app {

namespace shapes {

struct PageBox {
    glm::dvec2 lo{0}, hi{0};
};

/// A line through points; closed if the last is the first.
struct Stroke {
    std::vector<glm::dvec2> points;
    double width = 1;
    glm::vec4 color{0, 0, 0, 1};
};

/// The area within points.
struct Polygon {
    std::vector<glm::dvec2> points;
    glm::vec4 color{0, 0, 0, 1};
};

struct Rect {
    PageBox box;
    glm::vec4 color{0, 0, 0, 1};
    double line = 0; ///< width of its edge; 0: filled
};

struct Circle {
    glm::dvec2 center{0};
    double radius = 1;
    glm::vec4 color{0, 0, 0, 1};
    double line = 0; ///< width of its edge; 0: filled
};

struct Words {
    std::string text; ///< UTF-8, one line
    glm::dvec2 at{0}; ///< on the base line
    double size = 9;  ///< of an em
    glm::vec4 color{0, 0, 0, 1};
    Face face = Face::Text;
    double anchor = 0;   ///< share of the text that lies before `at`: 0, 0.5 or 1
    double angle = 0;    ///< degrees, clockwise
    double halo = 0;     ///< width of a half transparent white outline, for texts on pictures
    bool middle = false; ///< `at` is half the height of its capitals above the base line
};

inline constexpr double kMiddle = 0.35; ///< half the height of capitals, in ems
inline constexpr glm::vec4 kHalo{1, 1, 1, 0.5f};

/// A raster picture stretched over a box.
struct Picture {
    PageBox box;
    vis::Image image;
    bool smooth = true; ///< else its pixels are seen as they are
};

/// A shape on the page.
struct Mark {
    std::variant<Stroke, Polygon, Rect, Circle, Words, Picture> shape;
};

} // namespace shapes

struct VectorPage {
    glm::dvec2 size{0};
    std::vector<shapes::Mark> marks; ///< later ones cover earlier ones
    std::string numbers = {};        ///< where its numbers come from, one line
    std::string session = {};        ///< as saved, kept inside its file (embedded_session.h); "": none
};

/// As an SVG file; texts stay texts.
std::string svgOf(const VectorPage& drawing);

/// As a PDF file of one page, with the fonts it uses. Equal drawings become equal bytes. Throws MachineError.
std::string pdfOf(const VectorPage& drawing);

/// As a raster picture of so many pixels, which is the page without margins. Throws MachineError.
vis::Image imageOf(const VectorPage& drawing, glm::ivec2 pixels);

/// As a file with the suffix "svg" or "pdf".
std::string fileOf(const VectorPage& drawing, std::string_view suffix);

} // namespace tessera::app
