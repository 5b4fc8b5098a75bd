#include "app/data/pack_child.h"
#include "app/pane/view_parts.h"
#include "app/session/session_file.h"
#include "app/ui/file_dialog.h"
#include "app/user_files/import_memory.h"
#include "app/views/data/derived_list.h"
#include "app/workbench/workbench.h"
#include "volume/base/background.h"
#include "volume/derived/derived.h"
#include "volume/import/over_time.h"

#include <filesystem>
#include <imgui.h>

/// The data under a session that stays: packed, resampled, cut along time, with other parameters derived.
namespace tessera::app {

namespace fs = std::filesystem;

/// True for files that are not an archive.
bool Workbench::showsDataFiles() const {
    const auto& files = session_.data.files;
    return source_ && !files.empty() && !(files.size() == 1 && files[0].absolutePath.ends_with(".tsr"));
}

/// Shows what a job has made under the session as it is now: what was edited meanwhile stays, and can be undone. False,
/// and nothing changes, where other data are shown by now.
bool Workbench::show(Remade remade) {
    if (source_ != remade.from) return false;
    derivedShown_ = derivedWanted_ = remade.data.derived;
    countedShown_ = countedWanted_ = countedBy(remade.data);
    latticeShown_ = latticeWanted_ = remade.data.lattice;
    labelsShown_ = remade.data.import.labels;
    remade.data.derived = session_.data.derived; // others by now: they are made next
    remade.data.lattice = session_.data.lattice;
    remade.data.axis = session_.data.axis;
    remade.data.import.overTime = session_.data.import.overTime;
    if (remade.data.files == session_.data.files) remade.data.import.labels = session_.data.import.labels;
    const DataRef recorded = history_.data();
    moveTo(session_, history_, &source_->info(), remade.sources.pictures->info(), remade.data, remade.messages);
    remade.data.lattice = recorded.lattice;
    remade.data.axis = recorded.axis;
    remade.data.import.overTime = recorded.import.overTime;
    if (remade.data.files == recorded.files) remade.data.import.labels = recorded.import.labels;
    remade.data.derived = recorded.derived; // an edit that goes on is still to become a step
    history_.setData(remade.data);
    take(std::move(remade.sources));
    playback_ = {};
    unsavedEdits_ = true;
    for (const std::string& text : remade.messages) message(text);
    return true;
}

void Workbench::showAs(const DataRef& data, const std::string& title) {
    jobs_.start("open", title, [this, title, from = source_, data](const Progress& progress) -> Jobs::Finish {
        const auto made = std::make_shared<Remade>(Remade{from, {}, data, {}});
        made->sources = openSources(data, made->messages, progress);
        return [this, title, made] {
            if (!show(std::move(*made))) message(title + ": not shown, as the data have changed meanwhile");
        };
    });
}

void Workbench::compareWith(const std::vector<std::string>& paths) {
    const std::string title = paths.empty() ? "Without the other data" : "Comparing with another file";
    jobs_.start("open", title,
                [this, title, paths, from = source_, data = session_.data](const Progress& progress) -> Jobs::Finish {
                    const auto made = std::make_shared<Remade>(Remade{from, {}, data, {}});
                    made->data.other.reset();
                    if (!paths.empty()) {
                        const DataRef other =
                            dataOf(paths, recallOptions(paths, volume::ImportOptions{}, progress.part(0, 0.1)));
                        made->data.other =
                            OtherData{.files = other.files, .model = {}, .settings = {}, .import = other.import};
                    }
                    made->sources = openSources(made->data, made->messages, progress.part(0.1, 1));
                    return [this, title, made] {
                        if (!show(std::move(*made)))
                            return message(title + ": not shown, as the data have changed meanwhile");
                        const volume::DatasetInfo& info = source_->info();
                        const auto channel = session_.data.other ? resolveChannel(info, session_, "") : std::nullopt;
                        if (!channel) return;
                        const volume::DerivedParameter difference =
                            newDifference(info, info.channel(*channel).name, {volume::OtherTime::Other});
                        if (const std::string problem = volume::derivedProblem(difference, info); problem.empty())
                            message("New parameter: " + addDerived(session_, difference));
                        else
                            message("No difference is made: " + problem);
                    };
                });
}

void Workbench::pack(const std::string& path) {
    std::vector<std::string> inputs;
    for (const DataFile& file : session_.data.files) inputs.push_back(file.absolutePath);
    jobs_.start("pack", "Packing " + fs::path(path).filename().string(),
                [this, path, inputs, from = source_, import = session_.data.import, derived = session_.data.derived,
                 other = session_.data.other, program = options_.program](const Progress& progress) -> Jobs::Finish {
                    workInBackground();
                    const PackedArchive archive =
                        packInChild(fs::canonical(program).string(), inputs, import, path, progress.part(0, 0.95));
                    const std::string done =
                        "Packed " + textOfBytes(archive.sourceBytes) + " into " + textOfBytes(archive.archiveBytes);
                    const auto made = std::make_shared<Remade>(Remade{from, {}, dataOf({path}, {}), {}});
                    made->data.derived = derived;
                    made->data.other = other;
                    made->sources = openSources(made->data, made->messages, progress.part(0.95, 1));
                    return [this, path, done, made] {
                        message(done + (show(std::move(*made)) ? ", now shown from " : ": ") + path);
                    };
                });
}

/// Shows the data from these sources from now on; of data that have `grown` views keep what they have made.
void Workbench::take(Sources sources, std::optional<vis::SameSamples> grown) {
    source_ = std::move(sources.pictures);
    numbers_ = sources.numbers ? std::move(sources.numbers) : source_;
    origin_ = std::move(sources.origin);
    renderer_->setSource(source_, grown.value_or(vis::SameSamples{}));
    if (!grown) caches_.clear();
}

/// Draws the data on another lattice when that has been edited.
void Workbench::followLattice() {
    const PictureLattice wanted = session_.data.lattice;
    if (!source_ || wanted == latticeShown_) {
        if (latticeWanted_ != latticeShown_) jobs_.cancel("lattice"); // taken back
        latticeWanted_ = latticeShown_;
        return;
    }
    if (wanted == latticeWanted_) return; // on its way, or cancelled
    latticeWanted_ = wanted;
    rememberChoice(options_.stateFolder, kLatticeChoice, std::string(kPictureLatticeNames[std::size_t(wanted)]));
    if (isArchive(session_.data) || session_.data.packed) {
        latticeShown_ = wanted; // of data that lie on a lattice of their own
        return;
    }
    jobs_.start("lattice", "Resampling for pictures",
                [this, wanted, sources = sources(), derived = derivedShown_](const Progress&) -> Jobs::Finish {
                    const Sources made = drawnOn(wanted, sources, derived);
                    return [this, made, wanted, sources] {
                        if (source_ != sources.pictures) { // gone on, or other data, meanwhile: made of those
                            latticeWanted_ = latticeShown_;
                            return;
                        }
                        take(made);
                        latticeShown_ = wanted;
                    };
                });
}

Workbench::CountedBy Workbench::countedBy(const DataRef& data) {
    return {data.axis, data.timeAxis, data.import.overTime};
}

/// Opens the data again when the axis of times, the plane whose times run along an axis, or the table over time has
/// been edited; what is shown stays until then.
void Workbench::followAxis() {
    const CountedBy wanted = countedBy(session_.data);
    if (!source_ || wanted == countedShown_) {
        if (countedWanted_ != countedShown_) jobs_.cancel("axis"); // taken back
        countedWanted_ = countedShown_;
        return;
    }
    if (wanted == countedWanted_ || ImGui::IsMouseDown(ImGuiMouseButton_Left)) return; // on its way, or still dragged
    countedWanted_ = wanted;
    jobs_.start("axis", "Reading the times",
                [this, from = source_, data = session_.data](const Progress& progress) -> Jobs::Finish {
                    const auto made = std::make_shared<Remade>(Remade{from, {}, data, {}});
                    made->sources = openSources(data, made->messages, progress);
                    return [this, made] {
                        if (!show(std::move(*made))) countedWanted_ = countedShown_;
                    };
                });
}

/// Adds the quantities of a table to the data shown.
void Workbench::addTable(const std::string& path) {
    jobs_.start("table", "Reading " + fs::path(path).filename().string(),
                [this, path, from = source_](const Progress&) -> Jobs::Finish {
                    volume::DatasetInfo info = from->info();
                    const volume::TimeTable table = volume::readTimeTable(path);
                    volume::addTable(info, table);
                    return [this, path, from, columns = table.columns.size()] {
                        if (source_ != from) return;
                        session_.data.import.overTime = absolutePath(path).generic_string();
                        message(std::to_string(columns) + (columns == 1 ? " quantity" : " quantities") +
                                " over time from " + path);
                    };
                });
}

/// Opens the data again, with the names that regions have been given.
void Workbench::followLabels() {
    const std::vector<std::string>& wanted = session_.data.import.labels;
    if (!source_ || wanted == labelsShown_) {
        labelsWanted_ = labelsShown_;
        return;
    }
    // On its way, or cancelled; or still being typed.
    if (wanted == labelsWanted_ || ImGui::IsAnyItemActive()) return;
    labelsWanted_ = wanted;
    if (!options_.headless) rememberLabels(wanted, labelsShown_, source_->info().name);
    showAs(session_.data, "Naming regions");
}

/// Makes the source again when the parameters derived from it have been edited; what is shown stays until then.
void Workbench::followDerived() {
    if (!source_ || session_.data.derived == derivedShown_) {
        if (derivedWanted_ != derivedShown_) jobs_.cancel("derive"); // taken back
        derivedWanted_ = derivedShown_;
        return;
    }
    if (session_.data.derived == derivedWanted_) return; // on its way, or cancelled
    derivedWanted_ = session_.data.derived;
    jobs_.start("derive", "Deriving parameters",
                [this, below = Sources(volume::underived(source_), volume::underived(numbers_), origin_),
                 wanted = derivedWanted_, from = source_](const Progress& progress) -> Jobs::Finish {
                    auto messages = std::make_shared<std::vector<std::string>>();
                    const Sources made = deriveBoth(below, wanted, *messages, progress);
                    return [this, messages, made, wanted, from] {
                        if (source_ != from) { // gone on, or other data, meanwhile: derived from those
                            derivedWanted_ = derivedShown_;
                            return;
                        }
                        take(made);
                        derivedShown_ = wanted;
                        fitSession(session_, source_->info(), *messages);
                        for (const std::string& text : *messages) message(text, true);
                    };
                });
}

} // namespace tessera::app
