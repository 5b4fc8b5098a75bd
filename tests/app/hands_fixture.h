#pragma once

#include "app/platform/gui.h"
#include "app/session/session_json.h"
#include "app/ui/keys.h"
#include "app/workbench/workbench.h"
#include "tests/app/formula_cell.h"
#include "vis/gl/headless.h"
#include "volume/sources/memory_source.h"

#include <cmath>
#include <gtest/gtest.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <optional>
#include <variant>
#include <vector>

namespace tessera::app {

/// One view of the formula cell under a hand: mouse and keys go through ImGui, frames are drawn into memory, edits are
/// recorded. Where something lies is asked of what was drawn, not of the code that takes the mouse.
class Hands : public testing::Test {
protected:
    explicit Hands(WorkbenchOptions options = {.headless = true, .onlyPane = "pane", .controls = true})
        : workbench(std::move(options)) {}
    /// Shows the cell on its own grid in this view alone; `prepare` edits the session before.
    void show(const ViewState& view, glm::ivec2 size, const std::function<void(Session&)>& prepare = {}) {
        Opened opened;
        opened.source = opened.numbers = volume::makeMemorySource(formula::makeCell(), {});
        DataRef data;
        data.model = "fuel-cell"; // has no file
        opened.document.session = defaultSession(opened.source->info(), data);
        Session& session = opened.document.session;
        session.views.clear();
        session.views["pane"] = view;
        session.cursor = {0.0123, 0.0041, -0.0009};
        session.time = 0.5;
        session.render.samples = 1; // soon drawn
        if (prepare) prepare(session);
        repair(session.dock, paneKeys(session));
        opened.document.history.reset(session);
        workbench.install(std::move(opened));
        frames.emplace(size);
        ImGui::GetIO().MouseDoubleClickTime = 0; // clicks on one place are clicks
        settle();
    }

    void frame() {
        frames->draw(workbench, 1, [this](ImGuiIO& io) {
            io.MousePos = mouse;
            for (int i = 0; i < 3; ++i) io.MouseDown[i] = down[i];
            io.MouseWheel = wheel;
            feedModifiers(io, ctrl, shift, alt);
        });
        wheel = 0;
    }
    /// Until every job is done and nothing refines.
    void settle() {
        do {
            workbench.jobs().wait();
            frame();
        } while (workbench.busy());
        frame();
    }
    void moveTo(ImVec2 at) {
        mouse = {std::floor(at.x), std::floor(at.y)}; // ImGui knows whole pixels only
        frame();
    }
    void button(int which, bool on) {
        down[which] = on;
        frame();
    }
    void click(ImVec2 at, int which = 0) {
        moveTo(at);
        button(which, true);
        button(which, false);
        frame();
    }
    /// Presses, goes there by the half way, lets go.
    void drag(ImVec2 from, ImVec2 to, int which = 0) {
        moveTo(from);
        button(which, true);
        moveTo({(from.x + to.x) / 2, (from.y + to.y) / 2});
        moveTo(to);
        button(which, false);
        frame();
    }
    void turnWheel(float by) {
        wheel = by;
        frame();
    }
    void press(int key) {
        for (const bool on : {true, false}) {
            feedKey(ImGui::GetIO(), key, on);
            frame();
        }
    }

