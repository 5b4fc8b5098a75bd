#include "app/platform/window.h"

#include "app/platform/gui.h"
#include "app/platform/headless.h"
#include "app/platform/input_queue.h"
#include "app/ui/keys.h"
#include "app/workbench/workbench.h"
#include "app/workbench/workbench_commands.h"
#include "codec/remote/fetch_queue.h"
#include "vis/gl/headless.h"
#include "vis/gl/requirements.h"
#include "volume/base/error.h"

#include <epoxy/gl.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <algorithm>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <cmath>
#include <imgui.h>

namespace tessera::app {

namespace {

std::string lastGlfwError() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? text : "unknown reason";
}

struct Glfw {
    Glfw() {
        vis::guardShaderCache();
        if (glfwInit() != GLFW_TRUE) throw MachineError("no window can be opened: " + lastGlfwError());
    }
    ~Glfw() { glfwTerminate(); }
    Glfw(const Glfw&) = delete;
    Glfw& operator=(const Glfw&) = delete;
};

/// Describes what a driver without GL 4.5 lacks, from the best context it offers.
std::string whyNot() {
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    GLFWwindow* const window = glfwCreateWindow(16, 16, "Tessera", nullptr, nullptr);
    if (!window) return {};
    glfwMakeContextCurrent(window);
    const std::string missing = vis::missingFeatures();
    glfwMakeContextCurrent(nullptr);
    glfwDestroyWindow(window);
    return missing.empty() ? missing : "; " + missing;
}

struct Window {
    GLFWwindow* handle = nullptr;
    Workbench* workbench = nullptr;
    InputQueue input;
    int freshFrames = 3; ///< frames still to draw after the last event

    Window() {
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
        glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
        glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
        glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
        glm::ivec2 size(1500, 950);
        if (GLFWmonitor* monitor = glfwGetPrimaryMonitor()) {
            int x = 0, y = 0, w = 0, h = 0;
            glfwGetMonitorWorkarea(monitor, &x, &y, &w, &h);
            if (w > 0 && h > 0) size = glm::min(size, glm::ivec2(w, h));
        }
        // EGL first: with it, shaders compile in a second context while this one draws.
        for (const int api : {GLFW_EGL_CONTEXT_API, GLFW_NATIVE_CONTEXT_API}) {
            glfwWindowHint(GLFW_CONTEXT_CREATION_API, api);
            handle = glfwCreateWindow(size.x, size.y, "Tessera", nullptr, nullptr);
            if (handle) break;
        }
        if (!handle) throw MachineError("no window with OpenGL 4.5: " + lastGlfwError() + whyNot());
        glfwMakeContextCurrent(handle);
        glfwSwapInterval(1);
        glfwSetWindowSizeLimits(handle, 480, 320, GLFW_DONT_CARE, GLFW_DONT_CARE);
        glfwSetWindowUserPointer(handle, this);
        glfwSetCursorPosCallback(handle, [](GLFWwindow* w, double x, double y) {
            wake(w);
            of(w).input.add({.kind = InputQueue::Event::Move, .at = {float(x), float(y)}});
        });
        glfwSetMouseButtonCallback(handle, [](GLFWwindow* w, int button, int action, int mods) {
            wake(w);
            of(w).input.add({.kind = InputQueue::Event::Button,
                             .code = button,
                             .mods = mods,
                             .down = action == GLFW_PRESS,
                             .time = glfwGetTime()});
        });
        glfwSetScrollCallback(handle, [](GLFWwindow* w, double x, double y) {
            wake(w);
            of(w).input.add({.kind = InputQueue::Event::Wheel, .at = {float(x), float(y)}});
        });
        glfwSetKeyCallback(handle, [](GLFWwindow* w, int key, int scancode, int action, int mods) {
            wake(w);
            if (action == GLFW_REPEAT) return; // ImGui repeats by itself
            of(w).input.add({.kind = InputQueue::Event::Key,
                             .code = key,
                             .scancode = scancode,
                             .mods = mods,
                             .down = action == GLFW_PRESS});
        });
        glfwSetCharCallback(handle, [](GLFWwindow* w, unsigned letter) {
            wake(w);
            of(w).input.add({.kind = InputQueue::Event::Letter, .code = int(letter)});
        });
        glfwSetWindowFocusCallback(handle, [](GLFWwindow* w, int focused) {
            wake(w);
            if (focused == GLFW_FALSE && of(w).workbench) of(w).workbench->keyboard().lostWindow();
            ImGui_ImplGlfw_WindowFocusCallback(w, focused);
        });
        glfwSetCursorEnterCallback(handle, [](GLFWwindow* w, int entered) {
            wake(w);
            ImGui_ImplGlfw_CursorEnterCallback(w, entered);
            const auto& buttons = of(w).input.buttons;
            if (entered == GLFW_FALSE && std::find(buttons.begin(), buttons.end(), true) == buttons.end())
                of(w).input.add({.kind = InputQueue::Event::Move, .at = {-FLT_MAX, -FLT_MAX}});
        });
        glfwSetFramebufferSizeCallback(handle, [](GLFWwindow* w, int, int) { wake(w); });
        glfwSetWindowRefreshCallback(handle, [](GLFWwindow* w) { wake(w); });
        glfwSetWindowContentScaleCallback(handle, [](GLFWwindow* w, float, float) { wake(w); });
        glfwSetDropCallback(handle, [](GLFWwindow* w, int count, const char** paths) {
            wake(w);
            if (of(w).workbench) dropFiles(*of(w).workbench, {paths, paths + count});
        });
    }
    ~Window() { glfwDestroyWindow(handle); }
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    static Window& of(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }
    static void wake(GLFWwindow* window) { of(window).freshFrames = 3; }

