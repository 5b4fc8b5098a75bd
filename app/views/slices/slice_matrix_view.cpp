#include "app/pane/view_parts.h"
#include "app/planes/plane_export.h"
#include "app/planes/plane_pane.h"
#include "app/queries/async_query.h"
#include "app/ui/number_field.h"
#include "app/ui/widgets.h"
#include "app/views/slices/slice_matrix.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr std::size_t kMostRows = 6; ///< where the user has not chosen

/// What is asked of each slice: whether it shows a value.
struct PresenceQuery {
    struct Slice {
        int channel = 0;
        PicturePlane plane;
        volume::TimePair time;
        bool operator==(const Slice&) const = default;
    };
    std::vector<Slice> slices;
    bool operator==(const PresenceQuery&) const = default;
};

struct SliceMatrixCache : ViewCache {
    std::vector<PlaneState> slices; ///< column by column
    AsyncQuery<PresenceQuery, std::vector<bool>> presence;
};

/// Where the cells are, pixels.
struct MatrixLayout {
    ImVec2 origin;           ///< of the whole, with names of rows and columns
    float title = 0;         ///< width of the names of rows
    float head = 0;          ///< height of the names of columns
    float gap = 0;           ///< between cells
    float legend = 0;        ///< width of upright legends, 0 = none
    ImVec2 cell;             ///< room of a cell
    std::vector<float> left; ///< of each column, and the end of the last
    std::vector<float> high; ///< of the highest picture of each row
};

/// `text` as far as there is room, else the same without its unit, else its number alone.
std::string nameThatFits(const std::string& text, float room) {
    const std::string plain = text.substr(0, text.find(" [")),
                      number = text.substr(std::min(text.rfind("= "), text.size()));
    const std::string value = number.size() > 2 ? number.substr(2) : plain;
    const std::string fits = firstThatFits({text, plain, value, value.substr(0, value.find(' '))}, room);
    return fits.empty() || ImGui::CalcTextSize(fits.c_str()).x > room ? fitText(plain, room) : fits;
}

void chooseMatrixSide(ViewContext& context, ToolRow& tools, SliceMatrixView& view, bool rows) {
    constexpr const char* kWords[] = {"parameters", "directions", "positions", "times"};
    if (!tools.next(em() * 7)) return;
    MatrixAxis& own = rows ? view.rows : view.columns;
    MatrixAxis& other = rows ? view.columns : view.rows;
    ImGui::SetNextItemWidth(em() * 7);
    if (ImGui::BeginCombo(rows ? "##rows" : "##columns", kWords[static_cast<int>(own)])) {
        for (int i = 0; i < 4; ++i) {
            const auto what = static_cast<MatrixAxis>(i);
            const bool possible = what != MatrixAxis::Times || context.source->info().times.size() > 1;
            ImGui::BeginDisabled(!possible);
            if (ImGui::Selectable(kWords[i], own == what) && own != what) {
                if (other == what) other = own; // they swap
                own = what;
            }
            ImGui::EndDisabled();
        }
        ImGui::EndCombo();
    }
    if (ImGui::IsItemHovered()) tooltip(rows ? "What rows differ in" : "What columns differ in");
}

void choosePlaneAxis(volume::SpaceAxis& axis) {
    ImGui::SetNextItemWidth(em() * 3.4f);
    if (ImGui::BeginCombo("##axis", volume::kSpaceAxisNames[static_cast<std::size_t>(axis)].data())) {
        for (int i = 0; i < 3; ++i)
            if (ImGui::Selectable(volume::kSpaceAxisNames[i].data(), static_cast<int>(axis) == i))
                axis = static_cast<volume::SpaceAxis>(i);
        ImGui::EndCombo();
    }
    if (ImGui::IsItemHovered()) tooltip("Axis perpendicular to the planes");
}

void chooseCount(ToolRow& tools, const char* id, int& count, int most, const char* one, const char* many) {
    if (!tools.next(em() * 6)) return;
    ImGui::SetNextItemWidth(em() * 6);
    slider(id, count, 1, most, count == 1 ? one : many);
}

