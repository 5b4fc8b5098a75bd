#include "app/ui/messages.h"

#include "app/ui/theme.h"
#include "app/ui/widgets.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <imgui.h>
#include <limits>

namespace tessera::app {

namespace {

std::string localClock() {
    char text[16] = "";
    const std::time_t time = std::time(nullptr);
    std::tm local{};
    if (localtime_r(&time, &local)) std::strftime(text, sizeof text, "%H:%M:%S", &local);
    return text;
}

/// Draws a toast `width` wide with its cross. True if it is to be removed.
bool drawToast(const Messages::Message& message, float width, bool icons) {
    const float em = ImGui::GetFontSize();
    if (message.failure && icons) {
        ImGui::PushStyleColor(ImGuiCol_Text, palette().failure);
        ImGui::TextUnformatted(icon::kWarning);
        ImGui::PopStyleColor();
        ImGui::SameLine();
    }
    const float right = width - ImGui::GetStyle().WindowPadding.x - em * 1.8f; // where the cross begins
    ImGui::PushTextWrapPos(right);
    ImGui::TextUnformatted(wrappedAtSpaces(message.text, right - ImGui::GetCursorPosX()).c_str());
    ImGui::PopTextWrapPos();
    ImGui::SameLine();
    ImGui::PushStyleColor(ImGuiCol_Button, 0);
    const bool closed = ImGui::SmallButton(icons ? icon::kCross : "x");
    ImGui::PopStyleColor();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Close; the message stays in the pane Messages");
    return closed || (ImGui::IsWindowHovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Left));
}

} // namespace

Messages::Messages(std::function<double()> now, bool echo) : now_(std::move(now)), echo_(echo) {}

void Messages::add(const std::string& text, bool failure) {
    messages_.push_back({text, localClock(), failure, now_(), false});
    if (messages_.size() > kKept) messages_.pop_front();
    if (echo_ && failure) std::fprintf(stderr, "tessera: %s\n", text.c_str());
}

std::vector<Messages::Message*> Messages::toasts() {
    std::vector<Message*> shown;
    for (auto each = messages_.rbegin(); each != messages_.rend(); ++each) {
        if (shown.size() == kToasts || now_() - each->born > each->toastSeconds()) each->gone = true;
        if (!each->gone) shown.push_back(&*each);
    }
    return shown;
}

double Messages::secondsToChange() const {
    double wait = std::numeric_limits<double>::infinity();
    for (const Message& each : messages_)
        if (!each.gone) wait = std::min(wait, std::max(0.05, each.born + each.toastSeconds() - now_()));
    return wait;
}

void drawToasts(Messages& messages, float scale, bool icons) {
    const ImGuiViewport& viewport = *ImGui::GetMainViewport();
    const float em = ImGui::GetFontSize(), width = std::min(em * 28, viewport.Size.x * 0.5f);
    float y = viewport.Pos.y + viewport.Size.y - em * 2.4f;
    int number = 0;
    for (Messages::Message* each : messages.toasts()) {
        const std::string id = "###toast" + std::to_string(number++);
        ImGui::SetNextWindowPos({viewport.Pos.x + viewport.Size.x - 12 * scale, y}, ImGuiCond_Always, {1, 1});
        ImGui::SetNextWindowSizeConstraints({em * 12, 0}, {width, viewport.Size.y / 2});
        ImGui::PushStyleColor(ImGuiCol_WindowBg, ImGui::GetStyleColorVec4(ImGuiCol_PopupBg));
        ImGui::PushStyleColor(ImGuiCol_Border, each->failure ? palette().failure : palette().line);
        ImGui::Begin(id.c_str(), nullptr,
                     ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove |
                         ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing |
                         ImGuiWindowFlags_NoNav);
        ImGui::PopStyleColor(2);
        if (drawToast(*each, width, icons)) each->gone = true;
        y -= ImGui::GetWindowSize().y + 6 * scale;
        ImGui::End();
    }
}

} // namespace tessera::app
