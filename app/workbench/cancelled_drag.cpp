#include "app/workbench/cancelled_drag.h"

#include "app/ui/keys.h"

#include <imgui.h>

namespace tessera::app {

bool CancelledDrag::begin() {
    const bool held = mouseHeld();
    if (letGo_) {
        hideMouseButtons();
        letGo_ = held;
        return false;
    }
    if (!keyPressed(key::kEscape) || !(held || active_)) return false;
    letGoOfItems();
    letGo_ = held;
    return true;
}

void CancelledDrag::end() {
    active_ = ImGui::IsAnyItemActive() && !typing();
}

} // namespace tessera::app
