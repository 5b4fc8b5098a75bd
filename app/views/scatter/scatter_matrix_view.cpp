#include "app/pane/view_parts.h"
#include "app/queries/readout.h"
#include "app/queries/statistics_query.h"
#include "app/tools/brush_edit.h"
#include "app/ui/keys.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"
#include "app/values/selection_text.h"
#include "app/views/scatter/scatter_cells.h"
#include "app/views/scatter/scatter_toolbar.h"
#include "vis/gl/plot_texture.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr std::size_t kMostPlots = 9; ///< a side, where the user has not chosen: more are too small to read

/// How the mean of a third parameter is coloured; no range width: densities instead.
struct MeanColors {
    vis::TransferFunction function;
    Range range{0, 0};
    bool operator==(const MeanColors&) const = default;
};

struct ScatterCache : ScatterLayoutCache {
    AsyncStatistics answers;
    BrushDrag drag;
    std::vector<vis::PlotTexture> textures; ///< by pair
    vis::PlotTexture large;                 ///< of the enlarged plot, every bin a pixel
    std::vector<std::uint8_t> pixels;
    // What the textures show.
    std::shared_ptr<const StatisticsResult> shown;
    bool shownLog = false, shownDark = false;
    int shownMerge = 0, shownLarge = -1;
    ImU32 shownFocus = 0;
    MeanColors shownColors;
};

/// Position of the channel that colours the plots among the query's channels, added where it is not shown; -1: none.
int meanChannel(BrushedQuery& query, const volume::DatasetInfo& info, const std::string& name) {
    const auto channel = info.findChannel(name);
    if (name.empty() || !channel) return -1;
    const auto found = std::find(query.channels.begin(), query.channels.end(), *channel);
    if (found != query.channels.end()) return static_cast<int>(found - query.channels.begin());
    query.channels.push_back(*channel);
    query.ranges.push_back(info.channelRange(info.channel(*channel)));
    return static_cast<int>(query.channels.size()) - 1;
}

MeanColors meanColors(const Session& session, const volume::DatasetInfo& info, const std::string& name) {
    const auto channel = info.findChannel(name);
    if (name.empty() || !channel) return {};
    const vis::TransferFunction& function = transferOf(session, name);
    return {function, vis::effectiveRange(function, info.channelRange(info.channel(*channel)))};
}

void updateTextures(vis::TexturesIn where, ScatterCache& cache, const std::shared_ptr<const StatisticsResult>& result,
                    bool logDensity, float cell, int large, ImU32 focus, const MeanColors& colors) {
    const bool dark = darkTheme();
    const int merge =
        std::max(1, static_cast<int>(std::lround(static_cast<float>(result->query.bins) / std::max(8.0f, cell))));
    if (cache.shown == result && cache.shownLog == logDensity && cache.shownDark == dark && cache.shownMerge == merge &&
        cache.shownLarge == large && cache.shownFocus == focus && cache.shownColors == colors)
        return;
    cache.shownLarge = large;
    cache.shownFocus = focus;
    cache.shownColors = colors;
    cache.shownMerge = merge;
    cache.shown = result;
    cache.shownLog = logDensity;
    cache.shownDark = dark;
    cache.textures.resize(result->statistics.joint.size());
    for (std::size_t i = 0; i < cache.textures.size(); ++i) {
        const volume::JointHistogram& joint = result->statistics.joint[i];
        const auto paint = [&](int step) {
            if (!joint.mean.empty()) return meanImage(joint, step, colors.function, colors.range, cache.pixels);
            return densityImage(joint.count,
                                result->brushed ? std::span<const double>(joint.focus) : std::span<const double>(),
                                joint.bins, step, logDensity, dark, focus, cache.pixels);
        };
        const int pixels = paint(merge);
        cache.textures[i].upload(where, {pixels, pixels}, cache.pixels);
        if (static_cast<int>(i) != large) continue;
        paint(1);
        cache.large.upload(where, {joint.bins, joint.bins}, cache.pixels);
    }
}

/// The plot that is shown large, in the free corner over the correlations: which one, and the cells it covers.
struct Enlarged {
    std::size_t column = 0, row = 0; ///< of the plot, column <= row
    std::size_t cells = 0;           ///< a side of the covered corner at the top right; 0 = nothing is enlarged
    bool covers(const ScatterLayout& matrix, std::size_t c, std::size_t r) const {
        return cells > 0 && c + cells >= matrix.size() && r < cells;
    }
};

