#pragma once

#include "app/queries/readout.h"
#include "app/views/parallel/gap_raster.h"
#include "app/views/parallel/parallel_axes.h"
#include "app/views/parallel/parallel_query.h"
#include "vis/gl/plot_texture.h"

#include <memory>
#include <string>
#include <vector>

/// One plot of parallel coordinates: where its axes lie, the pictures between them, and what is drawn over these.
namespace tessera::app {

/// Axes with places, and the strip below them for samples that lack a parameter.
struct ParallelPlot {
    std::vector<ParallelAxis> axes;
    float markTop = 0, markBottom = 0; ///< of the strip; equal: no sample lacks a parameter

    bool hasMarks() const { return markBottom > markTop; }
    float gap() const { return axes.size() > 1 ? axes[1].x - axes[0].x : 0; }
    /// Where the lines of samples without a parameter end.
    float markAt() const { return (markTop + markBottom) / 2; }
    PlaceRows rows(std::size_t axis) const;
};

/// What outsiders may see of the view's cache: where the plots lay in its last frame, one for each time.
struct ParallelLayoutCache : ViewCache {
    std::vector<ParallelPlot> plots;
};

/// Whether a sample that has a value on an axis lacks one on another.
bool lacksAny(const volume::AxisDensities& densities);

/// Places axes side by side between two corners; `marks`: with the strip. `left`, `right`: room before the first axis
/// and behind the last, `line`: height of a line.
void placeAxes(ParallelPlot& plot, ImVec2 min, ImVec2 max, bool marks, float left, float right, float line);

/// Length of the longest bar of histograms on axes.
float histogramLength(const ParallelPlot& plot, float line);

/// How densities become colours, on a light or dark ground; `focus`: brushGroups().colors.
GapLook gapLook(bool logDensity, bool dark, const std::vector<ImU32>& focus);

/// Densities of all gaps of a plot, as wide and high as it is drawn, and the greatest of them.
struct PlotDensities {
    std::vector<GapDensity> gaps;
    double most = 0;
};
PlotDensities plotDensities(const ParallelPlot& plot, const volume::AxisDensities& densities, int width, int height);

/// The pictures between the axes; made anew when what they show changes.
class GapPictures {
public:
    void update(vis::TexturesIn where, const ParallelPlot& plot, const std::shared_ptr<const ParallelResult>& result,
                bool logDensity, const std::vector<ImU32>& focus);
    void draw(ImDrawList& draw, const ParallelPlot& plot) const;

private:
    struct Key {
        std::shared_ptr<const ParallelResult> result;
        std::vector<bool> flipped;
        std::vector<ImU32> focus;
        int width = 0, height = 0, axisHeight = 0;
        bool logDensity = false, dark = false;
        bool operator==(const Key&) const = default;
    };
    Key shown_;
    std::vector<vis::PlotTexture> textures_;
};

/// Axes with their numbers, histograms on them, and a mark below those that samples lack.
void drawParallelAxes(ImDrawList& draw, const ParallelPlot& plot);
void drawAxisHistograms(ImDrawList& draw, const ParallelPlot& plot, const ParallelResult& result, bool logCounts,
                        const std::vector<ImU32>& focus);

/// The line of the sample at the cross-hair; where it lacks a parameter it ends at the mark below.
void drawCursorLine(ImDrawList& draw, const ParallelPlot& plot, const Readout& cursor);
/// The same of another sample, by its values on the axes.
void drawSampleLine(ImDrawList& draw, const ParallelPlot& plot, const std::vector<std::optional<double>>& values);

/// What is under the mouse on an axis: its value, the samples in that bin and how many of them are selected, and those
/// that have no place on it. `selected`: the name of what is selected.
std::string axisHoverText(const ParallelPlot& plot, std::size_t axis, float y, const ParallelResult& result,
                          const std::string& selected);
/// What is under the mouse between two axes: how many samples run through there.
std::string gapHoverText(const ParallelPlot& plot, std::size_t gap, ImVec2 at, const ParallelResult& result,
                         const std::string& selected);

} // namespace tessera::app
