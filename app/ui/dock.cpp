#include "app/ui/dock.h"

#include "app/ui/fitted_text.h"
#include "app/ui/keys.h"
#include "app/ui/theme.h"
#include "app/ui/widgets.h"

#include <algorithm>
#include <cmath>
#include <imgui_internal.h> // BringWindowToDisplayBack: the host lies behind every pane, also later ones

namespace tessera::app {

namespace {

constexpr float kDragDistance = 6; // design pixels until a press on a tab is a drag

constexpr ImGuiWindowFlags kPaneFlags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove |
                                        ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                                        ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;

struct TabEvent {
    enum Kind { None, Front, Close, Float, Dock, Maximise } kind = None;
    std::string pane;
};

class Drawing {
public:
    Drawing(DockTree& tree_, DockController& hand_, const DockPanes& panes_, float scale_)
        : tree(tree_), hand(hand_), panes(panes_), scale(scale_), strip(std::round(ImGui::GetFontSize() * 1.75f)) {}

    DockTree& tree;
    DockController& hand;
    const DockPanes& panes;
    float scale, strip;
    TabEvent event;

    /// One tab; returns its right edge.
    float tab(const std::string& pane, ImVec2 at, bool front, bool focused, float room) {
        ImDrawList& list = *ImGui::GetWindowDrawList();
        const std::string title = panes.title(pane);
        const float pad = std::round(10 * scale), cross = std::round(ImGui::GetFontSize() * 1.1f);
        const float width = std::min(room, std::round(ImGui::CalcTextSize(title.c_str()).x + 2 * pad + cross));
        if (width < 8 * scale) return at.x;
        ImGui::PushID(pane.c_str());
        ImGui::SetCursorScreenPos(at);

        mouseArea("tab", {width, strip});
        const bool hovered = ImGui::IsItemHovered(), active = ImGui::IsItemActive();
        if (ImGui::IsItemActivated()) {
            event = {TabEvent::Front, pane};
            hand.dragged = pane;
            hand.moving = false;
            hand.grabbed = ImGui::GetIO().MousePos;
        }
        if (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) event = {TabEvent::Maximise, pane};
        if (hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Middle)) event = {TabEvent::Close, pane};
        if (ImGui::BeginPopupContextItem("tab menu")) {
            menu(pane);
            ImGui::EndPopup();
        }
        const ImVec2 hi{at.x + width, at.y + strip};
        const ImGuiStyle& style = ImGui::GetStyle();
        if (front)
            list.AddRectFilled(at, hi, ImGui::GetColorU32(ImGuiCol_WindowBg), style.TabRounding,
                               ImDrawFlags_RoundCornersTop);
        else if (hovered)
            list.AddRectFilled(at, hi, ImGui::GetColorU32(ImGuiCol_TabHovered, 0.6f), style.TabRounding,
                               ImDrawFlags_RoundCornersTop);
        if (front)
            list.AddRectFilled({at.x + style.TabRounding, at.y},
                               {hi.x - style.TabRounding, at.y + std::round(2 * scale)},
                               focused ? palette().accent : palette().line);
        list.PushClipRect(at, {hi.x - cross * 0.6f, hi.y}, true);
        const std::string shown = fitText(title, width - pad - cross * 0.6f);
        list.AddText({at.x + pad, at.y + std::round((strip - ImGui::GetFontSize()) / 2)},
                     front ? palette().text : palette().muted, shown.c_str());
        list.PopClipRect();
        if (hovered && shown != title) ImGui::SetTooltip("%s", title.c_str());
        if (hovered || active || front) closeCross(pane, {hi.x - cross - pad * 0.3f, at.y}, cross, hovered);
        ImGui::PopID();
        return hi.x;
    }

    void closeCross(const std::string& pane, ImVec2 at, float size, bool tabHovered) {
        const ImVec2 mouse = ImGui::GetIO().MousePos;
        const bool over = tabHovered && mouse.x >= at.x && mouse.x < at.x + size;
        if (!tabHovered) return;
        const ImVec2 center{at.x + size / 2, at.y + strip / 2};
        if (over) ImGui::GetWindowDrawList()->AddCircleFilled(center, size * 0.5f, palette().grid);
        const float r = std::round(size * 0.22f);
        for (const float sign : {-1.0f, 1.0f})
            ImGui::GetWindowDrawList()->AddLine({center.x - r, center.y - sign * r},
                                                {center.x + r, center.y + sign * r},
                                                over ? palette().text : palette().muted, std::max(1.0f, 1.3f * scale));
        if (over && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
            event = {TabEvent::Close, pane};
            hand.dragged.clear();
        }
    }

