#include "app/edits/layout_brushes.h"

#include <algorithm>

namespace tessera::app {

namespace {

bool hasNoLens(const vis::Brush& brush, const std::vector<vis::Lens>& lenses) {
    const auto* const region = std::get_if<vis::LensRegion>(&brush.region);
    return region && !region->lens.empty() &&
           std::ranges::none_of(lenses, [&](const vis::Lens& lens) { return lens.name == region->lens; });
}

bool sameButForUse(vis::Brush a, const vis::Brush& b) {
    a.enabled = b.enabled;
    return a == b;
}

} // namespace

void keepOwnBrushes(Session& next, const Session& shown, std::vector<std::string>& messages) {
    if (shown.selection.brushes.empty()) return;
    std::vector<vis::Brush> kept;
    for (const vis::Brush& brush : shown.selection.brushes) {
        const auto same = [&](const vis::Brush& each) { return sameButForUse(each, brush); };
        if (std::ranges::any_of(shown.layoutBrushes, same)) continue;
        if (hasNoLens(brush, next.lenses))
            messages.push_back("brush " + brush.name + " is removed: the layout has no lens " +
                               std::get<vis::LensRegion>(brush.region).lens);
        else
            kept.push_back(brush);
    }
    const auto own = kept.size();
    const bool selects = std::ranges::any_of(kept, &vis::Brush::enabled);
    for (vis::Brush& brush : next.selection.brushes) {
        const auto same = [&](const vis::Brush& other) { return other.name == brush.name; };
        if (std::any_of(kept.begin(), kept.begin() + std::ptrdiff_t(own), same)) {
            messages.push_back("the layout's brush " + brush.name + " is left out: yours of that name stays");
            continue;
        }
        if (selects && brush.enabled) {
            brush.enabled = false;
            messages.push_back("the layout's brush " + brush.name + " is switched off, beside yours");
        }
        kept.push_back(std::move(brush));
    }
    next.selection.brushes = std::move(kept);
}

} // namespace tessera::app