void drawMatrixToolbar(ViewContext& context, SliceMatrixView& view, const std::vector<int>& shown) {
    const volume::DatasetInfo& info = context.source->info();
    ToolRow tools(context);
    chooseChannels(tools, info, view.channels, shown);
    chooseMatrixSide(context, tools, view, true);
    chooseMatrixSide(context, tools, view, false);
    if (!view.over(MatrixAxis::Directions) && tools.next(em() * 3.4f)) choosePlaneAxis(view.axis);
    if (view.over(MatrixAxis::Positions)) chooseCount(tools, "##planes", view.planes, 12, "%d plane", "%d planes");
    if (view.over(MatrixAxis::Times)) chooseCount(tools, "##times", view.times, 24, "%d time", "%d times");
    SliceMatrix exported = sliceMatrix(context.session, drawnSource(context)->info(), view, shown);
    const std::string common = commonText(context.session, info, view, exported);
    std::vector<int> channels = shown;
    if (!view.over(MatrixAxis::Parameters) && channels.size() > 1) channels.resize(1);
    exportPlanes(context, tools, "slices", std::move(exported.pictures), std::max(1, exported.columns), channels);
    if (tools.fits(ImGui::CalcTextSize(common.c_str()).x)) drawNote(tools, common);
}

/// Row by row: whether a slice shows a value; true until that is known.
std::vector<bool> shownValues(ViewContext& context, SliceMatrixCache& cache, const SliceMatrix& matrix,
                              const std::string& pane) {
    PresenceQuery query;
    for (const PlanePicture& slice : matrix.pictures)
        query.slices.push_back({slice.shows.channel, slice.plane, slice.time});
    const auto found = cache.presence.get(
        context, context.source,
        {.key = pane + " values", .title = "Values of slices", .quiet = true, .lowPriority = true}, query,
        [pictures = matrix.pictures](const std::shared_ptr<const volume::BrickSource>& source, const PresenceQuery&,
                                     int, const Progress& progress) {
            std::vector<bool> out;
            const double each = 1 / static_cast<double>(std::max<std::size_t>(1, pictures.size()));
            for (std::size_t i = 0; i < pictures.size(); ++i)
                out.push_back(
                    showsValues(*source, pictures[i],
                                progress.part(static_cast<double>(i) * each, static_cast<double>(i + 1) * each)));
            return out;
        },
        [](const PresenceQuery&, const PresenceQuery&) { return false; });
    return found ? *found : std::vector<bool>(matrix.pictures.size(), true);
}

PlaneFrame cellFrame(const PlanePicture& slice, const vis::WorldFrame& world, const volume::Box& bounds, ImVec2 room) {
    return planeFrame(slice, world, bounds, {}, planeScale(slice, {}, room, 0));
}

/// Cells as large as the pane has room for, but not below `least`: then the pane scrolls.
MatrixLayout layOutMatrix(const ViewContext& context, const SliceMatrixView& view, const SliceMatrix& matrix,
                          const vis::WorldFrame& world, ImVec2 least) {
    const volume::DatasetInfo& info = context.source->info();
    const float rows = static_cast<float>(matrix.rows), columns = static_cast<float>(matrix.columns);
    MatrixLayout out;
    out.gap = em() * 0.4f;
    out.title = em() * 1.5f;
    out.head = em() * 1.3f;
    const bool below = view.columns == MatrixAxis::Parameters; // legends of columns stand below them
    const ImVec2 room = ImGui::GetContentRegionAvail();
    if (!below && room.x >= em() * 20)
        for (const PlanePicture& slice : matrix.pictures)
            out.legend =
                std::max({out.legend, em() * 5,
                          legendColumnWidth(legendOf(context.session, info, slice.shows.channel)) + em() * 0.5f});
    const float under = below ? legendBarHeight() : 0;
    out.origin = ImGui::GetCursorScreenPos();
    const float high = std::max(heightAtLeast(out.head + under + (least.y + out.gap) * rows), 1.0f);
    const float fits = (room.x - out.title - out.legend) / columns - out.gap;
    out.cell = {std::max(fits, least.x), (high - out.head - under) / rows - out.gap};
    float x = out.title;
    for (int column = 0; column < matrix.columns; ++column) {
        out.left.push_back(x);
        float wide = em() * 6.5f; // narrow slices stand close together, but not closer than their titles
        for (int row = 0; row < matrix.rows; ++row)
            wide = std::max(wide, cellFrame(matrix.at(row, column), world, info.bounds, out.cell).plot.max.x);
        x += std::min(out.cell.x, wide) + out.gap;
    }
    out.left.push_back(x);
    for (int row = 0; row < matrix.rows; ++row) {
        float& most = out.high.emplace_back(0.0f);
        for (int column = 0; column < matrix.columns; ++column)
            most = std::max(most, cellFrame(matrix.at(row, column), world, info.bounds, out.cell).plot.max.y);
    }
    return out;
}

