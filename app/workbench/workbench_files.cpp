#include "app/drawing/drawing.h"
#include "app/user_files/import_memory.h"
#include "app/user_files/machines.h"
#include "app/workbench/fit_box.h"
#include "app/workbench/workbench.h"
#include "codec/remote/consent.h"
#include "volume/base/error.h"
#include "volume/import/over_time.h"
#include "volume/system/atomic_file.h"

#include <filesystem>
#include <utility>

/// How the workbench opens, saves and exports files.
namespace tessera::app {

namespace fs = std::filesystem;

void Workbench::open(OpenRequest request) {
    // Refuse what cannot be opened before asking whether to discard the session.
    for (const std::string& path : request.paths) {
        const bool pattern = path.find_first_of("*?[") != std::string::npos;
        std::error_code unknown;
        if (!options_.headless && !pattern && !codec::isRemote(path) && !fs::exists(path, unknown) &&
            (request.paths.size() > 1 || !namesModel(path)))
            return message(path + ": no such file", true);
    }
    const bool plain = !request.import || *request.import == volume::ImportOptions{};
    if (document_.loaded() && !options_.headless && request.paths.size() == 1 && plain &&
        volume::isTimeTable(request.paths.front()))
        return data_.addTable(request.paths.front()); // to the data shown, which it is about
    leave([this, request = std::move(request)] { start(request); });
}

void Workbench::leave(std::function<void()> go) {
    if (document_.loaded() && !options_.headless && document_.dirty())
        leave_.show(std::move(go));
    else
        go();
}

void Workbench::decide(MachineDialog::Decision decision) {
    for (const Jobs::Refused& job : decision.jobs) {
        if (decision.answer == MachineDialog::Answer::No) {
            message(job.title + ": " + job.machine + " is not asked for the data", true);
            continue;
        }
        codec::allowMachine(job.machine);
        if (decision.answer == MachineDialog::Answer::Always) rememberMachine(options_.stateFolder, job.machine);
        job.again();
    }
}

void Workbench::start(const OpenRequest& request) {
    allowNamed(request.paths, options_.stateFolder);
    std::string title = "Opening the built-in fuel cell";
    if (!request.paths.empty())
        title = "Opening " + fs::path(request.paths.front()).filename().string();
    else if (request.data && !request.data->model.empty())
        title = "Computing " + request.data->model;
    jobs_.start("open", title, [this, request = data_.withChoices(request)](const Progress& progress) -> Jobs::Finish {
        auto opened = std::make_shared<Opened>(app::open(request, progress));
        return [this, opened, request] {
            if (!opened->missing.empty()) return missing_.show(std::move(*opened));
            install(std::move(*opened));
            if (request.import && !options_.headless) rememberStated(*request.import, document_.info().name);
            for (const std::string& path : request.paths)
                if (!namesModel(path)) addRecentFile(options_.stateFolder, path);
        };
    });
}

void Workbench::openText(const std::string& text) {
    auto opened = std::make_shared<Opened>();
    opened->document = parseSession(text, "clipboard");
    opened->folder = fs::current_path().string();
    leave([this, opened] { openWhole(opened, "Opening the pasted session"); });
}

void Workbench::openWhole(const std::shared_ptr<Opened>& opened, const std::string& title) {
    jobs_.start("open", title, [this, opened](const Progress& progress) -> Jobs::Finish {
        const ResolvedData found = resolveData(opened->document.session.data, opened->folder);
        auto done = std::make_shared<Opened>(*opened);
        done->missing = found.missing;
        if (done->missing.empty()) *done = openWith(std::move(*done), found.data, progress);
        done->warnings = found.warnings;
        return [this, done] {
            if (!done->missing.empty()) return missing_.show(std::move(*done));
            install(std::move(*done));
        };
    });
}

void Workbench::recover(const Recovery& recovery) {
    jobs_.start("open", "Recovering", [this, recovery](const Progress& progress) -> Jobs::Finish {
        auto opened = std::make_shared<Opened>(app::open(recoveryRequest(recovery.path), progress));
        return [this, opened, recovery] {
            opened->sessionPath.clear(); // the autosave is not a file to save to
            // Keep the autosave until its data are found.
            if (!opened->missing.empty()) return missing_.show(std::move(*opened));
            install(std::move(*opened));
            document_.setUnsaved();
            autosaver_->hurry();
            Autosave::discard(recovery);
        };
    });
}

void Workbench::install(Opened opened) {
    if (opened.firstView && opened.source && !options_.headless) {
        Session& session = opened.document.session;
        showWholeBox(session, opened.source->info(), look_.scale(), look_.scaleWith(session.appearance));
        opened.document.history.reset(session);
    }
    std::vector<std::string> said = std::move(opened.messages);
    const std::vector<std::string> warned = std::move(opened.warnings);
    if (opened.firstView && opened.source) // later they stand in the view Data
        for (const std::string& note : opened.source->info().notes) said.push_back(note);
    document_.install(std::move(opened));
    data_.reset();
    if (const auto& files = session().data.files; !files.empty() && !codec::isRemote(files.front().absolutePath))
        files_.startIn(fs::absolute(files.front().absolutePath).parent_path().string());
    messages_.setAside();
    for (const std::string& text : said) message(text);
    for (const std::string& text : warned) message(text, true);
    if (autosaver_) autosaver_->clear(document_);
}

void Workbench::saveThen(std::function<void()> then) {
    const auto save = [this, then = std::move(then)](const std::string& path) {
        if (saveTo(path) && then) then();
    };
    if (document_.path().empty())
        files_.askSave("Save session", "session.tessera.json", ".tessera.json", save);
    else
        save(document_.path());
}

void Workbench::saveAs() {
    files_.askSave("Save session", "session.tessera.json", ".tessera.json",
                   [this](const std::string& path) { saveTo(path); });
}

bool Workbench::saveTo(const std::string& path) {
    try {
        document_.save(path);
    } catch (const Error& error) {
        message(error.what(), true);
        return false;
    }
    if (autosaver_) autosaver_->clear(document_);
    addRecentFile(options_.stateFolder, path);
    message("Saved " + fs::path(path).filename().string());
    return true;
}

void Workbench::exportText(const std::string& path, std::function<std::string(const Progress&)> make) {
    const std::string name = fs::path(path).filename().string();
    jobs_.start("export " + path, "Exporting " + name,
                [this, path, name, make = std::move(make)](const Progress& progress) -> Jobs::Finish {
                    const std::string text = make(progress);
                    progress.advance(1);
                    writeAtomically(path, text);
                    return [this, name] { message("Exported " + name); };
                });
}

void Workbench::exportFigure(const std::string& path, std::function<VectorPage(const Progress&)> make) {
    exportText(path, [path, make = std::move(make), shown = document_.snapshot()](const Progress& progress) {
        VectorPage page = make(progress);
        page.session = printSession(shown, path);
        return fileOf(page, path.ends_with(".pdf") ? "pdf" : "svg");
    });
}

} // namespace tessera::app
