#pragma once

#include "app/session/session.h"
#include "vis/image_io.h"

#include <glm/vec2.hpp>

struct ImGuiContext;

namespace tessera::app {

class Workbench;

/// An ImGui context with the OpenGL back end, for the GL context that is current. While it lives it can be made the
/// current ImGui context; the former one comes back when it goes.
class Gui {
public:
    Gui();
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    /// Draws what ImGui::Render left into the bound framebuffer.
    static void draw(glm::ivec2 framebuffer, Theme theme);
    /// Uploads a font atlas that was built again.
    static void uploadFonts();

private:
    ImGuiContext* context_ = nullptr;
    ImGuiContext* former_ = nullptr;
};

/// Runs frames of a workbench in a framebuffer of its own, as a window of this size would, until nothing is busy, and
/// reads the last one. Needs an ImGui context (Gui) and a GL context. Throws MachineError when the size is too large,
/// Cancelled.
vis::Image drawUntilDone(Workbench& workbench, glm::ivec2 size, float scale);

} // namespace tessera::app
