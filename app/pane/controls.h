#pragma once

#include "app/pane/view_context.h"
#include "app/ui/theme.h"

/// Buttons with glyphs, sizes of controls, and help under the mouse.
namespace tessera::app {

/// Glyphs of Font Awesome 4 and the words that stand for them where the font is missing.
struct Icon {
    const char* glyph;
    const char* word;
};
namespace icons {
inline constexpr Icon kEye{icon::kEye, "on"}, kEyeOff{icon::kEyeOff, "off"}, kPlus{icon::kPlus, "+"},
    kTrash{icon::kTrash, "x"}, kCopy{icon::kCopy, "copy"}, kCube{icon::kCube, "vol"}, kIso{"\uf219", "iso"},
    kSlice{"\uf24d", "slice"}, kFlow{"\uf178", "flow"}, kGlyph{"\uf069", "glyph"}, kPlay{icon::kPlay, ">"},
    kPause{icon::kPause, "||"}, kStepBack{icon::kStepBack, "<|"}, kStepForward{icon::kStepForward, "|>"},
    kFirst{icon::kFirst, "|<"}, kLast{icon::kLast, ">|"}, kRepeat{icon::kRepeat, "loop"},
    kPingPong{icon::kPingPong, "<>"}, kOnce{icon::kOnce, "once"}, kInvert{icon::kInvert, "inv"},
    kReverse{"\uf0ec", "rev"}, kColors{"\uf1fb", "own"}, kChain{icon::kChain, "link"},
    kChainOff{icon::kChainOff, "own"};
} // namespace icons

/// A square button with a glyph, its tooltip on hover; `enabled` false greys it out.
bool iconButton(const ViewContext& context, const char* id, Icon icon, const char* tooltip, bool enabled = true,
                bool lit = false);
float iconButtonWidth(const ViewContext& context, Icon icon);
/// A glyph without a button.
void iconText(const ViewContext& context, Icon icon, ImU32 color);
ImVec2 iconSize(const ViewContext& context, Icon icon);

/// Wrapped help on hover of the last item.
void tooltip(const char* text);

/// Pixels that controls with this text take.
float buttonWidth(const char* text);
float checkboxWidth(const char* text);

} // namespace tessera::app
