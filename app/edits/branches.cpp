#include "app/edits/branches.h"

#include <utility>

namespace tessera::app {

void selectBranch(Session& session, const std::vector<bool>& inside) {
    std::vector<vis::Brush>& brushes = session.selection.brushes;
    for (std::size_t i = 0; i < brushes.size(); ++i) {
        brushes[i].enabled = i < inside.size();
        if (!brushes[i].enabled) continue;
        brushes[i].inverted = !inside[i];
        brushes[i].combine = vis::BrushCombine::And;
    }
}

void selectLevel(Session& session, std::size_t count) {
    std::vector<vis::Brush>& brushes = session.selection.brushes;
    for (std::size_t i = 0; i < brushes.size(); ++i) brushes[i].enabled = i < count;
}

void moveBrush(Session& session, std::size_t brush, int by) {
    std::vector<vis::Brush>& brushes = session.selection.brushes;
    const auto to = static_cast<std::ptrdiff_t>(brush) + by;
    if (brush >= brushes.size() || to < 0 || to >= static_cast<std::ptrdiff_t>(brushes.size())) return;
    std::swap(brushes[brush], brushes[static_cast<std::size_t>(to)]);
}

} // namespace tessera::app
