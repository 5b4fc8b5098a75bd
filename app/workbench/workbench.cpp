#include "app/workbench/workbench.h"

#include "app/user_files/import_memory.h"
#include "volume/base/background.h"
#include "volume/base/error.h"
#include "volume/import/over_time.h"

#include <algorithm>
#include <filesystem>
#include <imgui.h>
#include <limits>

namespace tessera::app {

namespace fs = std::filesystem;

Workbench::Workbench(WorkbenchOptions options)
    : options_(std::move(options)), messages_([this] { return now(); }, options_.headless) {
    renderer_ = options_.renderer ? options_.renderer : std::make_shared<vis::Renderer>(options_.render);
    if (!options_.headless) {
        helpInBackground();
        autosave_ = std::make_unique<Autosave>(options_.stateFolder);
        recoveries_ = autosave_->abandoned();
    }
    history_.reset(session_);
    saved_ = session_;
    files_.preview = [this](const std::string& path) {
        FilePreview preview = previewOf(path);
        // Other questions are for files that are no data (colours), or whose form a session states.
        preview.failed = preview.failed && files_.purpose() == "open";
        return preview;
    };
    files_.filesChosen = [this](const std::vector<std::string>& paths) { filesChosen(paths); };
    files_.options = [this] { drawImportOptions(); };
    makeCommands();
}

Workbench::~Workbench() = default;

double Workbench::now() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Workbench::open(OpenRequest request) {
    // Nothing is asked, and so perhaps given up, for what cannot be opened anyway.
    for (const std::string& path : request.paths) {
        const bool pattern = path.find_first_of("*?[") != std::string::npos;
        std::error_code unknown;
        if (!options_.headless && !pattern && !fs::exists(path, unknown)) return message(path + ": no such file", true);
    }
    if (source_ && !options_.headless && request.paths.size() == 1 && !request.import &&
        volume::isTimeTable(request.paths.front()))
        return addTable(request.paths.front());
    leave([this, request = std::move(request)] { start(request); });
}

void Workbench::leave(std::function<void()> go) {
    if (dirty() && source_ && !options_.headless)
        leaving_ = std::move(go);
    else
        go();
}

/// Data opened anew are drawn on the lattice chosen last.
OpenRequest Workbench::withChoices(OpenRequest request) const {
    const std::string chosen = rememberedChoice(options_.stateFolder, kLatticeChoice);
    for (const auto lattice : {PictureLattice::Grid, PictureLattice::BodyCentred})
        if (chosen == kPictureLatticeNames[std::size_t(lattice)]) {
            request.lattice = lattice;
            if (request.data && request.paths.empty() && request.data->files.empty()) request.data->lattice = lattice;
        }
    return request;
}

void Workbench::start(const OpenRequest& request) {
    std::string title = "Opening the built-in fuel cell";
    if (!request.paths.empty())
        title = "Opening " + fs::path(request.paths.front()).filename().string();
    else if (request.data && !request.data->model.empty())
        title = "Computing " + request.data->model;
    jobs_.start("open", title, [this, request = withChoices(request)](const Progress& progress) -> Jobs::Finish {
        auto opened = std::make_shared<Opened>(app::open(request, progress));
        return [this, opened, request] {
            if (!opened->missing.empty()) {
                missing_ = std::move(*opened);
                return;
            }
            install(std::move(*opened));
            if (request.import && !options_.headless) rememberStated(*request.import, source_->info().name);
            for (const std::string& path : request.paths) addRecentFile(options_.stateFolder, path);
        };
    });
}

void Workbench::install(Opened opened) {
    const Appearance appearance = session_.appearance;
    const bool first = !source_;
    take(opened.sources());
    session_ = std::move(opened.document.session);
    derivedShown_ = derivedWanted_ = session_.data.derived;
    countedShown_ = countedWanted_ = countedBy(session_.data);
    latticeShown_ = latticeWanted_ = session_.data.lattice;
    labelsShown_ = labelsWanted_ = session_.data.import.labels;
    // A data file says nothing about the looks of the window: they stay. A session does.
    if (!first && opened.document.raw.is_null()) session_.appearance = appearance;
    history_ = std::move(opened.document.history);
    unknown_ = std::move(opened.document.unknown);
    if (history_.steps().empty()) history_.reset(session_);
    sessionPath_ = opened.sessionPath;
    saved_ = session_;
    unsavedEdits_ = false;
    playback_ = {};
    for (const std::string& text : opened.messages) message(text);
    if (autosave_) autosave_->remove();
}

SessionDocument Workbench::document() const {
    SessionDocument document;
    document.session = session_;
    document.history = history_;
    document.unknown = unknown_;
    return document;
}

std::string Workbench::windowTitle() const {
    std::string title = sessionPath_.empty() ? session_.title : fs::path(sessionPath_).filename().string();
    if (!title.empty()) title += dirty() ? " * - " : " - ";
    return title + "Tessera";
}

bool Workbench::dirty() const {
    Session now = session_;
    now.animation.playing = saved_.animation.playing;
    now.dock = saved_.dock; // looking around is nothing to be asked about
    now.camera = saved_.camera;
    now.time = saved_.time;
    return !(now == saved_);
}

void Workbench::message(const std::string& text, bool failure) {
    messages_.add(text, failure);
}

bool Workbench::prepare(float contentScale) {
    bool rebuilt = false;
    contentScale_ = contentScale;
    const float scale = std::clamp(contentScale * session_.appearance.scale, 0.4f, 6.0f);
    if (scale != scale_) {
        scale_ = scale;
        fonts_ = loadFonts(scale);
        styled_ = false;
        rebuilt = true;
    }
    if (!styled_ || theme_ != session_.appearance.theme) {
        theme_ = session_.appearance.theme;
        applyTheme(theme_, scale_);
        styled_ = true;
    }
    return rebuilt;
}

void Workbench::frame() {
    for (const std::string& text : jobs_.collect()) message(text, true);
    for (const std::string& text : renderer_->takeMessages()) message(text, true);
    if (chosen_) {
        const std::function<void()> run = std::move(chosen_);
        chosen_ = nullptr;
        run();
    }
    followLattice();
    followLabels();
    followDerived();
    followAxis();
    followGrowth();
    std::erase_if(caches_, [&](const auto& entry) { return !session_.views.contains(entry.first); });
    renderers_ = 1;
    for (const auto& [pane, cache] : caches_) renderers_ += cache->renderers();
    // Also not in the frame whose Esc has just closed a menu: it would clear the brushes as well.
    const bool popup = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId);
    if (!options_.headless && !files_.shown() && !popup && !popupShown_) runShortcuts(commands_);
    popupShown_ = popup;