    bool minimised() const {
        int w = 0, h = 0;
        glfwGetFramebufferSize(handle, &w, &h);
        return w == 0 || h == 0 || glfwGetWindowAttrib(handle, GLFW_ICONIFIED) == GLFW_TRUE;
    }
};

struct GlfwBackEnd {
    // Keep the window's own callbacks, which feed the queue.
    explicit GlfwBackEnd(GLFWwindow* window) {
        vis::guardShaderCache(); // there is a context now
        ImGui_ImplGlfw_InitForOpenGL(window, false);
    }
    ~GlfwBackEnd() { ImGui_ImplGlfw_Shutdown(); }
    GlfwBackEnd(const GlfwBackEnd&) = delete;
    GlfwBackEnd& operator=(const GlfwBackEnd&) = delete;
};

vis::Image readWindow(glm::ivec2 size) {
    vis::Image image;
    image.size = size;
    image.rgba.resize(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * 4);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    const std::size_t row = static_cast<std::size_t>(size.x) * 4;
    for (int y = 0; y < size.y; ++y)
        glReadPixels(0, size.y - 1 - y, size.x, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                     image.rgba.data() + static_cast<std::size_t>(y) * row);
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
    return image;
}

/// Takes the events of the system; where nothing is to be drawn, waits for one, or until `idle` seconds are over.
void awaitEvents(const Window& window, double idle) {
    if (window.minimised())
        glfwWaitEventsTimeout(0.5);
    else if (window.freshFrames > 0 || idle <= 0 || !window.input.empty())
        glfwPollEvents();
    else if (std::isfinite(idle))
        glfwWaitEventsTimeout(idle);
    else
        glfwWaitEvents();
}

void sayWhatIsOff(Workbench& workbench) {
    if (app::stateFolder().empty())
        workbench.message("Autosave is off, and nothing is remembered: there is no folder for it, $XDG_STATE_HOME or "
                          "~/.local/state",
                          true);
}

} // namespace

