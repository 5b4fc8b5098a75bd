#pragma once

#include "app/ui/keys.h"
#include "app/ui/theme.h"

#include <gtest/gtest.h>
#include <imgui.h>

namespace tessera::app {

/// ImGui without a GPU: frames of 800 x 600 with a mouse and keys that the test holds.
class UiTest : public ::testing::Test {
protected:
    void SetUp() override {
        context = ImGui::CreateContext();
        ImGui::SetCurrentContext(context);
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {800, 600};
        setUpKeys(io);
        loadFonts(1);
        applyTheme(Theme::Dark, 1);
        unsigned char* pixels = nullptr;
        int w = 0, h = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &w, &h);
    }
    void TearDown() override { ImGui::DestroyContext(context); }

    template <class Body> void frame(Body&& body) {
        ImGuiIO& io = ImGui::GetIO();
        io.DeltaTime = 1.0f / 60;
        io.MousePos = mouse;
        io.MouseDown[0] = held;
        ImGui::NewFrame();
        body();
        ImGui::Render();
    }

    ImGuiContext* context = nullptr;
    ImVec2 mouse{-1, -1};
    bool held = false;
};

} // namespace tessera::app