Enlarged enlargedPlot(const ScatterLayout& matrix, const ScatterMatrixView& view) {
    Enlarged out;
    // With three parameters and fewer the corner is no larger than the plots themselves.
    if (view.enlarged.size() != 2 || matrix.size() < 4) return out;
    std::size_t found = 0;
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        if (matrix.infos[i].name == view.enlarged[0]) out.column = i, found |= 1;
        if (matrix.infos[i].name == view.enlarged[1]) out.row = i, found |= 2;
    }
    if (out.column > out.row) std::swap(out.column, out.row);
    if (found == 3) out.cells = matrix.size() / 2;
    return out;
}

/// A correlation cell of the upper triangle.
void drawUpperCell(const ScatterCache& cache, const ScatterLayout& matrix, std::size_t column, std::size_t row,
                   const StatisticsResult* result, const Session& session) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotFrame frame = matrix.cell(column, row);
    const int joint = result ? jointIndex(result->statistics, row, column) : -1;
    if (joint >= 0)
        drawCorrelation(draw, frame, result->statistics.joint[static_cast<std::size_t>(joint)], result->brushed,
                        cache.shownFocus);
    draw.AddRect(frame.min, frame.max, plotColors().frame);
    if (ImGui::IsMouseHoveringRect(frame.min, frame.max) && ImGui::IsWindowHovered() && !cache.drag.active && result)
        hoverText(matrix, column, row, frame, *result, volume::DatasetInfo{}, {}, selectionName(session));
}

/// The wheel zooms about the mouse, the middle button pans, its double click shows all again; the same for every plot
/// of these parameters.
void zoomAndPan(ScatterMatrixView& view, const PlotFrame& frame, const PlotChannels& channels, Range wholeX,
                Range wholeY, bool histogram) {
    const ImGuiIO& io = ImGui::GetIO();
    const auto change = [&](const std::string& channel, Range now, Range whole, double about, double factor,
                            double shift) {
        Range next{about + (now.lo - about) * factor + shift, about + (now.hi - about) * factor + shift};
        const double width = next.hi - next.lo, all = whole.hi - whole.lo;
        if (width >= all * 0.999) {
            view.zoom.erase(channel);
            return;
        }
        if (width < all * 1e-4) return;
        next.lo = std::clamp(next.lo, whole.lo, whole.hi - width);
        next.hi = next.lo + width;
        view.zoom[channel] = next;
    };
    const auto both = [&](glm::dvec2 about, double factor, glm::dvec2 shift) {
        change(channels.x, frame.x, wholeX, about.x, factor, shift.x);
        if (!histogram) change(channels.y, frame.y, wholeY, about.y, factor, shift.y);
    };
    if (io.MouseWheel != 0) both(frame.data(io.MousePos), std::pow(0.85, static_cast<double>(io.MouseWheel)), {0, 0});
    if (ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 0) && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0))
        both({0, 0}, 1,
             {-static_cast<double>(io.MouseDelta.x) * frame.perPixelX(),
              static_cast<double>(io.MouseDelta.y) * frame.perPixelY()});
    if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Middle)) {
        view.zoom.erase(channels.x);
        if (!histogram) view.zoom.erase(channels.y);
    }
}

