#pragma once

#include "app/queries/statistics_query.h"
#include "app/tools/brush_edit.h"
#include "app/values/plot.h"
#include "vis/gl/plot_texture.h"

#include <memory>
#include <string>
#include <vector>

/// The plot of a level of the hierarchy: one or two parameters of what the brushes before it select.
namespace tessera::app {

struct LevelPlot {
    PlotChannels channels;    ///< of a histogram x alone; of no plot none
    std::vector<int> indices; ///< of them in DatasetInfo::channels(); empty: there is nothing to plot
    std::vector<Range> ranges;
    int bins = 1;
    std::shared_ptr<const StatisticsResult> result = {}; ///< null while it is read
};

/// What is kept of each level from frame to frame.
struct LevelCache {
    BrushDrag drag;
    vis::PlotTexture texture;
    std::vector<std::uint8_t> pixels;
    std::shared_ptr<const StatisticsResult> shown; ///< by the texture
    bool shownLog = false, shownDark = false;
    ImU32 shownFocus = 0;
};

/// The parameters that a brush names, at most two; none of a brush in space.
std::vector<std::string> plottedChannels(const vis::Brush& brush);

/// The first parameter that no brush names; else the first.
std::vector<std::string> nextChannels(const volume::DatasetInfo& info, const vis::Selection& selection,
                                      const std::vector<std::string>& chosen);

/// Without samples yet. `bins`: along each axis; of few whole numbers as many as these.
LevelPlot levelPlot(const volume::DatasetInfo& info, const std::vector<std::string>& channels, int bins);

/// Samples of what the first `before` brushes select.
BrushedQuery levelQuery(const Session& session, const volume::DatasetInfo& info, const LevelPlot& plot,
                        std::size_t before);

/// Draws the plot between two corners of the window and lets the mouse edit `brushes`: that of the level, or none yet.
/// True when they changed.
bool drawLevelPlot(ViewContext& context, LevelCache& cache, const LevelPlot& plot, ImVec2 min, ImVec2 max,
                   bool logDensity, float softness, vis::Selection& brushes);

/// The same for pages.
Plot levelPage(const volume::DatasetInfo& info, const LevelPlot& plot, const std::string& title, bool logDensity,
               ImU32 focus, bool dark);

} // namespace tessera::app
