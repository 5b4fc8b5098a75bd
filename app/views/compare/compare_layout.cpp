#include "app/views/compare/compare_layout.h"

#include "app/pane/tool_row.h"
#include "app/pane/view_parts.h"
#include "app/views/compare/compare_offers.h"
#include "app/views/compare/compare_panes.h"
#include "app/views/compare/compare_questions.h"
#include "app/views/compare/compare_table.h"
#include "volume/base/error.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

/// The height of the highest of the legends at this width, with the space above them.
float stripHeight(const CompareLegends& legends, float width, float most) {
    float height = 0;
    for (const std::vector<LegendEntry>& own : legends) height = std::max(height, legendRowsHeight(own, width, most));
    return height > 0 ? std::ceil(height + em() * 0.3f) : 0;
}

/// The room for legends below a picture of this height.
float mostBelow(float height) {
    return height * 0.5f;
}

/// The legends of the variants that a mode shows, with the data of the session. `differ`: as if the ranges of other
/// data, which are not open yet, were others.
CompareLegends likelyLegends(const CompareView& view, const Session& session, const volume::DatasetInfo& info,
                             const std::vector<CompareVariant>& variants, bool differ) {
    CompareLegends legends;
    for (const CompareVariant& variant : variants) {
        try {
            const Session changed = variantSession(session, variant);
            legends.push_back(sceneLegends(changed, info));
            if (differ && !(changed.data == session.data))
                for (LegendEntry& entry : legends.back())
                    if (!entry.swatch) entry.data = {0, double(legends.size())};
        } catch (const Error&) { // such a variant has no picture
            legends.emplace_back();
        }
    }
    if (modeOf(view) == CompareMode::Blink) legends.resize(1);
    if (modeOf(view) == CompareMode::Swipe) legends.resize(std::min<std::size_t>(legends.size(), 2));
    return legends;
}

} // namespace

CompareRooms compareRooms(const CompareView& view, std::size_t variants, ImVec2 room, bool figure, bool bare) {
    CompareRooms rooms;
    if (view.showTable && !bare) rooms.table = std::min(compareTableHeight(variants), room.y * (figure ? 0.65f : 0.5f));
    if (!figure) rooms.questions = std::min(questionsHeight(view), room.y * 0.3f);
    rooms.pictures = {std::floor(room.x), std::floor(room.y - rooms.table - rooms.questions)};
    return rooms;
}

double comparedAspect(const CompareView& view, const Session& session, const volume::DatasetInfo& info, ImVec2 pane) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const ImVec2 room{pane.x - 2 * style.WindowPadding.x, pane.y - 2 * style.WindowPadding.y};
    const float tools = em() * 45, row = ImGui::GetFrameHeightWithSpacing();
    const int most = std::min(static_cast<int>(std::ceil(tools / std::max(room.x, 1.0f))), toolRows(room.y, row));
    const std::vector<CompareVariant> variants = shownVariants(view, session, info);
    const CompareMode mode = modeOf(view);
    const bool grid = mode == CompareMode::Grid || mode == CompareMode::Difference;
    double least = 1e9;
    for (const bool differ : {false, true}) {
        const CompareLegends legends = likelyLegends(view, session, info, variants, differ);
        for (int rows = 1; rows <= most; ++rows) {
            const ImVec2 below{room.x, room.y - row * static_cast<float>(rows)};
            const ImVec2 area = compareRooms(view, variants.size(), below, false, false).pictures;
            const int count = grid ? static_cast<int>(variants.size()) : 1;
            const ImVec2 size = compareLayout(legends, count, {0, 0}, area).pictures[0].size;
            least = std::min(least, double(size.x) / std::max(1.0, double(size.y)));
        }
    }
    return least;
}

CompareLayout compareLayout(CompareLegends legends, int count, ImVec2 at, ImVec2 area) {
    CompareLayout layout;
    layout.legends = std::move(legends);
    const bool same = std::ranges::all_of(layout.legends, [&](const auto& own) { return own == layout.legends[0]; });
    if (same && !layout.legends.empty()) layout.legends.resize(1);
    const float common = same ? stripHeight(layout.legends, area.x, mostBelow(area.y)) : 0;
    const float gap = count > 1 ? std::round(em() * 0.2f) : 0;
    const GridShape shape = gridFor(count, double(area.x), double(area.y - common));
    const auto columns = static_cast<float>(shape.columns), rows = static_cast<float>(shape.rows);
    const ImVec2 cell{std::floor((area.x - gap * (columns - 1)) / columns),
                      std::floor((area.y - common - gap * rows) / rows)};
    // Of one picture that shows several variants, such as swipe, the legends are beside one another.
    const std::size_t beside = std::max<std::size_t>(layout.legends.size() / static_cast<std::size_t>(count), 1);
    const float width = cell.x / static_cast<float>(beside);
    const float own = same ? 0 : stripHeight(layout.legends, width - em(), mostBelow(cell.y));
    for (int i = 0; i < count; ++i) {
        const ImVec2 min{at.x + static_cast<float>(i % shape.columns) * (cell.x + gap),
                         at.y + static_cast<float>(i / shape.columns) * (cell.y + gap)};
        layout.pictures.push_back({min, {cell.x, cell.y - own}});
        for (std::size_t k = 0; own > 0 && k < beside; ++k)
            layout.places.push_back(
                {{min.x + width * static_cast<float>(k), min.y + cell.y - own}, {width - em(), own}});
    }
    if (common > 0) layout.places.push_back({{at.x, at.y + area.y - common}, {area.x, common}});
    return layout;
}

CompareLegends variantLegends(const ViewContext& context, const std::vector<std::shared_ptr<CompareCell>>& cells,
                              const std::vector<std::size_t>& shown) {
    CompareLegends legends;
    for (const std::size_t index : shown) {
        const CompareCell& cell = *cells[index];
        const auto& source = cell.source(context);
        legends.push_back(cell.failure.empty() && source ? sceneLegends(cell.session, source->info())
                                                         : std::vector<LegendEntry>{});
    }
    return legends;
}

void drawCompareLegends(ImDrawList& draw, const CompareLayout& layout) {
    for (std::size_t i = 0; i < layout.places.size() && i < layout.legends.size(); ++i) {
        const PictureBox& place = layout.places[i];
        draw.PushClipRect(place.min, place.max(), true);
        drawLegendRows(draw, layout.legends[i], {place.min.x, place.min.y + em() * 0.3f}, place.size.x,
                       place.size.y - em() * 0.3f + 1);
        draw.PopClipRect();
    }
}

} // namespace tessera::app
