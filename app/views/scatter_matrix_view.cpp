#include "app/views/brush_edit.h"
#include "app/views/readout.h"
#include "app/views/scatter_layout.h"
#include "app/views/statistics_feed.h"
#include "app/views/ticks.h"
#include "app/views/view_parts.h"
#include "vis/gl/plot_texture.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr std::size_t kMostPlots = 9; ///< a side, where the user has not chosen: more are too small to read

struct ScatterCache : ScatterLayoutCache {
    StatisticsFeed feed;
    BrushDrag drag;
    Readout readout;
    std::vector<vis::PlotTexture> textures; ///< by pair
    vis::PlotTexture large;                 ///< of the enlarged plot, every bin a pixel
    std::vector<std::uint8_t> pixels;
    // What the textures show.
    std::shared_ptr<const StatisticsResult> shown;
    bool shownLog = false, shownDark = false;
    int shownMerge = 0, shownLarge = -1;
    ImU32 shownFocus = 0;
};

void chooseTool(BrushTool& tool) {
    static constexpr const char* kTools[] = {"rectangle", "ellipse", "lasso"};
    ImGui::SetNextItemWidth(em() * 5.4f);
    if (ImGui::BeginCombo("##tool", kTools[static_cast<std::size_t>(tool)])) {
        for (int i = 0; i < 3; ++i)
            if (ImGui::Selectable(kTools[i], static_cast<int>(tool) == i)) tool = static_cast<BrushTool>(i);
        ImGui::EndCombo();
    }
    if (ImGui::IsItemHovered())
        tooltip("What a drag in a plot draws; Shift adds to the selection, Ctrl takes away from it");
}

/// Focus samples and all samples: of the parameter that exists at most points.
struct Share {
    double focus = 0, all = 0;
};
Share focusShare(const volume::Statistics& statistics) {
    Share share;
    for (const volume::ChannelStatistics& channel : statistics.channels) {
        share.focus = std::max(share.focus, static_cast<double>(channel.inside.samples));
        share.all = std::max(share.all, static_cast<double>(channel.all.samples));
    }
    return share;
}

void drawToolbar(ViewContext& context, ScatterMatrixView& view, const std::vector<int>& shown,
                 const StatisticsResult* result) {
    Session& session = context.session;
    const volume::DatasetInfo& info = context.source->info();
    chooseChannels(info, view.channels, shown);
    ImGui::SameLine();
    ImGui::Checkbox("log", &view.logDensity);
    if (ImGui::IsItemHovered()) tooltip("Show the logarithm of the number of samples");
    ImGui::SameLine();
    chooseTool(view.tool);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(em() * 5);
    float percent = view.softness * 100;
    if (ImGui::SliderFloat("##soft", &percent, 0, 50, "soft %.0f %%")) view.softness = percent / 100;
    if (ImGui::IsItemHovered()) tooltip("Soft edge of new brushes, as a share of their width");
    const bool brushed = session.selection.active();
    std::string text, brief;
    if (brushed && result && result->brushed) {
        const Share share = focusShare(result->statistics);
        text = brief = "focus " + formatShare(share.all > 0 ? share.focus / share.all : 0);
        if (result->statistics.level == 0) text += " (" + formatCount(share.focus) + ")";
    } else if (session.selection.brushes.empty()) {
        text = "drag in a plot to brush, click to enlarge";
        brief = "drag to brush";
    }
    if (!session.selection.brushes.empty()) {
        ImGui::SameLine();
        if (iconButton(context, "clear", icons::kTrash, "Remove all brushes (Esc)")) session.selection.brushes.clear();
    }
    ImGui::SameLine();
    if (ImGui::CalcTextSize(text.c_str()).x > ImGui::GetContentRegionAvail().x) text = brief;
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    if (ImGui::GetContentRegionAvail().x >= width) {
        ImGui::SetCursorPosX(std::max(ImGui::GetCursorPosX(), ImGui::GetContentRegionMax().x - width));
        ImGui::AlignTextToFramePadding();
        if (brushed)
            ImGui::TextUnformatted(text.c_str());
        else
            ImGui::TextDisabled("%s", text.c_str());
    } else {
        ImGui::NewLine();
    }
}

