#include "app/dialogs/picture_request.h"

#include "app/ui/theme.h"
#include "volume/base/error.h"

#include <algorithm>
#include <cstdio>

namespace tessera::app {

std::vector<std::string> panesOf(const PictureRequest& request) {
    if (!request.panels.empty()) return request.panels;
    return request.pane.empty() ? std::vector<std::string>() : std::vector<std::string>{request.pane};
}

PictureRequest pictureRequest(const PictureForm& asked, const std::string& pane) {
    PictureForm form = asked;
    // Vectors have no pixels, and the pictures among them have as many as the largest text leaves.
    if (const double scale = double(scaleForText(form.size.textPixels()));
        form.size.onPaper() && form.format != PictureFormat::Png && scale > double(kLargestScale))
        form.size.dpi *= double(kLargestScale) * 0.999 / scale;
    PictureRequest request;
    request.pane = pane;
    request.size = form.size.pixels();
    request.ground = form.ground;
    request.decoration = form.decoration;
    request.format = form.format;
    if (std::min(request.size.x, request.size.y) < 16 || std::max(request.size.x, request.size.y) > 16384)
        throw Error("a picture of " + std::to_string(request.size.x) + "x" + std::to_string(request.size.y) +
                    " pixels cannot be drawn; each side must be 16 to 16384");
    request.scale = static_cast<float>(form.size.scale);
    if (!form.size.onPaper()) return request;
    request.dpi = form.size.dpi;
    request.scale = scaleForText(form.size.textPixels());
    if (request.scale < kLeastScale || request.scale > kLargestScale) {
        char text[160];
        std::snprintf(text, sizeof text, "text of %g pt at %g dpi is %.0f pixels high; it can be %.0f to %.0f",
                      form.size.textPt, form.size.dpi, form.size.textPixels(),
                      form.size.textPixels() * double(kLeastScale / request.scale),
                      form.size.textPixels() * double(kLargestScale / request.scale));
        throw Error(text);
    }
    return request;
}

} // namespace tessera::app
