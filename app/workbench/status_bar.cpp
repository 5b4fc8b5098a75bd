#include "app/workbench/status_bar.h"

#include "app/ui/fitted_text.h"
#include "app/ui/theme.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"

#include <algorithm>
#include <cmath>
#include <imgui.h>

namespace tessera::app {

namespace {

std::string latticeText(const volume::Lattice& lattice) {
    return std::to_string(lattice.size.x) + " \xc3\x97 " + std::to_string(lattice.size.y) + " \xc3\x97 " +
           std::to_string(lattice.size.z) + (lattice.kind == volume::LatticeKind::BCC ? " BCC" : " CC");
}

/// One job: its title, a bar `bar` wide, and a button that cancels it.
void drawJob(Jobs& jobs, const Jobs::Status& job, const std::string& text, float bar, float scale, bool icons) {
    ImGui::TextUnformatted(text.c_str());
    ImGui::SameLine(0, 8 * scale);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float middle = std::round(at.y + ImGui::GetFontSize() / 2), half = std::round(3 * scale);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled({at.x, middle - half}, {at.x + bar, middle + half}, palette().grid, half);
    list.AddRectFilled({at.x, middle - half}, {at.x + std::max(2 * half, bar * float(job.fraction)), middle + half},
                       palette().accent, half);
    ImGui::Dummy({bar, ImGui::GetFontSize()});
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%.0f %%, %.0f s", job.fraction * 100, job.seconds);
    ImGui::SameLine(0, 8 * scale);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(2 * scale, 0));
    if (ImGui::SmallButton(icons ? icon::kCross : "x")) jobs.cancel(job.key);
    ImGui::PopStyleVar();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Cancel; what is shown does not change");
}

/// The newest message, of failures with a coloured ground, and how many others are new.
void drawNews(Messages& messages, float room, float scale, bool icons) {
    const std::vector<Messages::Message*> news = messages.news();
    if (news.empty()) return;
    const bool failure = news.front()->failure;
    const std::string more = news.size() > 1 ? "  +" + std::to_string(news.size() - 1) : "";
    const float em = ImGui::GetFontSize(), cross = em * 1.6f;
    const ImVec2 at = ImGui::GetCursorScreenPos(), window = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    const float begin = failure && icons ? em * 1.5f : 0;
    const float width = std::max(1.0f, room - begin - cross - ImGui::CalcTextSize(more.c_str()).x);
    const std::string shown = fitText(news.front()->text, width) + more;
    const float end = begin + ImGui::CalcTextSize(shown.c_str()).x;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (failure) {
        const ImU32 ground = (palette().failure & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 60);
        list.AddRectFilled({window.x, window.y}, {at.x + end + cross, window.y + size.y}, ground);
        if (icons) list.AddText(at, palette().failure, icon::kWarning);
    }
    list.AddText({at.x + begin, at.y}, palette().text, shown.c_str());
    bool closed = mouseArea("news", {end, em});
    if (ImGui::IsItemHovered()) {
        ImGui::BeginTooltip();
        ImGui::PushTextWrapPos(em * 40);
        for (const Messages::Message* each : news) ImGui::TextUnformatted(each->text.c_str());
        ImGui::PopTextWrapPos();
        ImGui::EndTooltip();
    }
    ImGui::SameLine(0, em * 0.3f);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(2 * scale, 0));
    closed = ImGui::SmallButton(icons ? icon::kCross : "x") || closed;
    ImGui::PopStyleVar();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Close; the message stays in the pane Messages");
    if (closed) news.front()->gone = true;
}

/// The jobs at the right, the newest last, as many as fit. Returns where they begin.
float drawJobs(Jobs& jobs, float scale, bool icons) {
    const float whole = ImGui::GetMainViewport()->Size.x, bar = 120 * scale, cross = ImGui::GetFontSize() * 1.4f;
    float x = whole - 10 * scale, end = x;
    for (const Jobs::Status& job : jobs.list()) {
        if (job.quiet || job.seconds < 0.15) continue;
        const std::string text = job.title + (job.what.empty() ? "" : ": " + job.what);
        const float left = end - (ImGui::CalcTextSize(text.c_str()).x + bar + cross + 16 * scale);
        if (left < whole * 0.35f) break;
        x = left;
        end = left - ImGui::GetFontSize(); // so that the cross belongs to the job before it
        ImGui::PushID(job.key.c_str());
        ImGui::SameLine(x);
        drawJob(jobs, job, text, bar, scale, icons);
        ImGui::PopID();
    }
    return x;
}

} // namespace

std::string dataText(const Sources& sources) {
    if (!sources.pictures) return "No data";
    const volume::DatasetInfo& info = sources.pictures->info();
    const volume::Lattice &lattice = sources.numbers->grid().lattice, &drawn = sources.pictures->grid().lattice;
    std::string text = info.name + "   " + latticeText(lattice);
    if (drawn != lattice) text += ", drawn from " + latticeText(drawn);
    text +=
        "   " + std::to_string(info.parameters.size()) + (info.parameters.size() == 1 ? " parameter" : " parameters");
    if (info.times.size() > 1) text += ", " + std::to_string(info.times.size()) + " times";
    return text;
}

std::string residencyText(const vis::ResidencyInfo& use) {
    if (use.textureBytes <= 0) return {};
    constexpr double kMebibyte = 1 << 20; // the unit in which the limit is set
    std::string text = "   textures " + formatNumber(double(use.textureBytes) / kMebibyte, 0.1) + " of " +
                       formatNumber(double(use.textureBudget) / kMebibyte, 1) + " MiB, " +
                       formatCount(use.bricksResident) + (use.bricksResident == 1 ? " brick" : " bricks");
    if (use.bricksKept > 0) text += ", " + formatCount(use.bricksKept) + " kept from other times";
    if (use.bricksHidden > 0) text += ", " + formatCount(use.bricksHidden) + " hidden";
    if (use.bricksWanted > 0) text += ", " + formatCount(use.bricksWanted) + " loading";
    return text;
}

std::string engineText(const vis::EngineUse& use) {
    if (use.byProcessor) return "   rays by the processor (" + std::string(use.instructions) + ")";
    return use.refusal.empty() ? std::string() : "   rays by OpenGL: the processor cannot draw " + use.refusal;
}

void drawStatusBar(const std::string& text, Jobs* jobs, Messages* messages, float height, float scale, bool icons) {
    const ImGuiViewport& viewport = *ImGui::GetMainViewport();
    ImGui::SetNextWindowPos({viewport.Pos.x, viewport.Pos.y + viewport.Size.y - height});
    ImGui::SetNextWindowSize({viewport.Size.x, height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding,
                        ImVec2(10 * scale, std::floor((height - ImGui::GetFontSize()) / 2)));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
    ImGui::PushStyleColor(ImGuiCol_WindowBg, palette().panel);
    ImGui::Begin("###status", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoScrollWithMouse |
                     ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(4);
    const float left = ImGui::GetCursorPosX(), top = ImGui::GetCursorPosY();
    ImGui::Dummy({0, ImGui::GetFontSize()}); // what jobs stand beside
    const float right = jobs ? drawJobs(*jobs, scale, icons) : viewport.Size.x;
    ImGui::SetCursorPos({left, top});
    const float room = std::max(1.0f, right - left - 12 * scale);
    if (messages && !messages->news().empty()) {
        drawNews(*messages, room, scale, icons);
    } else {
        ImGui::PushStyleColor(ImGuiCol_Text, palette().muted);
        fittedText(text, room);
        ImGui::PopStyleColor();
    }
    ImGui::End();
}

} // namespace tessera::app
