#pragma once

#include "app/queries/statistics_query.h"
#include "app/views/scatter/scatter_layout.h"

#include <functional>

/// The contents of the cells of a scatterplot matrix, except for the density pictures.
namespace tessera::app {

/// Position of a pair among the joint histograms, -1 for a histogram.
int jointIndex(const volume::Statistics& statistics, std::size_t column, std::size_t row);

/// The share of a plot's height that its highest bar has.
inline constexpr double kHighestBar = 0.94;

void drawHistogram(ImDrawList& draw, const PlotFrame& frame, const volume::Histogram& histogram, bool brushed,
                   bool logCounts, ImU32 focusShade);

/// Correlation as a number on a tint: orange for rising together, blue for against each other.
void drawCorrelation(ImDrawList& draw, const PlotFrame& frame, const volume::JointHistogram& joint, bool brushed,
                     ImU32 focusShade);

/// Text for parameters that are never present at the same point, such as oxygen and hydrogen, so that the empty plot
/// does not look broken.
void drawNothingCommon(ImDrawList& draw, const PlotFrame& frame);

/// A dot on every bin that holds few samples and has empty ones around it: one pixel there would not be seen.
void drawOutliers(ImDrawList& draw, const PlotFrame& frame, const volume::JointHistogram& joint,
                  const std::function<ImU32(std::size_t bin)>& colorOf);

/// A mean's colour in a plot: opaque; of labels grey where samples of several meet.
ImU32 meanColor(const vis::TransferFunction& function, Range range, double mean);

/// What is under the mouse in a cell; `selection`: the name of what is selected.
void hoverText(const ScatterLayout& matrix, std::size_t column, std::size_t row, const PlotFrame& frame,
               const StatisticsResult& result, const volume::DatasetInfo& info, const std::string& colorBy,
               const std::string& selection);

/// Colours of the mean of a third parameter, row 0 at the top; transparent where no sample has it. Merged like
/// densityImage.
int meanImage(const volume::JointHistogram& joint, int merge, const vis::TransferFunction& function, Range range,
              std::vector<std::uint8_t>& rgba);

/// How the titles along one side of a scatterplot matrix stand: names and units along their cells on one line, on two,
/// or across them, which takes as much room as the longest.
enum class TitleWay { OneLine, TwoLines, Across };

/// A titled axis along every column and row. Names are cut off rather than units.
struct MatrixTitles {
    bool shown = true; ///< small cells have neither numbers nor titles: their diagonal has the names
    TitleWay below = TitleWay::OneLine, beside = TitleWay::OneLine;
    float left = 0, bottom = 0; ///< pixels they need with the numbers
    Range counts{0, 1};         ///< along the left side of a lone histogram
    std::string countTitle = {};
};
/// `room`: of the whole matrix with its titles. `most`: the highest count of a lone histogram.
MatrixTitles matrixTitles(const ScatterLayout& matrix, ImVec2 room, double most, bool logCounts);
void drawMatrixAxes(ImDrawList& draw, const ScatterLayout& matrix, const MatrixTitles& titles);

} // namespace tessera::app
