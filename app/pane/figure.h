#pragma once

#include "app/drawing/drawing.h"
#include "app/pane/tool_row.h"
#include "volume/base/csv_text.h"
#include "volume/base/describe.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>

/// Plots as vector graphics and tables, for export.
namespace tessera::app {

struct FigureAxis {
    std::string title; ///< with its unit
    Range range;
    bool numbered = true; ///< categories are not
};

struct FigureSeries {
    std::string name;
    std::vector<glm::dvec2> points; ///< NaN breaks a line; bars: centre and height
    glm::vec3 color{0};
    bool bars = false;
    bool dots = false; ///< a dot at every point, beside the line
};

/// A picture of cells between the ends of both axes: RGBA, row 0 at the top.
struct FigureImage {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

/// A text on a line, with a halo.
struct FigureLabel {
    std::string text;
    glm::dvec2 at{0}; ///< of its middle, in the values of the axes
    double angle = 0; ///< degrees, clockwise
};

/// A closed line, in the values of the axes; drawn where it lies between them.
struct FigureOutline {
    std::vector<glm::dvec2> points;
    glm::vec4 color{0, 0, 0, 1};
    bool dashed = false;
    std::optional<glm::dvec2> dot = {}; ///< marked
};

struct FigurePanel {
    std::string title;
    FigureAxis x, y;
    std::vector<FigureSeries> series;
    FigureImage image;
    std::vector<glm::dvec2> marks = {}; ///< points with a ring
    std::string note = {};              ///< a second line below the title
    std::vector<std::vector<glm::dvec2>> contours = {};
    std::vector<FigureLabel> labels = {};
    std::vector<FigureOutline> outlines = {};
};

/// What is between the axes of a panel, and the height of texts, in points.
inline constexpr glm::dvec2 kFigurePlot{226, 176};
inline constexpr double kFigureText = 9;
/// Approximate width of a text in points, in the font of figures.
double figureTextWidth(const std::string& text);

/// Panels in rows of `columns`, black on white. The lists of series stand in the plots where they cover nothing, else
/// beside them.
VectorPage drawingOf(const std::vector<FigurePanel>& panels, int columns);

/// A number for CSV, empty where it is not finite.
std::string csvNumber(double value);

/// A tool whose menu exports what a view shows: its picture, vector graphics, a table. `atOneTime`: it shows the time
/// of the session alone, which tables then state. `numbers`: where they come from, if not all from the samples.
void exportMenu(ViewContext& context, ToolRow& tools, ViewExport made, bool atOneTime = true,
                const std::string& numbers = {});

} // namespace tessera::app