    void menu(const std::string& pane) {
        const bool floating = std::any_of(tree.floating.begin(), tree.floating.end(),
                                          [&](const FloatingPane& each) { return each.pane == pane; });
        if (ImGui::MenuItem(tree.maximised == pane ? "Restore" : "Maximise", "F11")) event = {TabEvent::Maximise, pane};
        if (ImGui::MenuItem(floating ? "Dock" : "Float")) event = {floating ? TabEvent::Dock : TabEvent::Float, pane};
        if (panes.tabMenu) panes.tabMenu(pane);
        ImGui::Separator();
        if (ImGui::MenuItem("Close")) event = {TabEvent::Close, pane};
    }

    /// The window of a pane itself.
    void window(const std::string& pane, ImVec2 lo, ImVec2 hi, ImGuiWindowFlags flags) {
        ImGui::SetNextWindowPos(lo);
        ImGui::SetNextWindowSize({std::max(hi.x - lo.x, 1.0f), std::max(hi.y - lo.y, 1.0f)});
        ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
        ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
        ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
        const bool padded = !panes.padded || panes.padded(pane);
        if (!padded) ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
        const std::string name = panes.title(pane) + "###pane." + pane;
        const bool visible = ImGui::Begin(name.c_str(), nullptr, flags);
        ImGui::PopStyleVar(padded ? 3 : 4);
        if (visible) panes.draw(pane);
        ImGui::End();
    }

    bool focused(const std::string& pane) const {
        const ImGuiWindow* window = ImGui::FindWindowByName(("###pane." + pane).c_str());
        return window && GImGui->NavWindow && GImGui->NavWindow->RootWindow == window;
    }
};

/// Applies a tab's request, after everything is drawn.
void apply(DockTree& tree, const TabEvent& event, const DockLayout& layout, const DockRect& whole,
           const DockPanes& panes, DockController& hand) {
    switch (event.kind) {
    case TabEvent::None:
        break;
    case TabEvent::Front:
        for (DockNode* stack : layout.stacks)
            for (std::size_t i = 0; i < stack->tabs.size(); ++i)
                if (stack->tabs[i] == event.pane) stack->active = static_cast<int>(i);
        break;
    case TabEvent::Close:
        hand.dragged.clear();
        panes.close(event.pane);
        break;
    case TabEvent::Float: {
        FloatingPane place;
        for (const DockNode* stack : layout.stacks) {
            if (std::find(stack->tabs.begin(), stack->tabs.end(), event.pane) == stack->tabs.end()) continue;
            const DockRect& rect = layout.rects.at(stack->id);
            const float w = whole.hi.x - whole.lo.x, h = whole.hi.y - whole.lo.y;
            place.width = std::clamp((rect.hi.x - rect.lo.x) / w * 0.9f, 0.2f, 0.9f);
            place.height = std::clamp((rect.hi.y - rect.lo.y) / h * 0.9f, 0.2f, 0.9f);
            place.x = std::clamp((rect.lo.x - whole.lo.x) / w + 0.03f, 0.0f, 1 - place.width);
            place.y = std::clamp((rect.lo.y - whole.lo.y) / h + 0.03f, 0.0f, 1 - place.height);
        }
        floatPane(tree, event.pane, place);
        break;
    }
    case TabEvent::Dock:
        insertPane(tree, event.pane, -1, DockSide::Center);
        break;
    case TabEvent::Maximise:
        hand.dragged.clear();
        tree.maximised = tree.maximised == event.pane ? std::string() : event.pane;
        break;
    }
}

void drawSplitters(DockLayout& layout, DockTree& tree, DockController& hand, const DockRect& whole) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    bool moved = false;
    for (const DockSplitter& splitter : layout.splitters) {
        const bool row = splitter.node->kind == DockKind::Row;
        ImGui::PushID(splitter.node->id);
        ImGui::SetCursorScreenPos(splitter.strip.lo);
        mouseArea("splitter", {splitter.strip.hi.x - splitter.strip.lo.x, splitter.strip.hi.y - splitter.strip.lo.y});
        const float at = row ? mouse.x : mouse.y;
        const float begin = row ? splitter.whole.lo.x : splitter.whole.lo.y;
        const float edge = row ? splitter.strip.lo.x : splitter.strip.lo.y;
        const float room = splitter.whole.length(row) - splitter.strip.length(row);
        if (ImGui::IsItemActivated()) {
            hand.splitter = splitter.node->id;
            hand.grabOffset = at - edge;
        }
        if (ImGui::IsItemHovered() || ImGui::IsItemActive())
            ImGui::SetMouseCursor(row ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
        if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
            splitter.node->ratio = 0.5f;
            moved = true;
        } else if (ImGui::IsItemActive() && hand.splitter == splitter.node->id && room > 0 &&
                   ImGui::IsMouseDragging(ImGuiMouseButton_Left, 1)) {
            // Store the effective ratio: one beyond the limit would keep a pane at its smallest size even when the
            // window grows.
            splitter.node->ratio = std::clamp((at - hand.grabOffset - begin) / room, 0.02f, 0.98f);
            splitter.node->ratio = layout.firstPart(*splitter.node, room) / room;
            moved = true;
        }
        if (ImGui::IsItemActive() || ImGui::IsItemHovered()) {
            ImGui::GetWindowDrawList()->AddRectFilled(splitter.strip.lo, splitter.strip.hi,
                                                      ImGui::IsItemActive() ? palette().accent : palette().accentSoft);
        }
        ImGui::PopID();
    }
    if (moved) layout = layoutDock(tree, whole, layout.scale, layout.hidden, layout.least);
}

