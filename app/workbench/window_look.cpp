#include "app/workbench/window_look.h"

#include <algorithm>

namespace tessera::app {

bool WindowLook::prepare(float contentScale, const Appearance& appearance) {
    contentScale_ = contentScale;
    const float scale = scaleWith(appearance);
    const bool rebuilt = scale != scale_;
    if (rebuilt) {
        scale_ = scale;
        fonts_ = loadFonts(scale);
        styled_ = false;
    }
    if (!styled_ || theme_ != appearance.theme) {
        theme_ = appearance.theme;
        applyTheme(theme_, scale_);
        styled_ = true;
    }
    return rebuilt;
}

float WindowLook::scaleWith(const Appearance& appearance) const {
    return std::clamp(contentScale_ * appearance.scale, kLeastScale, kLargestScale);
}

} // namespace tessera::app