/// A density plot or histogram with brushes, cursor and read-out in a frame; true when it was clicked.
bool drawPlot(ViewContext& context, ScatterCache& cache, ScatterMatrixView& view, const ScatterLayout& matrix,
              std::size_t column, std::size_t row, PlotFrame frame, const vis::PlotTexture* texture,
              const StatisticsResult* result) {
    Session& session = context.session;
    const PlotColors colors = plotColors();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const bool histogram = column == row;
    if (histogram) frame.y = {0, 1};
    const PlotChannels channels{matrix.infos[column].name, histogram ? std::string() : matrix.infos[row].name};

    ImGui::SetCursorScreenPos(frame.min);
    const bool pressed = mouseArea("plot", {frame.width(), frame.height()},
                                   ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    const ImVec2 way = ImGui::GetMouseDragDelta(ImGuiMouseButton_Left, 0);
    const bool clicked =
        pressed && ImGui::IsMouseReleased(ImGuiMouseButton_Left) && std::hypot(way.x, way.y) < em() * 0.25f;
    const bool hovered = ImGui::IsItemHovered();
    if (hovered && !cache.drag.active)
        zoomAndPan(view, frame, channels, matrix.whole[column], matrix.whole[row], histogram);
    editBrushes(cache.drag, session.selection, frame, channels, {view.tool, view.softness});
    clearAfterQuestion(cache.drag, context);

    draw.PushClipRect(frame.min, frame.max, true);
    if (result && histogram)
        drawHistogram(draw, frame, result->statistics.channels[column].histogram, result->brushed, view.logDensity,
                      focusColor(session));
    const int joint = result ? jointIndex(result->statistics, column, row) : -1;
    if (joint >= 0 && texture) {
        if (result->statistics.joint[static_cast<std::size_t>(joint)].samples == 0) drawNothingCommon(draw, frame);
        // Draw it over the range it was counted for: after a zoom the next one is still being counted.
        const volume::JointHistogram& counted = result->statistics.joint[static_cast<std::size_t>(joint)];
        const ImVec2 low = frame.pixel(counted.xRange.lo, counted.yRange.lo),
                     high = frame.pixel(counted.xRange.hi, counted.yRange.hi);
        draw.AddImage(textureId(texture->name()), {low.x, high.y}, {high.x, low.y});
        if (view.outliers)
            drawOutliers(draw, frame, counted, [&](std::size_t bin) {
                if (!counted.mean.empty())
                    return std::isnan(counted.mean[bin])
                               ? colors.faint
                               : meanColor(cache.shownColors.function, cache.shownColors.range, counted.mean[bin]);
                if (!result->brushed) return colors.faint;
                return counted.focus[bin] >= 0.5 * static_cast<double>(counted.count[bin]) ? cache.shownFocus
                                                                                           : colors.frame;
            });
    }
    draw.PopClipRect();
    draw.AddRect(frame.min, frame.max, colors.frame);
    drawBrushes(draw, session.selection, frame, channels);
    const Readout& cursor = sharedReadout(context);
    const auto x = cursor.value(channels.x), y = histogram ? std::nullopt : cursor.value(channels.y);
    draw.PushClipRect(frame.min, frame.max, true);
    if (x && histogram) drawCrosshair(draw, frame, *x, std::nan(""));
    if (x && y) {
        const ImVec2 at = frame.pixel(*x, *y);
        draw.AddCircle(at, em() * 0.28f, colors.backdrop, 16, 3);
        draw.AddCircle(at, em() * 0.28f, colors.cursor, 16, 1.5f);
    }
    draw.PopClipRect();
    if (histogram && frame.height() > em() * 1.05f) {
        addFittedWithBackdrop(draw, {frame.max.x - em() * 0.3f, frame.min.y + em() * 0.15f}, {1, 0}, colors.text,
                              channels.x, frame.width() - em() * 0.5f);
    }
    if (hovered && !cache.drag.active && result)
        hoverText(matrix, column, row, frame, *result, context.numbers->info(), view.colorBy,
                  selectionName(context.session));
    return clicked;
}

/// The enlarged plot with axes of its own and a button to put it away.
void drawLarge(ViewContext& context, ScatterCache& cache, ScatterMatrixView& view, const ScatterLayout& matrix,
               const Enlarged& large, const StatisticsResult* result) {
    const std::size_t last = matrix.size() - 1;
    const ImVec2 min = matrix.cell(matrix.size() - large.cells, 0).min, max = matrix.cell(last, large.cells - 1).max;
    const bool histogram = large.column == large.row;
    const Range x = matrix.ranges[large.column], y = matrix.ranges[large.row];
    const float left = histogram ? em() * 0.6f : axisRoom(AxisSide::Left, y, TitlePlace::Beside);
    const PlotFrame frame{{std::round(min.x + em() * 0.4f + left), min.y},
                          {max.x, std::round(max.y - axisRoom(AxisSide::Bottom, x, TitlePlace::Beside))},
                          x,
                          y};
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (frame.width() < em() * 3 || frame.height() < em() * 2) return;
    const volume::Channel &across = matrix.infos[large.column], &up = matrix.infos[large.row];
    drawAxis(draw, frame, AxisSide::Bottom, across.name, across.unit, frame.min.x - em(), frame.max.x);
    if (!histogram) drawAxis(draw, frame, AxisSide::Left, up.name, up.unit, frame.min.y, frame.max.y + em() * 0.5f);
    ImGui::PushID("large");
    drawPlot(context, cache, view, matrix, large.column, large.row, frame, &cache.large, result);
    ImGui::PopID();
    draw.AddRect(frame.min, frame.max, plotColors().focus);
}

/// The plots below the diagonal and what stands above; a click on one enlarges it, or takes it back.
void drawCells(ViewContext& context, ScatterCache& cache, ScatterMatrixView& view, const ScatterLayout& matrix,
               const Enlarged& large, const StatisticsResult* result) {
    for (std::size_t row = 0; row < matrix.size(); ++row)
        for (std::size_t column = 0; column < matrix.size(); ++column) {
            if (large.covers(matrix, column, row)) continue;
            if (column > row) {
                drawUpperCell(cache, matrix, column, row, result, context.session);
                continue;
            }
            const int joint = result ? jointIndex(result->statistics, column, row) : -1;
            const PlotFrame frame = matrix.cell(column, row);
            ImGui::PushID(static_cast<int>(row * matrix.size() + column));
            const bool clicked =
                drawPlot(context, cache, view, matrix, column, row, frame,
                         joint >= 0 ? &cache.textures[static_cast<std::size_t>(joint)] : nullptr, result);
            ImGui::PopID();
            const bool shown = large.cells > 0 && large.column == column && large.row == row;
            if (shown) ImGui::GetWindowDrawList()->AddRect(frame.min, frame.max, plotColors().focus);
            if (clicked && shown)
                view.enlarged.clear();
            else if (clicked)
                view.enlarged = {matrix.infos[column].name, matrix.infos[row].name};
        }
}

/// The highest count of the first parameter's histogram.
double highestCount(const StatisticsResult& result) {
    std::uint64_t most = 0;
    for (const std::uint64_t count : result.statistics.channels.front().histogram.count) most = std::max(most, count);
    return static_cast<double>(most);
}

/// The parameters compared and their ranges, without positions.
ScatterLayout matrixOf(const volume::DatasetInfo& info, const ScatterMatrixView& view) {
    ScatterLayout matrix;
    matrix.channels = chosenChannels(info, view.channels, kMostPlots);
    for (const int channel : matrix.channels) {
        matrix.infos.push_back(info.channel(channel));
        matrix.whole.push_back(paddedRange(info.channelRange(matrix.infos.back()), 0.02));
        const auto zoomed = view.zoom.find(matrix.infos.back().name);
        const bool usable = zoomed != view.zoom.end() && zoomed->second.hi > zoomed->second.lo;
        matrix.ranges.push_back(usable ? zoomed->second : matrix.whole.back());
    }
    return matrix;
}

} // namespace

