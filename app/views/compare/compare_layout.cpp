#include "app/views/compare/compare_layout.h"

#include "app/pane/view_parts.h"
#include "volume/derived/other_source.h"

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

/// Whether two bars differ only in the file that they are of.
bool sameBar(LegendEntry a, LegendEntry b) {
    for (LegendEntry* each : {&a, &b})
        if (each->title.ends_with(volume::kOtherSuffix))
            each->title.erase(each->title.size() - volume::kOtherSuffix.size());
    b.data = a.data;
    return a == b;
}

/// Makes bars equal that differ only in the file that they are of.
void joinFiles(CompareLegends& legends) {
    for (std::size_t i = 0; i < legends.size(); ++i)
        for (std::size_t k = i + 1; k < legends.size(); ++k) {
            if (!std::ranges::equal(legends[i], legends[k], sameBar)) continue;
            for (std::size_t n = 0; n < legends[i].size(); ++n) {
                LegendEntry &a = legends[i][n], &b = legends[k][n];
                if (a.title.size() > b.title.size()) a.title = b.title;
                a.data = {std::min(a.data.lo, b.data.lo), std::max(a.data.hi, b.data.hi)};
            }
            legends[k] = legends[i];
        }
}

/// Gives neighbours in a row that have the same legends one place for them.
void joinNeighbours(CompareLayout& layout) {
    for (std::size_t i = layout.places.size(); i-- > 1;) {
        PictureBox &before = layout.places[i - 1], &own = layout.places[i];
        if (before.min.y != own.min.y || !(layout.legends[i - 1] == layout.legends[i])) continue;
        before.size.x = own.max().x - before.min.x;
        layout.places.erase(layout.places.begin() + static_cast<std::ptrdiff_t>(i));
        layout.legends.erase(layout.legends.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

} // namespace

CompareLayout compareLayout(CompareLegends legends, int count, ImVec2 at, ImVec2 area) {
    CompareLayout layout;
    layout.legends = std::move(legends);
    joinFiles(layout.legends);
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
        const int column = i % shape.columns, row = i / shape.columns;
        const ImVec2 min{at.x + static_cast<float>(column) * (cell.x + gap),
                         at.y + static_cast<float>(row) * (cell.y + gap)};
        layout.pictures.push_back({min, {cell.x, cell.y - own}});
        for (std::size_t k = 0; own > 0 && k < beside; ++k)
            layout.places.push_back(
                {{min.x + width * static_cast<float>(k), min.y + cell.y - own}, {width - em(), own}});
    }
    if (own > 0) joinNeighbours(layout);
    if (common > 0) layout.places.push_back({{at.x, at.y + area.y - common}, {area.x, common}});
    return layout;
}

CompareLegends variantLegends(const ViewContext& context, const std::vector<std::shared_ptr<CompareCell>>& cells,
                              const std::vector<std::size_t>& shown) {
    CompareLegends legends;
    for (const std::size_t index : shown) {
        const CompareCell& cell = *cells[index];
        const auto& source = cell.isOpening() ? context.source : cell.source(context);
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
