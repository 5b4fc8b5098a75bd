#include "app/pane/view_parts.h"
#include "app/ui/widgets.h"

namespace tessera::app {

void drawParallelCoordinatesView(ViewContext&, const std::string&, ParallelCoordinatesView&) {
    drawHint("No data", "Shows how all parameters depend on each other.");
}

} // namespace tessera::app