void drawMatrixNames(const MatrixLayout& layout, const SliceMatrix& matrix) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    for (int column = 0; column < matrix.columns; ++column) {
        const auto k = static_cast<std::size_t>(column);
        const ImVec2 at{std::round(layout.origin.x + layout.left[k]), layout.origin.y};
        const std::string& whole = matrix.columnNames[k];
        const std::string text = nameThatFits(whole, layout.left[k + 1] - layout.left[k] - layout.gap);
        const ImVec2 size = ImGui::CalcTextSize(text.c_str());
        draw.AddText(at, plotColors().text, text.c_str());
        tellWhole(at, {at.x + size.x, at.y + size.y}, whole, text);
    }
    for (int row = 0; row < matrix.rows; ++row) {
        const float y = layout.origin.y + layout.head + (layout.cell.y + layout.gap) * static_cast<float>(row);
        const std::string text =
            nameThatFits(matrix.rowNames[static_cast<std::size_t>(row)], layout.cell.y + layout.gap);
        addTextUpwards(draw, {layout.origin.x + em() * 0.6f, y + layout.high[static_cast<std::size_t>(row)] / 2},
                       plotColors().text, text.c_str());
    }
}

/// One for each parameter: at the right of rows, below columns.
void drawMatrixLegends(const ViewContext& context, const SliceMatrixView& view, const MatrixLayout& layout,
                       const SliceMatrix& matrix) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const auto legend = [&](int row, int column) {
        return legendOf(context.session, context.source->info(), matrix.at(row, column).shows.channel);
    };
    if (view.columns == MatrixAxis::Parameters) {
        const float y = layout.origin.y + layout.head + (layout.cell.y + layout.gap) * static_cast<float>(matrix.rows);
        for (int column = 0; column < matrix.columns; ++column) {
            const auto k = static_cast<std::size_t>(column);
            LegendEntry entry = legend(0, column);
            entry.title = entry.unit = ""; // the head of the column has them
            drawLegendBar(draw, {layout.origin.x + layout.left[k], y},
                          std::min(layout.left[k + 1] - layout.left[k] - layout.gap, em() * 14), entry);
        }
        return;
    }
    if (!(layout.legend > 0)) return;
    const int bars = view.rows == MatrixAxis::Parameters ? matrix.rows : 1;
    for (int row = 0; row < bars; ++row)
        drawLegendColumn(
            draw,
            {layout.origin.x + layout.left.back(),
             std::round(layout.origin.y + layout.head + (layout.cell.y + layout.gap) * static_cast<float>(row))},
            layout.high[static_cast<std::size_t>(row)], legend(row, 0));
}

void drawMatrixCell(ViewContext& context, PlaneState& state, const PlanePicture& slice, const PlaneFrame& frame,
                    int index, double share, const std::string& pane) {
    ImGui::PushID(index);
    useMouse(context, state, slice, frame);
    if (slice.ownTime && ImGui::IsItemActivated()) {
        context.session.time = *slice.ownTime;
        context.session.animation.playing = false;
    }
    ImGui::PopID();
    drawPicture(context, state, slice, frame, share, pane + std::to_string(index));
    drawOver(context, state, slice, frame, {});
}