void drawFloating(Drawing& drawing, const DockRect& whole) {
    const float w = whole.hi.x - whole.lo.x, h = whole.hi.y - whole.lo.y;
    for (FloatingPane& floating : drawing.tree.floating) {
        const std::string pane = floating.pane;
        const std::string name = drawing.panes.title(pane) + "###pane." + pane;
        const ImGuiWindow* held = GImGui->MovingWindow ? GImGui->MovingWindow->RootWindow : nullptr;
        if (!held || held != ImGui::FindWindowByName(name.c_str())) // what the mouse moves has its place already
            ImGui::SetNextWindowPos({std::round(whole.lo.x + floating.x * w), std::round(whole.lo.y + floating.y * h)});
        ImGui::SetNextWindowSize({std::round(floating.width * w), std::round(floating.height * h)});
        const bool padded = !drawing.panes.padded || drawing.panes.padded(pane);
        bool open = true;
        ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(160 * drawing.scale, 110 * drawing.scale));
        if (!padded) ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
        const bool visible =
            ImGui::Begin(name.c_str(), &open, ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
        ImGui::PopStyleVar(padded ? 1 : 2);
        const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
        if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
            // The user moves or resizes it: store its place as shares of the window.
            const FloatingPane placed{pane, (at.x - whole.lo.x) / w, (at.y - whole.lo.y) / h, size.x / w, size.y / h};
            const bool moved = std::abs(placed.x - floating.x) * w > 0.6f ||
                               std::abs(placed.y - floating.y) * h > 0.6f ||
                               std::abs(placed.width - floating.width) * w > 0.6f ||
                               std::abs(placed.height - floating.height) * h > 0.6f;
            if (moved) floating = placed;
        }
        const ImGuiWindow* window = ImGui::GetCurrentWindow();
        const ImRect title = window->TitleBarRect();
        const bool overTitle =
            ImGui::IsMouseHoveringRect(title.Min, title.Max, false) && GImGui->HoveredWindow == window;
        if (overTitle && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) ImGui::OpenPopup("pane menu");
        if (overTitle && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) drawing.event = {TabEvent::Dock, pane};
        if (ImGui::BeginPopup("pane menu")) {
            drawing.menu(pane);
            ImGui::EndPopup();
        }
        if (visible) drawing.panes.draw(pane);
        ImGui::End();
        if (!open) drawing.event = {TabEvent::Close, pane};
    }
}

/// Begins the window behind all panes, which holds the tabs.
void beginDockWindow(const DockRect& whole) {
    ImGui::SetNextWindowPos(whole.lo);
    ImGui::SetNextWindowSize({whole.hi.x - whole.lo.x, whole.hi.y - whole.lo.y});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
    ImGui::PushStyleColor(ImGuiCol_WindowBg, palette().panel);
    ImGui::Begin("###dock", nullptr,
                 kPaneFlags | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse |
                     ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing);
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(3);
    ImGui::BringWindowToDisplayBack(ImGui::GetCurrentWindow());
}

