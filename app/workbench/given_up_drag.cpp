#include "app/workbench/given_up_drag.h"

#include "app/ui/keys.h"

#include <imgui.h>

namespace tessera::app {

bool GivenUpDrag::begin() {
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

void GivenUpDrag::end() {
    active_ = ImGui::IsAnyItemActive() && !typing();
}

} // namespace tessera::app
