#include "app/pane/view_parts.h"
#include "app/ui/widgets.h"

namespace tessera::app {

void drawScatter3dView(ViewContext&, const std::string&, Scatter3dView&) {
    drawHint("No data", "Shows the samples over three parameters.");
}

} // namespace tessera::app