    busy_ = compiling_ = false;
    drawnBefore_ = std::exchange(drawn_, {});
    hoveredPane_.clear();
    interacting_ = ImGui::IsAnyItemActive();
    const ImGuiViewport& viewport = *ImGui::GetMainViewport();
    DockPanes panes;
    panes.title = [this](const std::string& pane) { return paneTitle(session_, pane); };
    panes.draw = [this](const std::string& pane) { drawPane(pane); };
    panes.padded = [this](const std::string& pane) {
        const auto found = session_.views.find(pane);
        return found == session_.views.end() || traitsOf(found->second).padded;
    };
    panes.close = [this](const std::string& pane) { closePane(pane); };
    if (source_)
        panes.none = "No view is open: choose one in the View menu.";
    else if (!jobs_.running("open"))
        panes.none = "No data: choose File > Open, or drop a file here.";
    if (options_.onlyPane.empty()) {
        drawMenus();
        const float top = ImGui::GetFrameHeight(), bottom = std::round(ImGui::GetFontSize() * 1.7f);
        drawDock(session_.dock, hand_, panes, {viewport.Pos.x, viewport.Pos.y + top},
                 {viewport.Size.x, std::max(1.0f, viewport.Size.y - top - bottom)}, scale_);
        drawStatusBar(bottom);
    } else {
        DockTree alone;
        alone.maximised = options_.onlyPane;
        drawDock(alone, hand_, panes, viewport.Pos, viewport.Size, scale_, true);
    }
    if (!options_.headless) {
        drawDialogs();
        if (const Command* command = drawPalette(palette_, commands_)) chosen_ = command->run;
        drawToasts(messages_, scale_, fonts_.icons != nullptr);
        play();
    }
    watchEdits();
    autosave();
    lastFrame_ = now();
}

void Workbench::watchEdits() {
    const bool editing = ImGui::IsAnyItemActive() || ImGui::IsMouseDown(ImGuiMouseButton_Left) ||
                         ImGui::IsMouseDown(ImGuiMouseButton_Right) || ImGui::IsMouseDown(ImGuiMouseButton_Middle);
    if (!source_) return;
    if (history_.observe(session_, editing, now())) unsavedEdits_ = true;
}

double Workbench::nextAutosave() const {
    return lastAutosave_ + std::chrono::duration<double>(options_.autosaveInterval).count();
}

void Workbench::autosave() {
    if (!autosave_ || !unsavedEdits_ || now() < nextAutosave()) return;
    lastAutosave_ = now();
    unsavedEdits_ = false;
    if (session_ == saved_) return;
    const SessionDocument snapshot = document();
    const std::string folder = options_.stateFolder;
    jobs_.start(
        "autosave", "Autosave",
        [this, snapshot, folder](const Progress&) -> Jobs::Finish {
            const std::string failure = autosave_->save(printSession(snapshot, folder + "/autosave"));
            if (failure.empty()) return {};
            return [this, failure] { message("Autosave: " + failure, true); };
        },
        true);
}

