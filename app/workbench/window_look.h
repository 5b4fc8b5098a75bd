#pragma once

#include "app/ui/theme.h"

namespace tessera::app {

/// Fonts and style of the window, for the scale of the display and the appearance settings of the session.
class WindowLook {
public:
    /// Before ImGui::NewFrame. True when the font atlas changed and must be uploaded.
    bool prepare(float contentScale, const Appearance& appearance);
    const Fonts& fonts() const { return fonts_; }
    bool hasIcons() const { return fonts_.icons != nullptr; }
    float scale() const { return scale_; } ///< pixels per design pixel
    /// The scale once these settings apply.
    float scaleWith(const Appearance& appearance) const;

private:
    Fonts fonts_;
    float scale_ = 0, contentScale_ = 1;
    Theme theme_ = Theme::Dark;
    bool styled_ = false;
};

} // namespace tessera::app
