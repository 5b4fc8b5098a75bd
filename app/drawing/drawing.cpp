#include "app/drawing/drawing.h"

namespace tessera::app {

std::string fileOf(const VectorPage& drawing, std::string_view suffix) {
    return suffix == "pdf" ? pdfOf(drawing) : svgOf(drawing);
}

} // namespace tessera::app
