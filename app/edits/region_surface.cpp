#include "app/edits/region_surface.h"

#include "app/session/label_colors.h"

#include <cmath>

namespace tessera::app {

void aimAtRegion(vis::IsoLayer& surface, const volume::Parameter& label, std::optional<int> value) {
    int first = label.ranges.empty() ? 0 : int(std::lround(label.ranges.front().lo));
    if (!label.labels.empty()) first = label.labels.front().value;
    surface.method = vis::SurfaceMethod::Polygons; // which are closed; rays cannot tell the sides of a border apart
    surface.value = value.value_or(first);
    surface.color = labelColor(label, int(std::lround(surface.value)));
}

} // namespace tessera::app