void updateTextures(ScatterCache& cache, const std::shared_ptr<const StatisticsResult>& result, bool logDensity,
                    float cell, int large, ImU32 focus) {
    const bool dark = darkTheme();
    const int merge =
        std::max(1, static_cast<int>(std::lround(static_cast<float>(result->wish.bins) / std::max(8.0f, cell))));
    if (cache.shown == result && cache.shownLog == logDensity && cache.shownDark == dark && cache.shownMerge == merge &&
        cache.shownLarge == large && cache.shownFocus == focus)
        return;
    cache.shownLarge = large;
    cache.shownFocus = focus;
    cache.shownMerge = merge;
    cache.shown = result;
    cache.shownLog = logDensity;
    cache.shownDark = dark;
    cache.textures.resize(result->statistics.joint.size());
    for (std::size_t i = 0; i < cache.textures.size(); ++i) {
        const volume::JointHistogram& joint = result->statistics.joint[i];
        const int pixels = densityImage(
            joint.count, result->brushed ? std::span<const double>(joint.focus) : std::span<const double>(), joint.bins,
            merge, logDensity, dark, focus, cache.pixels);
        cache.textures[i].upload({pixels, pixels}, cache.pixels);
        if (static_cast<int>(i) != large) continue;
        densityImage(joint.count, result->brushed ? std::span<const double>(joint.focus) : std::span<const double>(),
                     joint.bins, 1, logDensity, dark, focus, cache.pixels);
        cache.large.upload({joint.bins, joint.bins}, cache.pixels);
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

/// Position of a pair among the joint histograms, -1 for a histogram.
int jointIndex(const volume::Statistics& statistics, std::size_t column, std::size_t row) {
    for (std::size_t i = 0; i < statistics.joint.size(); ++i)
        if (statistics.joint[i].x == static_cast<int>(column) && statistics.joint[i].y == static_cast<int>(row))
            return static_cast<int>(i);
    return -1;
}

void drawHistogram(ImDrawList& draw, const PlotFrame& frame, const volume::Histogram& histogram, bool brushed,
                   bool logCounts, ImU32 focusShade) {
    const PlotColors colors = plotColors();
    std::uint64_t most = 1;
    for (std::uint64_t count : histogram.count) most = std::max(most, count);
    const auto height = [&](double count) {
        const double top = static_cast<double>(most);
        return static_cast<float>((logCounts ? std::log1p(count) / std::log1p(top) : count / top) * 0.94);
    };
    std::vector<float> all, focus;
    for (std::size_t i = 0; i < histogram.count.size(); ++i) {
        all.push_back(height(static_cast<double>(histogram.count[i])));
        if (brushed) focus.push_back(histogram.focus[i] > 0 ? height(histogram.focus[i]) : 0.0f);
    }
    drawBars(draw, frame, all, colors.bars);
    if (brushed) drawBars(draw, frame, focus, focusShade);
}

/// Correlation as a number on a tint: orange for rising together, blue for against each other.
void drawCorrelation(ImDrawList& draw, const PlotFrame& frame, const volume::JointHistogram& joint, bool brushed) {
    const PlotColors colors = plotColors();
    const auto line = [&](double r, float centerY, float scale, ImU32 color, const char* prefix) {
        char text[48];
        if (std::isnan(r))
            std::snprintf(text, sizeof text, "%s-", prefix);
        else
            std::snprintf(text, sizeof text, "%s%+.2f", prefix, r);
        float size = em() * scale;
        ImFont* font = ImGui::GetFont();
        const float width = font->CalcTextSizeA(size, 1e6f, 0, text).x;
        if (width > frame.width() * 0.92f) size *= frame.width() * 0.92f / width;
        if (size < em() * 0.55f) return;
        const ImVec2 extent = font->CalcTextSizeA(size, 1e6f, 0, text);
        draw.AddText(font, size,
                     {std::round((frame.min.x + frame.max.x - extent.x) / 2), std::round(centerY - extent.y / 2)},
                     color, text);
    };
    if (!std::isnan(joint.correlation)) {
        const int alpha = static_cast<int>(std::abs(joint.correlation) * 70);
        draw.AddRectFilled(frame.min, frame.max,
                           joint.correlation > 0 ? IM_COL32(230, 140, 40, alpha) : IM_COL32(50, 120, 220, alpha));
    }
    const float middle = (frame.min.y + frame.max.y) / 2;
    const bool two = brushed && frame.height() > em() * 2.4f;
    line(joint.correlation, two ? middle - em() * 0.55f : middle, 1, colors.text, "");
    if (two) line(joint.focusCorrelation, middle + em() * 0.6f, 0.9f, colors.focus, "");
}

/// Parameters that never exist at the same point, like oxygen and hydrogen: said, so that the plot does not look
/// broken.
void drawNothingCommon(ImDrawList& draw, const PlotFrame& frame) {
    const char* text = "nowhere both";
    const ImVec2 size = ImGui::CalcTextSize(text);
    if (size.x > frame.width() || size.y > frame.height()) return;
    draw.AddText(
        {std::round((frame.min.x + frame.max.x - size.x) / 2), std::round((frame.min.y + frame.max.y - size.y) / 2)},
        plotColors().frame, text);
}

std::string binText(const volume::Channel& channel, Range range, std::size_t bin, std::size_t bins) {
    const double width = (range.hi - range.lo) / static_cast<double>(bins);
    const double middle = range.lo + (static_cast<double>(bin) + 0.5) * width;
    return channel.name + " " + formatQuantity(middle, channel.unit, width);
}

std::string countText(double count, double total, double focus, bool brushed) {
    std::string text = formatCount(count) + (count == 1 ? " sample" : " samples");
    if (total > 0) text += ", " + formatShare(count / total);
    if (brushed && count > 0) text += "\n" + formatShare(std::min(1.0, focus / count)) + " of them in focus";
    return text;
}

void hoverText(const ScatterLayout& matrix, std::size_t column, std::size_t row, const PlotFrame& frame,
               const StatisticsResult& result) {
    const glm::dvec2 at = frame.data(ImGui::GetIO().MousePos);
    const volume::Statistics& statistics = result.statistics;
    const auto bin = [](double value, Range range, std::size_t bins) {
        const double u = (value - range.lo) / (range.hi - range.lo) * static_cast<double>(bins);
        return static_cast<std::size_t>(std::clamp(u, 0.0, static_cast<double>(bins - 1)));
    };
    std::string text;
    if (column == row) {
        const volume::ChannelStatistics& channel = statistics.channels[column];
        const std::size_t bins = channel.histogram.count.size(), i = bin(at.x, channel.histogram.range, bins);
        text = binText(matrix.infos[column], channel.histogram.range, i, bins) + "\n" +
               countText(static_cast<double>(channel.histogram.count[i]), static_cast<double>(channel.all.samples),
                         channel.histogram.focus[i], result.brushed);
    } else {
        for (const volume::JointHistogram& joint : statistics.joint) {
            if (joint.x != static_cast<int>(std::min(column, row)) ||
                joint.y != static_cast<int>(std::max(column, row)))
                continue;
            const auto bins = static_cast<std::size_t>(joint.bins);
            if (column > row) {
                text = matrix.infos[row].name + " and " + matrix.infos[column].name + "\ncorrelation ";
                text += std::isnan(joint.correlation) ? "not defined" : formatNumber(joint.correlation, 0.001);
                if (result.brushed)
                    text += "\nin focus " + (std::isnan(joint.focusCorrelation)
                                                 ? std::string("not defined")
                                                 : formatNumber(joint.focusCorrelation, 0.001));
                text += "\n" + formatCount(static_cast<double>(joint.samples)) + " samples have both";
            } else {
                const std::size_t bx = bin(at.x, joint.xRange, bins), by = bin(at.y, joint.yRange, bins);
                const std::size_t i = by * bins + bx;
                text = binText(matrix.infos[column], joint.xRange, bx, bins) + "\n" +
                       binText(matrix.infos[row], joint.yRange, by, bins) + "\n" +
                       countText(static_cast<double>(joint.count[i]), static_cast<double>(joint.samples),
                                 joint.focus[i], result.brushed);
            }
        }
    }
    if (result.statistics.level > 0) text += "\n(from a coarser level so far)";
    if (!text.empty()) ImGui::SetTooltip("%s", text.c_str());
}

/// A correlation cell of the upper triangle.
void drawUpperCell(const ScatterCache& cache, const ScatterLayout& matrix, std::size_t column, std::size_t row,
                   const StatisticsResult* result) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotFrame frame = matrix.cell(column, row);
    const int joint = result ? jointIndex(result->statistics, row, column) : -1;
    if (joint >= 0)
        drawCorrelation(draw, frame, result->statistics.joint[static_cast<std::size_t>(joint)], result->brushed);
    draw.AddRect(frame.min, frame.max, plotColors().frame);
    if (ImGui::IsMouseHoveringRect(frame.min, frame.max) && ImGui::IsWindowHovered() && !cache.drag.active && result)
        hoverText(matrix, column, row, frame, *result);
}

/// A density plot or histogram with brushes, cursor and read-out in a frame; true when it was clicked.
bool drawPlot(ViewContext& context, ScatterCache& cache, const ScatterMatrixView& view, const ScatterLayout& matrix,
              std::size_t column, std::size_t row, PlotFrame frame, const vis::PlotTexture* texture,
              const StatisticsResult* result) {
    Session& session = context.session;
    const PlotColors colors = plotColors();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const bool histogram = column == row;
    if (histogram) frame.y = {0, 1};
    const PlotChannels channels{matrix.infos[column].name, histogram ? std::string() : matrix.infos[row].name};

    ImGui::SetCursorScreenPos(frame.min);
    const bool pressed = ImGui::InvisibleButton("plot", {frame.width(), frame.height()},
                                                ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    const ImVec2 way = ImGui::GetMouseDragDelta(ImGuiMouseButton_Left, 0);
    const bool clicked =
        pressed && ImGui::IsMouseReleased(ImGuiMouseButton_Left) && std::hypot(way.x, way.y) < em() * 0.25f;
    const bool hovered = ImGui::IsItemHovered();
    editBrushes(cache.drag, session.selection, frame, channels, {view.tool, view.softness});

    draw.PushClipRect(frame.min, frame.max, true);
    if (result && histogram)
        drawHistogram(draw, frame, result->statistics.channels[column].histogram, result->brushed, view.logDensity,
                      focusColor(session.selection));
    const int joint = result ? jointIndex(result->statistics, column, row) : -1;
    if (joint >= 0 && texture) {
        if (result->statistics.joint[static_cast<std::size_t>(joint)].samples == 0) drawNothingCommon(draw, frame);
        draw.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(texture->name())), frame.min, frame.max);
    }
    draw.PopClipRect();
    draw.AddRect(frame.min, frame.max, colors.frame);
    drawBrushes(draw, session.selection, frame, channels);
    const auto x = cache.readout.value(channels.x), y = histogram ? std::nullopt : cache.readout.value(channels.y);
    draw.PushClipRect(frame.min, frame.max, true);
    if (x && histogram) drawCrosshair(draw, frame, *x, std::nan(""));
    if (x && y) {
        const ImVec2 at = frame.pixel(*x, *y);
        draw.AddCircle(at, em() * 0.28f, colors.backdrop, 16, 3);
        draw.AddCircle(at, em() * 0.28f, colors.cursor, 16, 1.5f);
    }
    draw.PopClipRect();
    if (histogram && frame.height() > em() * 1.6f) {
        const std::string name = fitText(channels.x, frame.width() - em() * 0.5f);
        addTextWithBackdrop(draw, {frame.max.x - em() * 0.3f, frame.min.y + em() * 0.15f}, {1, 0}, colors.text,
                            name.c_str());
    }
    if (hovered && !cache.drag.active && result) hoverText(matrix, column, row, frame, *result);
    return clicked;
}

