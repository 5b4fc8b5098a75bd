#include "app/views/compare/compare_areas.h"

#include "app/pane/tool_row.h"
#include "app/pane/view_parts.h"
#include "app/views/compare/compare_layout.h"
#include "app/views/compare/compare_offers.h"
#include "app/views/compare/compare_panes.h"
#include "app/views/compare/compare_questions.h"
#include "app/views/compare/compare_table.h"
#include "volume/base/error.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

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

CompareAreas compareAreas(const CompareView& view, std::size_t variants, ImVec2 room, bool figure, bool bare) {
    CompareAreas areas;
    if (view.showTable && !bare) areas.table = std::min(compareTableHeight(variants), room.y * (figure ? 0.65f : 0.5f));
    if (!figure) areas.questions = std::min(questionsHeight(view), room.y * 0.3f);
    areas.pictures = {std::floor(room.x), std::floor(room.y - areas.table - areas.questions)};
    return areas;
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
            const ImVec2 area = compareAreas(view, variants.size(), below, false, false).pictures;
            const int count = grid ? static_cast<int>(variants.size()) : 1;
            const ImVec2 size = compareLayout(legends, count, {0, 0}, area).pictures[0].size;
            least = std::min(least, double(size.x) / std::max(1.0, double(size.y)));
        }
    }
    return least;
}

} // namespace tessera::app