    /// The window of the pane, or one within it whose name holds `part`.
    static ImGuiWindow* window(const std::string& part = {}) {
        if (part.empty()) return ImGui::FindWindowByName("###pane.pane");
        for (ImGuiWindow* each : GImGui->Windows)
            if (each->WasActive && std::string_view(each->Name).find("/" + part + "_") != std::string_view::npos)
                return each;
        return nullptr;
    }
    static ImGuiWindow* popup() {
        return GImGui->OpenPopupStack.empty() ? nullptr : GImGui->OpenPopupStack.back().Window;
    }
    /// Where an item lies, by the names and numbers that lead to it in its window, as ImGui hears of it.
    ImRect item(ImGuiWindow* in, const std::vector<std::variant<std::string, int>>& path) {
        if (!in) {
            ADD_FAILURE() << "no window";
            return {};
        }
        ImGuiID id = in->ID;
        for (const auto& part : path)
            id = std::holds_alternative<int>(part) ? ImHashData(&std::get<int>(part), sizeof(int), id)
                                                   : ImHashStr(std::get<std::string>(part).c_str(), 0, id);
        ImGuiContext& g = *GImGui;
        ImGuiWindow* const before = g.NavWindow;
        g.NavWindow = in, g.NavId = id, g.NavIdIsAlive = false;
        frame();
        EXPECT_TRUE(g.NavIdIsAlive) << "no such item";
        g.NavWindow = before, g.NavId = 0;
        ImRect at = in->NavRectRel[0];
        at.Translate(in->DC.CursorStartPos);
        return at;
    }
    /// An item of the pane itself.
    ImRect inPane(std::vector<std::variant<std::string, int>> path) {
        path.insert(path.begin(), "pane");
        return item(window(), path);
    }

    /// Rectangles of the pictures in the last frame, in the order they were drawn.
    static std::vector<ImRect> pictures() {
        std::vector<ImRect> found;
        const ImDrawData& data = *ImGui::GetDrawData();
        for (int l = 0; l < data.CmdListsCount; ++l) {
            const ImDrawList& list = *data.CmdLists[l];
            for (const ImDrawCmd& command : list.CmdBuffer) {
                if (command.TextureId == ImGui::GetIO().Fonts->TexID) continue;
                for (unsigned i = 0; i + 6 <= command.ElemCount; i += 6) {
                    const auto corner = [&](unsigned k) {
                        const auto index = list.IdxBuffer[int(command.IdxOffset + i + k)];
                        return list.VtxBuffer[int(command.VtxOffset + index)].pos;
                    };
                    found.emplace_back(corner(0), corner(2));
                }
            }
        }
        return found;
    }
    /// The box around everything of one colour in the last frame.
    static ImRect inked(ImU32 color) {
        ImRect box(1e9f, 1e9f, -1e9f, -1e9f);
        const ImDrawData& data = *ImGui::GetDrawData();
        for (int l = 0; l < data.CmdListsCount; ++l)
            for (const ImDrawVert& vertex : data.CmdLists[l]->VtxBuffer)
                if (vertex.col == color) box.Add(vertex.pos);
        return box;
    }
    /// The pixel at a share of a rectangle, from its top left.
    static ImVec2 within(const ImRect& rect, double x, double y) {
        return {std::floor(float(rect.Min.x + x * rect.GetWidth())),
                std::floor(float(rect.Min.y + y * rect.GetHeight()))};
    }
    /// What lies at a pixel between two ends.
    static double across(const ImRect& rect, Range range, ImVec2 at) {
        return range.lo + (at.x - rect.Min.x) / rect.GetWidth() * (range.hi - range.lo);
    }
    static double upwards(const ImRect& rect, Range range, ImVec2 at) {
        return range.lo + (rect.Max.y - at.y) / rect.GetHeight() * (range.hi - range.lo);
    }

    Session& session() { return workbench.session(); }
    template <class View> View& view() { return std::get<View>(session().views.at("pane")); }
    std::size_t steps() const { return workbench.history().position(); }
    /// How the session differs from a former one, to be read by whoever mends a test.
    std::string apart(const Session& before) { return Json::diff(toJson(before), toJson(session())).dump(); }
    void undo() {
        for (const Command& command : workbench.commands())
            if (command.name == "Undo" && command.available()) return command.run();
        ADD_FAILURE() << "nothing to undo";
    }
    /// The least and greatest coordinate of the cell along an axis.
    static Range extent(int axis) {
        return {formula::kOrigin[axis], formula::kOrigin[axis] + formula::kSpacing[axis] * (formula::kSize[axis] - 1)};
    }

    vis::HeadlessContext gl;
    Gui gui;
    Workbench workbench;
    std::optional<OffscreenFrames> frames;
    ImVec2 mouse{-1000, -1000};
    bool down[3] = {}, shift = false, ctrl = false, alt = false;
    float wheel = 0;
};

} // namespace tessera::app
