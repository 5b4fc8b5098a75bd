#pragma once

#include "app/data/number_origin.h"
#include "app/pages/plot_page.h"
#include "app/queries/statistics_query.h"
#include "app/values/table.h"
#include "volume/analysis/curves.h"

#include <optional>
#include <string>
#include <vector>

/// Data of the curves over time, as numbers, tables and vector graphics.
namespace tessera::app {

/// A value of a label: its channel and the value.
struct LabelRegion {
    int label = -1, value = 0;
    std::string name; ///< "region 1 (cathode)"
    bool operator==(const LabelRegion&) const = default;
};

/// What is asked for; equal queries have equal answers.
struct PlotCurvesQuery {
    std::string x;
    std::vector<std::string> y;
    std::vector<LabelRegion> regions; ///< of statistics, a curve each; none: everywhere
    BrushedQuery brushes;             ///< its channels and selection
    bool operator==(const PlotCurvesQuery&) const = default;
};

/// Every value that labels of the data name.
std::vector<LabelRegion> labelRegions(const volume::DatasetInfo& info);
/// A region by the name of a label's value, by "LABEL=VALUE" or, where there is one label, by "VALUE". Throws Error
/// that names those there are.
LabelRegion findRegion(const volume::DatasetInfo& info, const std::string& text);

/// The view with what it leaves open chosen for the data.
CurvesView resolvedCurves(const CurvesView& view, const volume::DatasetInfo& info);
/// What a view wants. Throws Error for a region that is not there.
PlotCurvesQuery plotCurvesQuery(const CurvesView& view, const Session& session, const volume::DatasetInfo& info);
/// Looks values up that are known as computed, and reads the others. A statistic has a curve for each region, which its
/// name states: "mean(T) in cathode". Throws Error (also for a horizontal axis that is a statistic of several regions),
/// Cancelled.
volume::Curves readCurves(const volume::BrickSource& source, const NumberOrigin& origin, const PlotCurvesQuery& query,
                          const Progress& progress = {});

/// Where the numbers of curves come from, in words.
std::string curvesOrigin(const volume::DatasetInfo& info, const NumberOrigin& origin, const PlotCurvesQuery& query);

/// A range with the finite values of a curve in it.
Range rangeOf(const std::vector<double>& values, Range range);

/// Curves that share a unit, and so a plot: indices into Curves::y.
std::vector<std::vector<std::size_t>> curveGroups(const volume::Curves& curves);
/// Title of their vertical axis without its unit: "T" of mean(T) and max(T), else their names without regions.
std::string groupTitle(const volume::Curves& curves, const std::vector<std::size_t>& group);
/// Where a time lies on a curve: between stored times in between. NaN where not known.
glm::dvec2 curvePoint(const volume::Curves& curves, std::size_t y, double time);
/// A row for each time.
Table curvesTable(const volume::Curves& curves);
/// A plot for each unit, the state at `time` marked. `together`: two units share one, with an axis on either side.
std::vector<Plot> curvesPlots(const volume::Curves& curves, std::optional<double> time, bool dark,
                              bool together = false);
VectorPage curvesDrawing(const volume::Curves& curves, std::optional<double> time, const PageForm& form = {},
                         bool together = false);

} // namespace tessera::app