void Workbench::play() {
    if (!source_ || !session_.animation.playing) return;
    busy_ = true;
    // A timeline on screen plays by itself.
    for (const auto& [pane, view] : session_.views)
        if (drawn_.contains(pane) && traitsOf(view).plays) return;
    playOn(playback_, session_, source_->info().times, double(ImGui::GetIO().DeltaTime));
}

void Workbench::step(int count) {
    if (!source_) return;
    const std::vector<double>& times = source_->info().times;
    const int last = static_cast<int>(times.size()) - 1;
    const int at = std::clamp(source_->info().nearestTime(session_.time) + count, 0, last);
    session_.animation.playing = false;
    session_.time = times[static_cast<std::size_t>(at)];
}

void Workbench::replace(Session session) {
    if (session.animation.playing) session.animation.playing = false;
    session_ = std::move(session);
    repair(session_.dock, paneKeys(session_));
    unsavedEdits_ = true;
}

void Workbench::closePane(const std::string& pane) {
    removePane(session_.dock, pane);
    session_.views.erase(pane);
}

std::string Workbench::currentPane() const {
    if (!session_.dock.maximised.empty()) return session_.dock.maximised;
    if (session_.views.contains(hoveredPane_)) return hoveredPane_;
    return session_.views.contains(focusedPane_) ? focusedPane_ : std::string();
}

void Workbench::save(const std::string& path) {
    try {
        SessionDocument saved = document();
        saveSession(saved, path);
        sessionPath_ = fs::absolute(path).lexically_normal().string();
        saved_ = session_;
        unsavedEdits_ = false;
        if (autosave_) autosave_->remove();
        addRecentFile(options_.stateFolder, path);
        message("Saved " + fs::path(path).filename().string());
        if (const auto go = std::exchange(afterSave_, nullptr)) go();
    } catch (const Error& error) {
        message(error.what(), true);
    }
    afterSave_ = nullptr;
}

void Workbench::answerFile(const FileDialog::Answer& answer) {
    if (answer.purpose == "open") {
        OpenRequest request;
        request.paths = answer.paths;
        request.import = import_;
        open(std::move(request));
    } else if (answer.purpose == "save") {
        save(answer.paths.front());
    } else if (answer.purpose == "pack") {
        pack(answer.paths.front());
    } else if (answer.purpose == "compare") {
        compareWith(answer.paths);
    } else if (answer.purpose == "surface") {
        exportSurface(answer.paths.front());
    } else if (answer.purpose == "locate" && missing_) {
        const MissingData& found = missing_->missing[locating_];
        locate(missing_->document.session.data, found, answer.paths.front());
        missing_->missing.erase(missing_->missing.begin() + static_cast<std::ptrdiff_t>(locating_));
    } else if (answer.purpose == "export" && exportText_) {
        const std::string path = answer.paths.front(), name = fs::path(path).filename().string();
        jobs_.start(
            "export " + path, "Exporting " + name,
            [this, path, name, make = std::exchange(exportText_, {})](const Progress& progress) -> Jobs::Finish {
                const std::string text = make(progress);
                progress.advance(1);
                writeTextAtomically(path, text);
                return [this, name] { message("Exported " + name); };
            });
    } else if (answer.purpose == "take" && takeFile_) {
        try {
            std::exchange(takeFile_, {})(session_, answer.paths.front());
        } catch (const Error& error) {
            message(error.what(), true);
        }
    } else if (answer.purpose == "picture") {
        export_ = Export{picture_, answer.paths.front()};
    }
}

void Workbench::requestQuit() {
    leave([this] { quit_ = true; });
}

void Workbench::afterFrame() {
    if (!export_ || !takePicture || !source_) return;
    const Export job = *std::exchange(export_, {});
    try {
        const vis::Image image = takePicture(document(), sources(), renderer_, job.request);
        vis::writePng(job.path, image, {{vis::kSessionTextKey, printSession(document(), job.path)}});
        message("Saved picture " + fs::path(job.path).filename().string());
    } catch (const Error& error) {
        message(error.what(), true);
    }
}

double Workbench::idleSeconds() const {
    if (busy_ || export_ || chosen_ || history_.pending()) return 0;
    double wait = std::numeric_limits<double>::infinity();
    for (const Jobs::Status& job : jobs_.list()) wait = std::min(wait, job.quiet ? 0.25 : 0.1);
    wait = std::min(wait, messages_.secondsToChange());
    if (unsavedEdits_) wait = std::min(wait, std::max(0.1, nextAutosave() - now()));
    return wait;
}

} // namespace tessera::app
