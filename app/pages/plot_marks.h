#pragma once

#include "app/drawing/drawing.h"
#include "app/drawing/typeface.h"
#include "app/values/page_form.h"
#include "app/values/plot.h"

#include <string>
#include <vector>

/// One plot as marks on a page.
namespace tessera::app {

inline constexpr double kFigureText = 9; ///< size of text on a page of natural size, points

/// Width of a text in points, in the font of pages.
inline double pageTextWidth(const std::string& text, double size = kFigureText) {
    return textWidth(text) * size;
}

/// Where the title of a vertical axis stands: beside its numbers, upwards; in a line above the plot; across, before the
/// numbers.
enum class UpTitle { Beside, Above, Across };

/// Where a plot stands on a page.
struct PlotPlace {
    shapes::PageBox box;                            ///< what is between its axes
    bool numbersBelow = true, numbersBeside = true; ///< else another plot has the numbers of an axis that they share
    bool acrossBelow = false; ///< the title of the horizontal axis is turned, as those of many narrow plots
    UpTitle up = UpTitle::Beside;
    double left = 0, bottom = 0; ///< room for numbers and titles, points
    double overhang = 0;         ///< how far numbers may stand over the sides
    double above = 0;            ///< between the plot and its title
    bool stacked = false;        ///< among others above and below: numbers beside it stay within its height
};

/// Height of a line of text where there are several, in sizes of text.
inline constexpr double kLineHeight = 1.15;

/// Colours of pages.
struct PageInks {
    glm::vec4 ground, text, frame, cursor;
};
PageInks pageInks(const PageForm& form);

/// The title of an axis with its unit.
std::string wholeAxisTitle(const PlotAxis& axis);
/// The same within a length in points: the title is cut off before its unit.
std::string fittedAxisTitle(const PlotAxis& axis, double length, double text);

/// Title and note of a plot in lines, which are no wider than a width where the page has a size.
std::vector<std::string> titleLines(const Plot& plot, double width, const PageForm& form);
/// From one of so many lines to the next, points.
double titleLine(std::size_t lines, const PageForm& form);

/// Room right of a plot for its second axis or the key of its colours, points.
double keyRoom(const Plot& plot, const PageForm& form);

/// Adds a plot without its list of series; returns how many of the marks come before those of the data.
std::size_t addPlot(std::vector<shapes::Mark>& out, const Plot& plot, const PlotPlace& place, const PageForm& form);

} // namespace tessera::app
