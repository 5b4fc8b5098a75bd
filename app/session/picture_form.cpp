#include "app/session/picture_form.h"

#include <cmath>

namespace tessera::app {

std::optional<Decoration> Decoration::preset(std::string_view name) {
    if (name == "all") return Decoration{};
    if (name != "none") return std::nullopt;
    return Decoration{false, false, false, false, false, false, false, false};
}

glm::ivec2 PictureSize::pixels() const {
    if (!onPaper()) return {width, height};
    const auto along = [this](double mm) { return static_cast<int>(std::lround(mm / 25.4 * dpi)); };
    return {along(widthMm), along(heightMm > 0 ? heightMm : widthMm * 0.75)};
}

std::optional<PictureSize> PictureSize::preset(std::string_view name) {
    constexpr auto kPaper = PictureMeasure::Millimetres;
    if (name == "screen") return PictureSize{};
    if (name == "slide") return PictureSize{.scale = 1.5};
    if (name == "oneColumn") return PictureSize{.measure = kPaper, .widthMm = 85, .heightMm = 64};
    if (name == "twoColumns") return PictureSize{.measure = kPaper, .widthMm = 174, .heightMm = 109};
    if (name == "poster")
        return PictureSize{.measure = kPaper, .widthMm = 400, .heightMm = 300, .dpi = 200, .textPt = 24};
    return std::nullopt;
}

} // namespace tessera::app
