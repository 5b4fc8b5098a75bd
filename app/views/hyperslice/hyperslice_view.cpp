#include "app/pane/view_parts.h"
#include "app/ui/widgets.h"

namespace tessera::app {

void drawHyperSliceView(ViewContext&, const std::string&, HyperSliceView&) {
    drawHint("No data", "Shows all slices through a point in space and time.");
}

} // namespace tessera::app
