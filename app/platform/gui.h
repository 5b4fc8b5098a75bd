#pragma once

#include "app/drawing/drawing.h"
#include "app/session/session.h"
#include "vis/gl/texture_name.h"
#include "vis/image/image_io.h"

#include <functional>
#include <glm/vec2.hpp>
#include <memory>

struct ImDrawData;
struct ImGuiContext;
struct ImGuiIO;

namespace tessera::app {

class Workbench;

/// An ImGui context with the OpenGL back end, for the GL context that is current, or without OpenGL. Restores the
/// previously current ImGui context when destroyed.
class Gui {
public:
    explicit Gui(vis::TexturesIn where = vis::TexturesIn::OpenGl);
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    /// Where the current ImGui context has its textures.
    static vis::TexturesIn textures();
    /// Begins a frame of ImGui.
    static void newFrame();
    /// Draws ImGui's draw data into the bound framebuffer of OpenGL.
    static void draw(glm::ivec2 framebuffer, Theme theme);
    /// The same by ImGui's back end alone.
    static void draw(ImDrawData& data);
    /// Takes the font atlas after a rebuild.
    static void uploadFonts();

private:
    ImGuiContext* context_ = nullptr;
    ImGuiContext* former_ = nullptr;
    vis::MemoryTexture letters_{.rgba = {}}; ///< without OpenGL
};

/// The colour behind all panes.
glm::vec3 windowGround(Theme theme);

/// Frames of a workbench in a framebuffer of its own, or in memory, as a window of this size would show them. Needs an
/// ImGui context (Gui), and a GL context if that has one.
class OffscreenFrames {
public:
    /// `smooth`: edges of shapes are antialiased. Throws MachineError when the size is too large.
    explicit OffscreenFrames(glm::ivec2 size, bool smooth = true);
    ~OffscreenFrames();
    OffscreenFrames(const OffscreenFrames&) = delete;
    OffscreenFrames& operator=(const OffscreenFrames&) = delete;

    /// Draws one frame, whose pixels are found when they are read; `input` may set mouse and keys; without it the mouse
    /// is outside and nothing is pressed.
    void draw(Workbench& workbench, float scale, const std::function<void(ImGuiIO&)>& input = {});
    /// The last frame, before the workbench draws another.
    vis::Image read() const;
    /// The last frame as vector graphics, `points` of the page per pixel; it must not be smooth.
    VectorPage page(const Workbench& workbench, double points) const;
    /// Draws the pixels of the last frame now.
    void show();
    /// Waits until GL has drawn everything so far.
    static void finish();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Draws frames of a workbench until nothing is busy. Throws MachineError, Cancelled.
void drawUntilDone(OffscreenFrames& target, Workbench& workbench, float scale);

/// The same in a framebuffer of its own, as a window of this size would, and reads the last frame. Needs what
/// OffscreenFrames does. Throws MachineError also when the size is too large.
vis::Image drawUntilDone(Workbench& workbench, glm::ivec2 size, float scale);

} // namespace tessera::app