void drawMatrixCells(ViewContext& context, SliceMatrixCache& cache, const MatrixLayout& layout,
                     const SliceMatrix& matrix, const vis::WorldFrame& world, const std::string& pane) {
    cache.slices.resize(matrix.pictures.size());
    const std::vector<bool> values = shownValues(context, cache, matrix, pane);
    const ImVec2 lo = ImGui::GetWindowDrawList()->GetClipRectMin(), hi = ImGui::GetWindowDrawList()->GetClipRectMax();
    for (int column = 0; column < matrix.columns; ++column)
        for (int row = 0; row < matrix.rows; ++row) {
            const PlanePicture& slice = matrix.at(row, column);
            PlaneFrame frame = cellFrame(slice, world, context.source->info().bounds, layout.cell);
            const ImVec2 size = frame.plot.max;
            const ImVec2 at{
                std::round(layout.origin.x + layout.left[static_cast<std::size_t>(column)]),
                std::round(layout.origin.y + layout.head + (layout.cell.y + layout.gap) * static_cast<float>(row))};
            frame.plot.min = at, frame.plot.max = {at.x + size.x, at.y + size.y};
            if (at.x >= hi.x || at.y >= hi.y || frame.plot.max.x <= lo.x || frame.plot.max.y <= lo.y) continue;
            const int index = column * matrix.rows + row;
            drawMatrixCell(context, cache.slices[static_cast<std::size_t>(index)], slice, frame, index,
                           1 / static_cast<double>(cache.slices.size()), pane);
            if (!values[static_cast<std::size_t>(row * matrix.columns + column)])
                addFittedWithBackdrop(*ImGui::GetWindowDrawList(), {at.x + size.x / 2, at.y + (size.y - em()) / 2},
                                      {0.5f, 0}, plotColors().faint, "no values", size.x);
        }
}

} // namespace

void drawSliceMatrixView(ViewContext& context, const std::string& pane, SliceMatrixView& view) {
    if (!context.source) {
        drawHint("No data", "Shows every parameter on several planes.");
        return;
    }
    const volume::DatasetInfo& info = context.source->info();
    SliceMatrixCache& cache = cacheOf<SliceMatrixCache>(context, pane);
    const std::vector<int> shown = chosenChannels(info, view.channels, kMostRows);
    const vis::WorldFrame world = vis::worldFrame(info, context.session.stretch);
    view.planes = std::clamp(view.planes, 1, 12);
    view.times = std::clamp(view.times, 1, 24);
    drawMatrixToolbar(context, view, shown);
    drawStretch(context);
    if (shown.empty()) return drawHint("No parameters", "This data set has only labels.");
    const SliceMatrix matrix = sliceMatrix(context.session, info, view, shown);
    if (matrix.pictures.empty() || !std::ranges::all_of(matrix.pictures, [](const PlanePicture& slice) {
            return slice.size.x > 0 && slice.size.y > 0;
        }))
        return drawHint("No extent", "The data have no extent within these planes.");

    const ImVec2 least{em() * 3, em() * 1.8f};
    const ImVec2 room = ImGui::GetContentRegionAvail();
    if (room.x < em() * 3.5f) return drawHint("Not enough room", "Enlarge the pane, or show fewer slices.");
    const float wide = em() * 1.5f + (least.x + em() * 0.4f) * static_cast<float>(matrix.columns);
    const bool scrolled = wide > room.x && context.takesInput();
    if (scrolled) {
        ImGui::SetNextWindowContentSize({wide, 0});
        ImGui::BeginChild("cells", {0, 0}, false, ImGuiWindowFlags_HorizontalScrollbar);
    }
    const MatrixLayout layout = layOutMatrix(context, view, matrix, world, {scrolled ? least.x : 1, least.y});
    drawMatrixCells(context, cache, layout, matrix, world, pane);
    if (context.decoration.title) drawMatrixNames(layout, matrix);
    if (context.decoration.legend) drawMatrixLegends(context, view, layout, matrix);
    if (scrolled) ImGui::EndChild();
}

} // namespace tessera::app