/// Moves the tab that the mouse drags, if any, and shows where it would go; nullopt: nowhere.
std::optional<DockDrop> dragTab(Drawing& drawing, const DockLayout& layout, const DockRect& whole) {
    DockController& hand = drawing.hand;
    const float scale = drawing.scale;
    if (hand.dragged.empty()) return std::nullopt;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const float distance = std::hypot(mouse.x - hand.grabbed.x, mouse.y - hand.grabbed.y);
    if (distance > kDragDistance * scale) hand.moving = true;
    if (pressed({.key = key::kEscape})) hand.dragged.clear();
    if (!hand.moving || hand.dragged.empty()) return std::nullopt;
    const std::optional<DockDrop> drop = dropAt(layout, drawing.tree.root, whole, mouse, drawing.strip);
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    if (drop) {
        list.AddRectFilled(drop->preview.lo, drop->preview.hi, palette().accentSoft, 4 * scale);
        list.AddRect(drop->preview.lo, drop->preview.hi, palette().accent, 4 * scale, 0, 1.5f * scale);
    }
    const std::string title = drawing.panes.title(hand.dragged);
    const ImVec2 text = ImGui::CalcTextSize(title.c_str());
    const ImVec2 at{mouse.x + 12 * scale, mouse.y + 12 * scale};
    list.AddRectFilled({at.x - 6 * scale, at.y - 3 * scale}, {at.x + text.x + 6 * scale, at.y + text.y + 3 * scale},
                       ImGui::GetColorU32(ImGuiCol_PopupBg), 4 * scale);
    list.AddText(at, palette().text, title.c_str());
    return drop;
}

} // namespace

void drawDock(DockTree& tree, DockController& hand, const DockPanes& panes, ImVec2 origin, ImVec2 size, float scale,
              bool bare) {
    const DockRect whole{origin, {origin.x + size.x, origin.y + size.y}};
    Drawing drawing(tree, hand, panes, scale);
    if (bare) {
        if (!tree.maximised.empty())
            drawing.window(tree.maximised, whole.lo, whole.hi, kPaneFlags | ImGuiWindowFlags_NoScrollbar);
        return;
    }
    DockLayout layout = layoutDock(tree, whole, scale, panes.hidden, panes.least);

    beginDockWindow(whole);
    const bool maximised = !tree.maximised.empty();
    struct Pane {
        std::string key;
        ImVec2 lo, hi;
    };
    std::vector<Pane> shown;
    if (maximised) {
        drawing.tab(tree.maximised, whole.lo, true, true, size.x);
        shown.push_back({tree.maximised, {whole.lo.x, whole.lo.y + drawing.strip}, whole.hi});
    } else {
        drawSplitters(layout, tree, hand, whole);
        for (const DockNode* stack : layout.stacks) {
            const DockRect& rect = layout.rects.at(stack->id);
            float x = rect.lo.x;
            const ShownTabs own = shownTabs(*stack, panes.hidden);
            for (std::size_t i = 0; i < own.panes.size(); ++i) {
                const bool front = i == own.front;
                const float left = rect.hi.x - x, tabs = static_cast<float>(own.panes.size() - i);
                const float share = std::max(left / tabs, left - (tabs - 1) * 60 * scale);
                x = drawing.tab(own.panes[i], {x, rect.lo.y}, front, drawing.focused(own.panes[i]), share);
                if (front) shown.push_back({own.panes[i], {rect.lo.x, rect.lo.y + drawing.strip}, rect.hi});
            }
            if (stack->tabs.empty())
                ImGui::GetWindowDrawList()->AddText(ImGui::GetFont(), ImGui::GetFontSize(),
                                                    {rect.lo.x + 20 * scale, rect.lo.y + 20 * scale}, palette().muted,
                                                    panes.none.c_str(), nullptr, rect.hi.x - rect.lo.x - 40 * scale);
        }
    }
    ImGui::End();
    for (const Pane& pane : shown) drawing.window(pane.key, pane.lo, pane.hi, kPaneFlags);
    if (!maximised) drawFloating(drawing, whole);

    const std::optional<DockDrop> drop = maximised ? std::nullopt : dragTab(drawing, layout, whole);
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
        if (!hand.dragged.empty() && hand.moving && drop) {
            drawing.event = {};
            insertPane(tree, hand.dragged, drop->node, drop->side);
            hand.focus = hand.dragged;
        } else if (!hand.dragged.empty()) {
            hand.focus = hand.dragged; // focus on release: on press it would end the drag
        }
        hand.dragged.clear();
        hand.moving = false;
        hand.splitter = 0;
    }
    if (drawing.event.kind != TabEvent::None) apply(tree, drawing.event, layout, whole, panes, hand);
    if (!hand.focus.empty()) {
        ImGui::SetWindowFocus(("###pane." + hand.focus).c_str());
        hand.focus.clear();
    }
}

} // namespace tessera::app