void drawScatterMatrixView(ViewContext& context, const std::string& pane, ScatterMatrixView& view) {
    if (!context.source) {
        drawHint("No data", "Plots every pair of parameters; drag in a plot to select.");
        return;
    }
    const volume::DatasetInfo& info = context.numbers->info();
    ScatterLayout matrix = matrixOf(info, view);
    if (matrix.channels.empty()) {
        drawHint("No parameters to compare", "This data set has only labels.");
        return;
    }
    ScatterCache& cache = cacheOf<ScatterCache>(context, pane);
    int bins = view.bins;
    if (matrix.size() == 1 && matrix.ranges == matrix.whole) { // pairs share their number of bins
        const HistogramBins own = histogramBins(info, matrix.channels.front(), matrix.ranges.front(), bins);
        matrix.ranges.front() = own.range;
        bins = own.count;
    }
    BrushedQuery query =
        brushedQuery(context.session, info, matrix.channels, matrix.ranges, bins, matrix.channels.size() > 1);
    query.meanOf = meanChannel(query, info, view.colorBy);
    const std::shared_ptr<const StatisticsResult> result = cache.answers.get(context, "statistics " + pane, query);

    drawScatterToolbar(context, view, matrix.channels, result);
    const auto n = static_cast<float>(matrix.size());
    const ImVec2 origin = ImGui::GetCursorScreenPos();
    const ImVec2 room{ImGui::GetContentRegionAvail().x,
                      heightAtLeast(em() * (matrix.size() == 1 ? 5 : 1.3f * n + 0.2f))};
    const MatrixTitles titles = matrixTitles(matrix, room, result ? highestCount(*result) : 1, view.logDensity);
    const float left = titles.left, bottom = titles.bottom;
    matrix.gap = std::round(em() * 0.35f);
    matrix.min = {origin.x + left, origin.y + em() * 0.2f};
    matrix.cellX = (room.x - left - em() * 0.2f) / n;
    matrix.cellY = (room.y - bottom - em() * 0.2f) / n;
    if (matrix.cellX < em()) return drawHint("Not enough room", "Enlarge the pane or choose fewer parameters.");
    cache.layout = matrix;
    const Enlarged large = enlargedPlot(matrix, view);
    if (result)
        updateTextures(context.renderer.textures(), cache, result, view.logDensity,
                       std::min(matrix.cellX, matrix.cellY),
                       large.cells > 0 ? jointIndex(result->statistics, large.column, large.row) : -1,
                       focusColor(context.session), meanColors(context.session, info, view.colorBy));
    drawCells(context, cache, view, matrix, large, result.get());
    if (large.cells > 0) drawLarge(context, cache, view, matrix, large, result.get());
    if (cache.drag.active) context.interacting = true;

    ImDrawList& draw = *ImGui::GetWindowDrawList();
    drawMatrixAxes(draw, matrix, titles);
    if (!cache.answers.failure().empty() && !result)
        draw.AddText({matrix.min.x, matrix.min.y}, plotColors().text, cache.answers.failure().c_str());
}

} // namespace tessera::app
