#pragma once

#include "app/ui/axis_scale.h"
#include "app/ui/fitted_text.h"
#include "app/ui/theme.h"
#include "volume/base/describe.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <imgui.h>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// 2D plots on an ImDrawList: axes, density images, bars, cross-hairs. Sizes follow the font and colours the style, so
/// themes and high-resolution displays need nothing here.
namespace tessera::app {

/// A plot's data area on screen and the values at its edges. Pixels run down, values up.
struct PlotFrame {
    ImVec2 min, max; ///< corners in pixels, top left and bottom right
    Range x, y;

    ImVec2 pixel(double px, double py) const;
    glm::dvec2 data(ImVec2 at) const;
    bool contains(ImVec2 at) const;
    float width() const { return max.x - min.x; }
    float height() const { return max.y - min.y; }
    /// Values per pixel, for read-outs with as many digits as the mouse can resolve.
    double perPixelX() const { return (x.hi - x.lo) / std::max(1.0f, width()); }
    double perPixelY() const { return (y.hi - y.lo) / std::max(1.0f, height()); }
};

/// A range with room on both sides, never empty: for axes. A single value gets a range around it.
Range paddedRange(Range range, double share = 0);

/// Colours of plots that the ImGui style does not name, taken from its brightness.
struct PlotColors {
    ImU32 frame, grid, text, faint, bars, focus, cursor, brush, brushFill, backdrop;
};
PlotColors plotColors();
/// Those of bars of samples and of samples in focus, on a light or dark ground.
std::array<ImU32, 2> sampleColors(bool dark);

/// One em: the height of the font.
inline float em() {
    return ImGui::GetFontSize();
}
ImU32 toColor(std::array<double, 3> srgb, double alpha = 1);

enum class AxisSide { Bottom, Left };

/// What an inline title takes above the frame of a left axis, clear of a number at its upper end, in em.
inline constexpr float kTitleAbove = 1.5f;

struct AxisOptions {
    bool grid = false;        ///< faint lines across the frame
    bool inlineTitle = false; ///< the title in the row of the numbers (bottom) or above them (left): saves a line
    /// Pixels outside of the frame for a left axis, so that several have their titles in one column; 0 = as needed.
    float room = 0;
    bool noteElsewhere = false; ///< an axis without title: the caller writes axisNote()
    TickStyle ticks = {};
    AxisScale scale = {}; ///< numbers of an axis that is drawn by cells; values of the frame are its places
    ImU32 ink = 0;        ///< of numbers and title; 0: that of texts
};

/// Where the title of an axis is, with what its numbers must be read with.
enum class TitlePlace {
    Nowhere, ///< then the numbers are in full
    Elsewhere,
    Beside ///< in a line of its own
};

/// Pixels that drawAxis needs outside the frame for ticks, labels and title.
float axisRoom(AxisSide side, Range range, TitlePlace title, const AxisScale& scale = {});

/// What the numbers of an axis that is `length` pixels long must be read with ("+ 100000"); else "".
std::string axisNote(AxisSide side, Range range, float length, const AxisScale& scale = {});

/// Heights of plots below each other over one axis, pixels.
struct ColumnHeights {
    float all;    ///< more than the pane has where that must scroll
    float each;   ///< a plot with the gap below it
    float bottom; ///< the axis
    bool titled;  ///< it has its title in a line of its own, not in that of the numbers
};
/// For `room` pixels: plots and title as there is room, but no plot lower than its name.
ColumnHeights columnHeights(float room, std::size_t plots);

/// Ticks, labels and a title with unit along one side of a frame; numbers are in full where there is no title,
/// since nothing would say what they must be read with. Labels never overlap and never leave
/// [lo, hi] pixels along the axis: those at the ends are moved inwards.
void drawAxis(ImDrawList& draw, const PlotFrame& frame, AxisSide side, std::string_view title, std::string_view unit,
              float lo, float hi, const AxisOptions& options = {});

/// The same along the right side: `frame.y` has its range, and `room` pixels are free beside it (axisRoom of a left one
/// with its title beside). The title is left out where it is longer than the frame.
void drawRightAxis(ImDrawList& draw, const PlotFrame& frame, std::string_view title, std::string_view unit, float room,
                   ImU32 ink);

/// Text turned clockwise by an angle in radians, centred at a point.
void addTextTurned(ImDrawList& draw, ImVec2 center, float angle, ImU32 color, const char* text);

/// Text turned by 90 degrees, reading upwards, centred at a point.
void addTextUpwards(ImDrawList& draw, ImVec2 center, ImU32 color, const char* text);

/// Text with a translucent box behind it so that it stays legible on pictures. `pivot` 0..1 is the point of the text
/// that lies at `at`.
void addTextWithBackdrop(ImDrawList& draw, ImVec2 at, ImVec2 pivot, ImU32 color, const char* text);
/// The same, at most `width` pixels wide; the whole stands in a tooltip.
void addFittedWithBackdrop(ImDrawList& draw, ImVec2 at, ImVec2 pivot, ImU32 color, const std::string& text,
                           float width);

/// Bars from the bottom of the frame; heights 0..1 of the frame, equal widths over its x range.
void drawBars(ImDrawList& draw, const PlotFrame& frame, std::span<const float> heights, ImU32 color);

/// Lines through (x, y), NaN = outside of the plot; with a dot where they meet if both are inside. On a picture, whose
/// colours may be like theirs, they have a light or dark rim.
void drawCrosshair(ImDrawList& draw, const PlotFrame& frame, double x, double y, bool onPicture = false);

/// Colours of a density plot, row 0 at the top (the largest y): transparent where no sample is, else the density from
/// faint to full, hue by the share of focus. `counts` and `focus` have size x size bins, x fastest, row 0 = lowest y;
/// `focus` may be empty (nothing brushed). Every `merge` x `merge` bins become one pixel, so that a small plot shows
/// every sample; returns the pixels a side. `focusColor` is the hue of the focus.
int densityImage(std::span<const std::uint64_t> counts, std::span<const double> focus, int size, int merge,
                 bool logDensity, bool dark, ImU32 focusColor, std::vector<std::uint8_t>& rgba);

} // namespace tessera::app
