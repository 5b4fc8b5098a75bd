#pragma once

#include "app/drawing/drawing.h"
#include "app/values/page_form.h"
#include "app/values/plot.h"

/// Plots on a page.
namespace tessera::app {

/// What is between the axes of a plot of natural size, in points.
inline constexpr glm::dvec2 kFigurePlot{226, 176};

/// Plots in rows of `columns`; 0: as many as suit the page. They fill a form that has a size; there, and where
/// `shared`, plots below or beside each other that have an axis in common have its numbers once. Lists of series stand
/// in the plots where they cover nothing, else above them, or below all where all have the same. Throws Error where the
/// texts leave no room for the plots.
VectorPage plotPage(const std::vector<Plot>& plots, int columns, const PageForm& form, bool shared = false);

/// What is between the axes of each plot of that page, in points, where no list of series takes room.
glm::dvec2 plotArea(const std::vector<Plot>& plots, int columns, const PageForm& form, bool shared = false);

} // namespace tessera::app
