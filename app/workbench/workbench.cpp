#include "app/workbench/workbench.h"

#include "app/workbench/fit_box.h"
#include "app/workbench/status_bar.h"
#include "app/workbench/workbench_commands.h"
#include "codec/remote/address.h"
#include "volume/base/background.h"
#include "volume/base/error.h"
#include "volume/system/free_memory.h"

#include <algorithm>
#include <filesystem>
#include <imgui.h>
#include <utility>

namespace tessera::app {

namespace fs = std::filesystem;

namespace {

/// Options of the workbench's own renderer.
vis::RendererOptions waking(const WorkbenchOptions& options) {
    vis::RendererOptions render = options.render;
    render.arrived = options.wake;
    return render;
}

} // namespace

Workbench::Workbench(WorkbenchOptions options)
    : options_(std::move(options)),
      renderer_(options_.renderer ? options_.renderer
                                  : std::make_shared<vis::Renderer>(vis::quickestOptions(waking(options_)))),
      messages_([this] { return now(); }, options_.headless),
      data_(document_, jobs_, messages_,
            {options_.headless, options_.stateFolder, options_.program, options_.growthInterval},
            [this](std::optional<vis::SameSamples> grown) {
                renderer_->setSource(source(), grown.value_or(vis::SameSamples{}));
                if (!grown) panes_.forget(); // views keep their caches if the data have only grown
            }),
      files_(jobs_) {
    jobs_.wake = options_.wake;
    if (!options_.headless) {
        jobs_.refused = [this](Jobs::Refused job) { machines_.show(std::move(job)); };
        helpInBackground();
        autosaver_ = std::make_unique<Autosaver>(options_.stateFolder, options_.autosaveInterval);
        recovery_.show(autosaver_->abandoned());
        if (const std::string& why = autosaver_->problem(); !why.empty()) message("Autosave is off: " + why, true);
    }
    panes_.paneDrawn = options_.paneDrawn;
    for (const auto make :
         {fileCommands, editCommands, viewCommands, volumeViewCommands, layoutCommands, sceneCommands, helpCommands}) {
        std::vector<Command> commands = make(*this);
        std::ranges::move(commands, std::back_inserter(commands_));
    }
}

Workbench::~Workbench() = default;

double Workbench::now() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

bool Workbench::prepare(float contentScale) {
    const bool rebuilt = look_.prepare(contentScale, session().appearance);
    if (options_.whiteGround) ImGui::GetStyle().Colors[ImGuiCol_WindowBg] = {1, 1, 1, 1};
    return rebuilt;
}

void Workbench::ask(const std::string& text, const std::string& yes, std::function<void()> go) {
    if (options_.headless) return go();
    question_.show(text, yes, std::move(go));
}

void Workbench::requestQuit() {
    leave([this] { quit_ = true; });
}

void Workbench::frame() {
    frameBegan_ = now();
    for (const std::string& text : jobs_.collect()) message(text, true);
    for (const std::string& text : renderer_->takeMessages()) message(text, true);
    if (const auto run = std::exchange(chosen_, nullptr)) run();
    data_.follow(ImGui::IsAnyItemActive(), ImGui::IsMouseDown(ImGuiMouseButton_Left));
    keyboard_.begin();
    const bool givenUp = cancelledDrag_.begin() && document_.loaded();
    givenUp ? document_.giveUpEdit() : pressKeys();
    drawWindow();
    if (givenUp) document_.giveUpEdit(); // views that saw the key have their own ways of taking a drag back
    for (const std::string& text : panes_.takeMessages()) message(text, true);
    busy_ = panes_.busy();
    hurries_ = panes_.hurries();
    if (!options_.headless) {
        if (memory_.due(busy(), now())) volume::giveBackFreeMemory();
        drawDialogs();
        drawPaletteOfAll();
        play();
    }
    const bool editing = ImGui::IsAnyItemActive() || ImGui::IsMouseDown(ImGuiMouseButton_Left) ||
                         ImGui::IsMouseDown(ImGuiMouseButton_Right) || ImGui::IsMouseDown(ImGuiMouseButton_Middle);
    document_.observe(editing, now());
    if (autosaver_) autosaver_->update(document_, now(), jobs_, messages_);
    cancelledDrag_.end();
    keyboard_.end();
}

void Workbench::drawPaletteOfAll() {
    if (!palette_.open && !palette_.shown) return;
    std::vector<Command> all = commands_; // and those that depend on the data
    std::ranges::move(extremesOfParameters(*this), std::back_inserter(all));
    if (const Command* command = drawPalette(palette_, all)) chosen_ = command->run;
}

void Workbench::pressKeys() {
    // Ignore keys also in the frame whose Esc has just closed a menu: it would clear the brushes as well.
    const bool popup = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId);
    if (!options_.headless && !files_.shown() && !popup && !popupShown_) runShortcuts(commands_);
    popupShown_ = popup;
}

