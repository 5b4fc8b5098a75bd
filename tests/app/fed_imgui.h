#pragma once

#include "app/ui/keys.h"

#include <gtest/gtest.h>
#include <imgui.h>
#include <string>

namespace tessera::app {

/// ImGui without a window system or a GPU: a test feeds it the mouse and looks at what a frame did.
class FedImGui : public testing::Test {
protected:
    explicit FedImGui(ImVec2 display) {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.DisplaySize = display;
        io.IniFilename = nullptr;
        setUpKeys(io);
    }
    ~FedImGui() override { ImGui::DestroyContext(); }

    /// One frame in which `body` makes the widgets. The default fonts are built before the first.
    template <class Body> void feed(Body&& body, float seconds = 1.0f / 60) {
        ImGuiIO& io = ImGui::GetIO();
        unsigned char* pixels;
        int width, height;
        if (!io.Fonts->IsBuilt()) io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
        io.DeltaTime = seconds;
        io.MousePos = mouse;
        ImGui::NewFrame();
        body();
        ImGui::Render();
        io.MouseWheel = 0;
    }
    /// The same within a window over the whole display that nothing moves.
    template <class Body> void feedWindow(Body&& body, float seconds = 1.0f / 60) {
        feed(
            [&] {
                ImGui::SetNextWindowPos({0, 0});
                ImGui::SetNextWindowSize(ImGui::GetIO().DisplaySize);
                ImGui::Begin("test", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
                body();
                ImGui::End();
            },
            seconds);
    }
    template <class Body> void frames(int count, const Body& body) {
        for (int i = 0; i < count; ++i) feed(body);
    }
    /// A left click, and frames until what it opened is there.
    template <class Body> void click(ImVec2 at, const Body& body) {
        mouse = at;
        frames(2, body);
        for (const bool down : {true, false}) {
            ImGui::GetIO().MouseDown[0] = down;
            feed(body);
        }
        frames(3, body);
    }
    /// The texts of the widgets that `body` makes in a frame of its own (not what it draws by itself).
    template <class Body> std::string said(Body&& body) {
        std::string out;
        ImGuiIO& io = ImGui::GetIO();
        io.ClipboardUserData = &out;
        io.SetClipboardTextFn = [](void* into, const char* text) { *static_cast<std::string*>(into) += text; };
        feed([&] {
            ImGui::LogToClipboard();
            body();
            ImGui::LogFinish();
        });
        io.ClipboardUserData = nullptr;
        return out;
    }
    /// An item from `min` to `max` that takes both mouse buttons.
    static void surface(ImVec2 min, ImVec2 max) {
        ImGui::SetCursorScreenPos(min);
        ImGui::InvisibleButton("surface", {max.x - min.x, max.y - min.y},
                               ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    }

    ImVec2 mouse{-1000, -1000};
};

} // namespace tessera::app
