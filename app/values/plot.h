#pragma once

#include "app/ui/axis_scale.h"
#include "volume/base/describe.h"

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <string>
#include <vector>

/// A plot as a value: said once, and drawn on screen and on pages.
namespace tessera::app {

/// Factor on bright colours, such as those of brushes and lenses, which would vanish on white.
inline constexpr float kBrightOnWhite = 0.7f;

struct PlotAxis {
    std::string title; ///< with its unit, where that is not stated below
    Range range;
    bool numbered = true;  ///< categories are not
    std::string unit = {}; ///< written behind the title, which is cut off before it
    AxisScale scale = {};  ///< of an axis that is drawn by cells; range and values of the plot are its places
    std::optional<glm::vec3> ink = {}; ///< of its numbers and title: that of the only series it is for
    bool operator==(const PlotAxis& other) const = default;
};

struct PlotSeries {
    std::string name;
    std::vector<glm::dvec2> points; ///< NaN breaks a line; bars: centre and height
    glm::vec3 color{0};
    bool bars = false;
    bool dots = false;      ///< a dot at every point, beside the line
    std::string value = {}; ///< at the cursor; on screen it stands behind the name
    bool right = false;     ///< its values are those of the plot's right axis
};

/// A picture of cells between the ends of both axes: RGBA, row 0 at the top.
struct PlotImage {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

/// What the colours of a picture stand for.
struct PlotColorKey {
    std::vector<std::uint8_t> rgba; ///< from the highest value to the lowest; none: there is no key
    std::string highest = {}, lowest = {};
};

/// A text on a line, with a halo.
struct PlotLabel {
    std::string text;
    glm::dvec2 at{0}; ///< of its middle, in the values of the axes
    double angle = 0; ///< degrees, clockwise
};

/// A line whose width is a quantity, in the values of the axes; nowhere thinner than other lines.
struct PlotFlow {
    std::vector<glm::dvec2> points; ///< of its middle, from the left to the right
    std::vector<double> half;       ///< for each point half its width
    glm::vec4 color{0, 0, 0, 1};
};

/// A closed line, in the values of the axes; drawn where it lies between them.
struct PlotOutline {
    std::vector<glm::dvec2> points;
    glm::vec4 color{0, 0, 0, 1};
    bool dashed = false;
    std::optional<glm::dvec2> dot = {}; ///< marked
};

/// What a brush selects: values within both ranges, whose ends may be infinite.
struct PlotBand {
    Range x, y;
    glm::vec3 color{0};
    bool dashed = false; ///< it takes away, or is switched off
};

struct Plot {
    std::string title;
    PlotAxis x, y;
    std::vector<PlotSeries> series;
    PlotImage image;
    std::vector<glm::dvec2> marks = {}; ///< points with a ring: where the cursor is
    std::string note = {};              ///< a second line below the title
    std::vector<std::vector<glm::dvec2>> contours = {};
    std::vector<PlotLabel> labels = {};
    std::vector<PlotOutline> outlines = {};
    std::optional<double> cursorX = {}, cursorY = {}; ///< lines across the plot
    std::vector<PlotBand> brushed = {};
    PlotColorKey key = {};              ///< of the picture
    std::vector<PlotFlow> flows = {};   ///< below the series
    bool framed = true;                 ///< else what it holds stands without frame and axes
    std::optional<PlotAxis> right = {}; ///< a second vertical axis, of some of the series

    /// The vertical axis of a series.
    const PlotAxis& upOf(const PlotSeries& each) const { return each.right && right ? *right : y; }
};

/// Colour of the nth series of a plot, on a light or dark ground.
inline glm::vec3 plotInk(std::size_t n, bool dark) {
    static constexpr std::array<std::array<glm::vec3, 2>, 6> kInks{{{{{0.8f, 0.33f, 0.1f}, {1, 0.62f, 0.3f}}},
                                                                    {{{0.1f, 0.36f, 0.62f}, {0.45f, 0.68f, 0.98f}}},
                                                                    {{{0.15f, 0.5f, 0.25f}, {0.45f, 0.78f, 0.5f}}},
                                                                    {{{0.5f, 0.25f, 0.6f}, {0.78f, 0.6f, 0.92f}}},
                                                                    {{{0.5f, 0.4f, 0.1f}, {0.85f, 0.78f, 0.4f}}},
                                                                    {{{0, 0, 0}, {0.95f, 0.95f, 0.95f}}}}};
    return kInks[n % kInks.size()][dark ? 1 : 0];
}

/// Colour of the nth of `count` states in order, from a sequential map, on a light or dark ground.
glm::vec3 stateInk(std::size_t n, std::size_t count, bool dark);

} // namespace tessera::app