ViewContext Workbench::viewContext() {
    return {.session = session(),
            .source = source(),
            .renderer = *renderer_,
            .jobs = jobs_,
            .caches = panes_.caches(),
            .numbers = numbers(),
            .origin = origin(),
            .iconFont = look_.fonts().icons,
            .scale = look_.scale(),
            .headless = options_.headless,
            .figure = options_.headless && !options_.onlyPane.empty() && !options_.controls,
            .decoration = options_.decoration,
            .whiteGround = options_.whiteGround,
            .history = &history(),
            .goToStep = [this](std::size_t to) { chosen_ = [this, to] { document_.goToStep(to); }; },
            .log = &messages_,
            .stateFolder = options_.stateFolder,
            .runCommand =
                [this](const std::string& name) {
                    for (const Command& command : commands_)
                        if (command.title() == name && command.available()) chosen_ = command.run;
                },
            .goTo = [this](const ExtremeQuestion& question) { app::goTo(*this, question); },
            .exportText =
                [this](const std::string& name, std::function<std::string(const Progress&)> make) {
                    const auto dot = name.rfind('.');
                    files_.askSave("Export", name, dot == std::string::npos ? "" : name.substr(dot),
                                   [this, make = std::move(make)](const std::string& path) { exportText(path, make); });
                },
            .exportFigure =
                [this](const std::string& name, std::function<VectorPage(const Progress&)> make) {
                    files_.askSave(
                        "Export", name, fs::path(name).extension().string(),
                        [this, make = std::move(make)](const std::string& path) { exportFigure(path, make); });
                },
            .askFile =
                [this](const std::string& title, std::function<void(Session&, const std::string&)> take) {
                    files_.askOpen(title, [this, take = std::move(take)](const std::vector<std::string>& paths) {
                        try {
                            take(session(), paths.front());
                        } catch (const Error& error) {
                            message(error.what(), true);
                        }
                    });
                },
            .interacting = interacting()};
}

bool Workbench::interacting() {
    constexpr double kRest = 0.4; // s
    if (!typing()) return ImGui::IsAnyItemActive();
    if (otherKeyHeld() || !ImGui::GetIO().InputQueueCharacters.empty()) typed_ = now();
    return now() - typed_ < kRest;
}

std::string Workbench::whyEmpty() const {
    const auto& said = messages_.list(); // the status line forgets it, and no pane has it
    return said.empty() || !said.back().failure ? "" : said.back().text + "\n\n";
}

void Workbench::drawWindow() {
    const ImGuiViewport& viewport = *ImGui::GetMainViewport();
    PaneHost::Area area{viewport.Pos, viewport.Size, options_.onlyPane, {}};
    if (document_.loaded())
        area.none = "No view is open: choose one in the View menu.";
    else if (!jobs_.running("open"))
        area.none = whyEmpty() + "No data: choose File > Open, or drop a file here.";
    if (!options_.onlyPane.empty()) return panes_.draw(viewContext(), area);
    drawMenus();
    const auto [top, bottom] = windowBars();
    area.origin.y += top;
    area.size.y = std::max(1.0f, area.size.y - top - bottom);
    panes_.draw(viewContext(), area);
    std::string text = dataText(document_.sources());
    if (document_.loaded() && !options_.headless) {
        text += residencyText(renderer_->residency()) + engineText(renderer_->engine());
        if (panes_.compiling()) text += "   compiling shaders";
    }
    drawStatusBar(text, options_.headless ? nullptr : &jobs_, options_.headless ? nullptr : &messages_, bottom,
                  look_.scale(), look_.hasIcons());
}

