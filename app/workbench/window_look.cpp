#include "app/workbench/window_look.h"

#include <algorithm>

namespace tessera::app {

bool WindowLook::prepare(float contentScale, const Appearance& appearance) {
    const float scale = std::clamp(contentScale * appearance.scale, kLeastScale, kLargestScale);
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

} // namespace tessera::app