/// The enlarged plot with axes of its own and a button to put it away.
void drawLarge(ViewContext& context, ScatterCache& cache, ScatterMatrixView& view, const ScatterLayout& matrix,
               const Enlarged& large, const StatisticsResult* result) {
    const std::size_t last = matrix.size() - 1;
    const ImVec2 min = matrix.cell(matrix.size() - large.cells, 0).min, max = matrix.cell(last, large.cells - 1).max;
    const bool histogram = large.column == large.row;
    const Range x = matrix.ranges[large.column], y = matrix.ranges[large.row];
    const float left = histogram ? em() * 0.6f : axisRoom(AxisSide::Left, y, true);
    const PlotFrame frame{{std::round(min.x + em() * 0.4f + left), min.y},
                          {max.x, std::round(max.y - axisRoom(AxisSide::Bottom, x, true))},
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

} // namespace

void drawScatterMatrixView(ViewContext& context, const std::string& pane, ScatterMatrixView& view) {
    if (!context.source) {
        drawHint("No data", "Plots of every pair of parameters appear here; drag in one to select.");
        return;
    }
    const volume::DatasetInfo& info = context.source->info();
    ScatterLayout matrix;
    matrix.channels = chosenChannels(info, view.channels, kMostPlots);
    if (matrix.channels.empty()) {
        drawHint("No parameters to compare", "This data set holds only labels.");
        return;
    }
    ScatterCache& cache = cacheOf<ScatterCache>(context, pane);
    const std::vector<volume::Channel> all = info.channels();
    for (int channel : matrix.channels) {
        matrix.infos.push_back(all[static_cast<std::size_t>(channel)]);
        matrix.ranges.push_back(paddedRange(info.channelRange(matrix.infos.back()), 0.02));
    }
    // Esc clears, wherever in the view the mouse is; during a drag it belongs to the drag.
    if (!cache.drag.active && ImGui::IsWindowHovered(ImGuiHoveredFlags_ChildWindows) &&
        ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false))
        context.session.selection.brushes.clear();
    updateReadout(context, cache.readout);
    const StatisticsWish wish =
        makeWish(context.session, info, matrix.channels, matrix.ranges, view.bins, matrix.channels.size() > 1);
    const std::shared_ptr<const StatisticsResult> result = cache.feed.get(context, "statistics " + pane, wish);

    drawToolbar(context, view, matrix.channels, result.get());
    const ImVec2 origin = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    const auto n = static_cast<float>(matrix.size());
    float left = 0;
    for (std::size_t i = 0; i < matrix.size(); ++i)
        if (i > 0 || matrix.size() == 1) left = std::max(left, axisRoom(AxisSide::Left, matrix.ranges[i], true));
    if (matrix.size() == 1) left = em();
    const float bottom = axisRoom(AxisSide::Bottom, matrix.ranges[0], true);
    matrix.gap = std::round(em() * 0.35f);
    matrix.min = {origin.x + left, origin.y + em() * 0.2f};
    matrix.cellX = (room.x - left - em() * 0.2f) / n;
    matrix.cellY = (room.y - bottom - em() * 0.2f) / n;
    if (matrix.cellX < em() * 1.6f || matrix.cellY < em() * 1.3f) {
        drawHint("Not enough room", "Enlarge the pane or compare fewer parameters.");
        return;
    }
    cache.layout = matrix;
    const Enlarged large = enlargedPlot(matrix, view);
    if (result)
        updateTextures(cache, result, view.logDensity, std::min(matrix.cellX, matrix.cellY),
                       large.cells > 0 ? jointIndex(result->statistics, large.column, large.row) : -1,
                       focusColor(context.session.selection));
    for (std::size_t row = 0; row < matrix.size(); ++row)
        for (std::size_t column = 0; column < matrix.size(); ++column) {
            if (large.covers(matrix, column, row)) continue;
            if (column > row) {
                drawUpperCell(cache, matrix, column, row, result.get());
                continue;
            }
            const int joint = result ? jointIndex(result->statistics, column, row) : -1;
            const PlotFrame frame = matrix.cell(column, row);
            ImGui::PushID(static_cast<int>(row * matrix.size() + column));
            const bool clicked =
                drawPlot(context, cache, view, matrix, column, row, frame,
                         joint >= 0 ? &cache.textures[static_cast<std::size_t>(joint)] : nullptr, result.get());
            ImGui::PopID();
            const bool shown = large.cells > 0 && large.column == column && large.row == row;
            if (shown) ImGui::GetWindowDrawList()->AddRect(frame.min, frame.max, plotColors().focus);
            if (clicked && shown)
                view.enlarged.clear();
            else if (clicked)
                view.enlarged = {matrix.infos[column].name, matrix.infos[row].name};
        }
    if (large.cells > 0) drawLarge(context, cache, view, matrix, large, result.get());
    if (cache.drag.active) context.interacting = true;

    ImDrawList& draw = *ImGui::GetWindowDrawList();
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        const PlotFrame across = matrix.cell(i, matrix.size() - 1), up = matrix.cell(0, i);
        drawAxis(draw, across, AxisSide::Bottom, matrix.infos[i].name, matrix.infos[i].unit, across.min.x,
                 across.max.x);
        if (i > 0)
            drawAxis(draw, up, AxisSide::Left, matrix.infos[i].name, matrix.infos[i].unit, up.min.y, up.max.y,
                     {.room = left});
    }
    if (!cache.feed.failure().empty() && !result)
        draw.AddText({matrix.min.x, matrix.min.y}, plotColors().text, cache.feed.failure().c_str());
}

} // namespace tessera::app