void runWindow(const OpenRequest& request, const std::string& screenshots) {
    const Glfw glfw;
    Window window;
    const Gui gui;
    const GlfwBackEnd backEnd(window.handle);
    Workbench workbench({.renderer = nullptr,
                         .render = {},
                         .headless = false,
                         .onlyPane = {},
                         .stateFolder = app::stateFolder(),
                         .wake = [] { glfwPostEmptyEvent(); }});
    window.workbench = &workbench;
    workbench.writePicture = [](const auto&... what) { writePicture(what...); };
    sayWhatIsOff(workbench);
    workbench.open(request);

    std::string title;
    bool photographed = false;
    while (!workbench.finished()) {
        awaitEvents(window, workbench.idleSeconds());
        if (glfwWindowShouldClose(window.handle) == GLFW_TRUE) {
            glfwSetWindowShouldClose(window.handle, GLFW_FALSE);
            workbench.requestQuit();
            window.freshFrames = 3;
        }
        if (window.minimised()) continue;
        // Counted from the frame that takes the last event: what a click opens appears in the frames after it.
        window.freshFrames = window.input.empty() ? std::max(0, window.freshFrames - 1) : 3;

        float contentScale = 1, unused = 1;
        glfwGetWindowContentScale(window.handle, &contentScale, &unused);
        int width = 0, height = 0, pixelsX = 0, pixelsY = 0;
        glfwGetWindowSize(window.handle, &width, &height);
        glfwGetFramebufferSize(window.handle, &pixelsX, &pixelsY);
        // If window coordinates are points (Wayland, macOS), the framebuffer already has more pixels.
        if (width > 0 && pixelsX > width) contentScale = std::max(1.0f, contentScale * float(width) / float(pixelsX));
        if (workbench.prepare(contentScale)) Gui::uploadFonts();
        window.input.take(
            [&](const InputQueue::Event& event) {
                if (event.kind == InputQueue::Event::Letter)
                    ImGui_ImplGlfw_CharCallback(window.handle, static_cast<unsigned>(event.code));
                else
                    ImGui_ImplGlfw_KeyCallback(window.handle, event.code, event.scancode,
                                               event.down ? GLFW_PRESS : GLFW_RELEASE, event.mods);
            },
            ImGui::GetIO().WantTextInput);
        ImGui_ImplOpenGL3_NewFrame();
        ImGui_ImplGlfw_NewFrame();
        ImGuiIO& io = ImGui::GetIO();
        feedMouse(io, window.input.mouse, window.input.buttons);
        io.MouseDoubleClickTime = window.input.twice ? FLT_MAX : 0; // not by when frames see the presses
        ImGui_ImplGlfw_ScrollCallback(window.handle, double(window.input.wheel.x), double(window.input.wheel.y));
        // The back end reads the current modifiers from GLFW; replace them by those that belong to the keys of this
        // frame.
        feedModifiers(io, window.input.held(InputQueue::kControl), window.input.held(InputQueue::kShift),
                      window.input.held(InputQueue::kAlt), window.input.held(InputQueue::kSuper));
        ImGui::NewFrame();
        workbench.frame();
        ImGui::Render();
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        Gui::draw({pixelsX, pixelsY}, workbench.session().appearance.theme);
        // Read before the swap: afterwards the back buffer is undefined.
        const bool complete =
            !workbench.busy() && workbench.source() != nullptr && window.freshFrames == 0 && window.input.empty();
        if (!screenshots.empty() && complete && !photographed)
            vis::writePng(screenshots, readWindow({pixelsX, pixelsY}));
        photographed = complete;
        glfwSwapBuffers(window.handle);
        workbench.afterFrame();
        if (std::string next = workbench.document().windowTitle(); next != title) {
            title = std::move(next);
            glfwSetWindowTitle(window.handle, title.c_str());
        }
    }
    codec::endRequests(); // jobs that wait for another machine would hold the window open
    window.workbench = nullptr;
}

} // namespace tessera::app
