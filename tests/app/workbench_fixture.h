#pragma once

#include "app/platform/gui.h"
#include "app/ui/keys.h"
#include "app/workbench/workbench.h"
#include "vis/gl/headless.h"

#include <chrono>
#include <gtest/gtest.h>
#include <imgui.h>
#include <string>

namespace tessera::app {

/// Draws until every job is done and nothing refines. Fails where that takes minutes, and says what is not done.
inline void settle(Workbench& workbench, OffscreenFrames& frames) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    do {
        workbench.jobs().wait();
        frames.draw(workbench, 1);
        if (std::chrono::steady_clock::now() < end) continue;
        std::string left;
        for (const Jobs::Status& job : workbench.jobs().list()) left += " job " + job.title;
        if (workbench.panes().busy())
            left += workbench.panes().hurries() ? " a pane that hurries" : " a pane that waits";
        if (ImGui::IsAnyItemActive()) left += " while an item is held";
        ADD_FAILURE() << "never done:" << left;
        return;
    } while (workbench.busy());
    for (int i = 0; i < 4; ++i) frames.draw(workbench, 1);
}

/// A workbench with a window in memory, whose frames a test draws one by one.
class DrawnWorkbench : public testing::Test {
protected:
    explicit DrawnWorkbench(WorkbenchOptions options = {}) : workbench(std::move(options)) {}

    static Opened smallData(double size = 24) {
        OpenRequest request;
        request.data.emplace();
        request.data->model = "marschner-lobb";
        request.data->settings = {{"nx", size}, {"ny", size}, {"nz", size}};
        return open(request);
    }
    void frame(const std::function<void(ImGuiIO&)>& input = {}) { frames.draw(workbench, 1, input); }
    void settle() { tessera::app::settle(workbench, frames); }
    void press(int key) {
        for (const bool down : {true, false}) frame([&](ImGuiIO& io) { feedKey(io, key, down); });
    }
    /// False where the command is not available.
    bool run(const std::string& name) {
        for (const Command& command : workbench.commands())
            if (command.title() == name && command.available()) {
                command.run();
                return true;
            }
        return false;
    }
    void addBrush(const std::string& name) {
        workbench.session().selection.brushes.push_back({});
        workbench.session().selection.brushes.back().name = name;
    }

    vis::HeadlessContext gl;
    Gui gui;
    Workbench workbench;
    OffscreenFrames frames{{600, 400}};
};

} // namespace tessera::app
