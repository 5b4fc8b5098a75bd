#include "app/pane/view_parts.h"
#include "app/ui/widgets.h"

namespace tessera::app {

void drawWorthSeeingView(ViewContext&, const std::string&, WorthSeeingView&) {
    drawHint("No data", "Lists what stands out in the data.");
}

} // namespace tessera::app