void Workbench::drawMenus() {
    if (!ImGui::BeginMainMenuBar()) return;
    for (const char* menu : {"File", "Edit", "View", "Layout", "Help"}) {
        keyboard_.offerMenu(menu);
        if (!ImGui::BeginMenu(menu)) continue;
        if (const Command* command = drawMenu(commands_, menu)) chosen_ = command->run;
        if (std::string_view(menu) == "File") drawRecentFiles();
        ImGui::EndMenu();
    }
    ImGui::EndMainMenuBar();
}

void Workbench::drawRecentFiles() {
    ImGui::Separator();
    if (!ImGui::BeginMenu("Recent files")) return;
    const auto recent = recentFiles(options_.stateFolder);
    if (recent.empty()) ImGui::TextDisabled("No recent files");
    for (const std::string& path : recent) {
        std::error_code problem;
        if (ImGui::MenuItem(path.c_str(), nullptr, false, codec::isRemote(path) || fs::exists(path, problem)))
            chosen_ = [this, path] {
                OpenRequest request;
                request.paths = {path};
                open(std::move(request));
            };
    }
    ImGui::EndMenu();
}

void Workbench::drawDialogs() {
    files_.draw();
    if (files_.shown()) return;
    const auto ask = [this](std::size_t index, const std::string& title, const std::string& folder) {
        files_.askOpen(
            title, [this, index](const std::vector<std::string>& paths) { missing_.found(index, paths.front()); },
            folder);
    };
    if (std::optional<Opened> found = missing_.draw(ask))
        openWhole(std::make_shared<Opened>(std::move(*found)), "Opening the session");
    if (const auto recovery = recovery_.draw()) recover(*recovery);
    const auto request =
        document_.loaded() ? pictures_.draw(session(), document_.info(), options_.stateFolder) : std::nullopt;
    if (request) {
        const std::string suffix = "." + std::string(kPictureFormatNames[std::size_t(request->format)]);
        files_.askSave("Save picture", (request->pane.empty() ? "tessera" : request->pane) + suffix, suffix,
                       [this, request](const std::string& path) {
                           picture_ = PictureJob{*request, path};
                       });
    }
    const LeaveDialog::Answer answer = leave_.draw(!document_.path().empty());
    if (answer == LeaveDialog::Answer::Save) saveThen(leave_.take());
    if (answer == LeaveDialog::Answer::Discard) leave_.take()();
    if (const auto go = question_.draw()) go();
    if (auto decision = machines_.draw()) decide(std::move(*decision));
    help_.draw(commands_, look_.fonts(), renderer_->residency());
}

void Workbench::play() {
    if (!document_.loaded() || !session().animation.playing) return;
    busy_ = hurries_ = true;
    if (!panes_.plays(session())) document_.play(double(ImGui::GetIO().DeltaTime), panes_.behind());
}

void Workbench::afterFrame() {
    if (!picture_ || !writePicture || !document_.loaded()) return;
    const PictureJob job = *std::exchange(picture_, {});
    try {
        const SessionDocument shown = document_.snapshot();
        writePicture(shown, document_.sources(), renderer_, job.request, job.path);
        message("Saved picture " + fs::path(job.path).filename().string());
    } catch (const Error& error) {
        message(error.what(), true);
    }
}

double Workbench::idleSeconds() const {
    // Jobs and samples wake the platform, programs come without a word. Frames meanwhile would take time from what is
    // waited for, above all where the processor draws them.
    constexpr double kLook = 0.02, kWoken = 0.25;
    constexpr double kRarest = 0.5, kShare = 0.1; // of frames that tell only how far jobs are: seconds, share of time
    if (hurries_ || picture_ || chosen_ || history().pending()) return 0;
    double wait = messages_.secondsToChange();
    if (busy_) wait = std::min(wait, panes_.compiling() || !options_.wake ? kLook : kWoken);
    const double progress = std::clamp((now() - frameBegan_) * (1 / kShare - 1), 0.1, kRarest);
    for (const Jobs::Status& job : jobs_.list()) wait = std::min(wait, job.quiet ? kWoken : progress);
    if (autosaver_) wait = std::min(wait, autosaver_->secondsToNext(document_, now()));
    return wait;
}

} // namespace tessera::app
