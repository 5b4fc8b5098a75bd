#pragma once

#include "app/pages/plot_page.h"
#include "app/pane/tool_row.h"
#include "volume/base/csv_text.h"

#include <cmath>
#include <cstdio>

/// Names until every view says Plot, plotPage and Table.
namespace tessera::app {

using FigureAxis = PlotAxis;
using FigureSeries = PlotSeries;
using FigureImage = PlotImage;
using FigureLabel = PlotLabel;
using FigureOutline = PlotOutline;
using FigurePanel = Plot;

inline double figureTextWidth(const std::string& text) {
    return pageTextWidth(text);
}

inline VectorPage drawingOf(const std::vector<Plot>& plots, int columns) {
    return plotPage(plots, columns, {});
}

/// A number for CSV, empty where it is not finite.
inline std::string csvNumber(double value) {
    if (!std::isfinite(value)) return {};
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

} // namespace tessera::app
