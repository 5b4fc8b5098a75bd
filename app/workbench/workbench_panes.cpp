#include "app/ui/file_dialog.h"
#include "app/ui/ticks.h"
#include "app/workbench/workbench.h"

#include <cmath>
#include <imgui.h>
#include <utility>

/// Panes of views, and the status bar.
namespace tessera::app {

namespace {

/// Whether a pane shows the scene from the session's camera.
bool showsSpace(const Session& session, const std::string& pane) {
    const auto found = session.views.find(pane);
    return found != session.views.end() && traitsOf(found->second).camera;
}

} // namespace

/// The view that the camera's commands are for: the one used last if it is on screen, else the first that is.
std::string Workbench::spacePane() const {
    if (drawnBefore_.contains(lastSpacePane_) && showsSpace(session_, lastSpacePane_)) return lastSpacePane_;
    for (const std::string& pane : drawnBefore_)
        if (showsSpace(session_, pane)) return pane;
    return {};
}

void Workbench::drawPane(const std::string& pane) {
    drawn_.insert(pane);
    const bool focused =
        ImGui::IsWindowFocused(ImGuiFocusedFlags_ChildWindows) && std::exchange(focusedPane_, pane) != pane;
    if (ImGui::IsWindowHovered(ImGuiHoveredFlags_ChildWindows | ImGuiHoveredFlags_AllowWhenBlockedByActiveItem))
        hoveredPane_ = pane;
    if ((focused || hoveredPane_ == pane) && showsSpace(session_, pane)) lastSpacePane_ = pane;
    const auto found = session_.views.find(pane);
    if (found == session_.views.end()) {
        ImGui::TextDisabled("There is no view named %s.", pane.c_str());
        return;
    }
    ViewContext context{.session = session_,
                        .source = source_,
                        .renderer = *renderer_,
                        .jobs = jobs_,
                        .caches = caches_,
                        .numbers = numbers_,
                        .origin = origin_,
                        .iconFont = fonts_.icons,
                        .scale = scale_,
                        .headless = options_.headless,
                        .renderers = renderers_,
                        .history = &history_,
                        .goToStep = [this](std::size_t to) { chosen_ = [this, to] { replace(history_.seek(to)); }; },
                        .log = &messages_,
                        .figure = options_.headless && !options_.onlyPane.empty() && !options_.controls,
                        .runCommand =
                            [this](const std::string& name) {
                                for (const Command& command : commands_)
                                    if (command.title() == name && command.available()) chosen_ = command.run;
                            },
                        .exportText =
                            [this](const std::string& name, std::function<std::string(const Progress&)> make) {
                                exportText_ = std::move(make);
                                const auto dot = name.rfind('.');
                                files_.show(FileMode::Save, "Export", "export", files_.folder(), name,
                                            dot == std::string::npos ? "" : name.substr(dot));
                            },
                        .askFile =
                            [this](const std::string& title, std::function<void(Session&, const std::string&)> take) {
                                takeFile_ = std::move(take);
                                files_.show(FileMode::Open, title, "take", files_.folder());
                            },
                        .cameraKey = cameraPane_ == pane ? std::exchange(cameraKey_, 0) : 0,
                        .busy = false,
                        .interacting = interacting_};
    if (options_.headless) context.offerExport = [&](ViewExport made) { exports_[pane] = std::move(made); };
    ImGui::PushID(pane.c_str());
    // By its index: drawing may take the view out of the session.
    forEachViewKind([&, at = std::size_t(0), index = found->second.index()]<class Kind>(const Kind&) mutable {
        if (at++ == index) Kind::draw(context, pane, std::get<typename Kind::State>(found->second));
    });
    ImGui::PopID();
    for (const std::string& text : context.messages) message(text, true);
    busy_ = busy_ || context.busy;
    compiling_ = compiling_ || context.compiling;
    if (options_.paneDrawn) options_.paneDrawn(pane, context.behind);
}

void Workbench::drawStatusBar(float height) {
    const ImGuiViewport& viewport = *ImGui::GetMainViewport();
    ImGui::SetNextWindowPos({viewport.Pos.x, viewport.Pos.y + viewport.Size.y - height});
    ImGui::SetNextWindowSize({viewport.Size.x, height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding,
                        ImVec2(10 * scale_, std::floor((height - ImGui::GetFontSize()) / 2)));
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
    ImGui::PushStyleColor(ImGuiCol_Text, palette().muted);
    if (source_) {
        const volume::DatasetInfo& info = source_->info();
        const auto latticeText = [](const volume::Lattice& lattice) {
            return std::to_string(lattice.size.x) + " \xc3\x97 " + std::to_string(lattice.size.y) + " \xc3\x97 " +
                   std::to_string(lattice.size.z) + (lattice.kind == volume::LatticeKind::BCC ? " BCC" : " CC");
        };
        const volume::Lattice &lattice = numbers_->grid().lattice, &drawn = source_->grid().lattice;
        std::string text = info.name + "   " + latticeText(lattice);
        if (drawn != lattice) text += ", drawn from " + latticeText(drawn);
        text += "   " + std::to_string(info.parameters.size()) +
                (info.parameters.size() == 1 ? " parameter" : " parameters");
        if (info.times.size() > 1) text += ", " + std::to_string(info.times.size()) + " times";
        if (const vis::ResidencyInfo use = renderer_->residency(); !options_.headless && use.textureBytes > 0) {
            // In the unit in which the limit is set.
            constexpr double kMebibyte = 1 << 20;
            text += "   textures " + formatNumber(double(use.textureBytes) / kMebibyte, 0.1) + " of " +
                    formatNumber(double(use.textureBudget) / kMebibyte, 1) + " MiB, " +
                    formatCount(use.bricksResident) + " bricks";
            if (use.bricksKept > 0) text += ", " + formatCount(use.bricksKept) + " kept from other times";
            if (use.bricksHidden > 0) text += ", " + formatCount(use.bricksHidden) + " hidden";
            if (use.bricksWanted > 0) text += ", " + formatCount(use.bricksWanted) + " to come";
        }
        if (compiling_ && !options_.headless) text += "   compiling shaders";
        ImGui::TextUnformatted(text.c_str());
    } else {
        ImGui::TextUnformatted("No data");
    }
    ImGui::PopStyleColor();
    // Jobs at the right, newest last, each with a button that cancels it.
    float x = viewport.Size.x - 10 * scale_;
    if (!options_.headless) {
        for (const Jobs::Status& job : jobs_.list()) {
            if (job.quiet || job.seconds < 0.15) continue;
            const std::string text = job.title + (job.what.empty() ? "" : ": " + job.what);
            const float bar = 120 * scale_, cross = ImGui::GetFontSize() * 1.4f;
            const float width = ImGui::CalcTextSize(text.c_str()).x + bar + cross + 16 * scale_;
            x -= width;
            if (x < viewport.Size.x * 0.35f) break;
            ImGui::PushID(job.key.c_str());
            ImGui::SameLine(x);
            ImGui::TextUnformatted(text.c_str());
            ImGui::SameLine(0, 8 * scale_);
            const ImVec2 at = ImGui::GetCursorScreenPos();
            const float middle = std::round(at.y + ImGui::GetFontSize() / 2), half = std::round(3 * scale_);
            ImDrawList& list = *ImGui::GetWindowDrawList();
            list.AddRectFilled({at.x, middle - half}, {at.x + bar, middle + half}, palette().grid, half);
            list.AddRectFilled({at.x, middle - half},
                               {at.x + std::max(2 * half, bar * float(job.fraction)), middle + half}, palette().accent,
                               half);
            ImGui::Dummy({bar, ImGui::GetFontSize()});
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("%.0f %%, %.0f s", job.fraction * 100, job.seconds);
            ImGui::SameLine(0, 8 * scale_);
            ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(2 * scale_, 0));
            if (ImGui::SmallButton(fonts_.icons ? icon::kCross : "x")) jobs_.cancel(job.key);
            ImGui::PopStyleVar();
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("Cancel; what is shown stays");
            ImGui::PopID();
        }
    }
    ImGui::End();
}

} // namespace tessera::app
