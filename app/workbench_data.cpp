#include "app/pack_child.h"
#include "app/ui/file_dialog.h"
#include "app/workbench.h"
#include "volume/background.h"
#include "volume/derived.h"

#include <filesystem>

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
    remade.data.derived = session_.data.derived; // others by now: they are made next
    const auto recorded = history_.data().derived;
    moveTo(session_, history_, &source_->info(), remade.source->info(), remade.data, remade.messages);
    remade.data.derived = recorded; // an edit that goes on is still to become a step
    history_.setData(remade.data);
    source_ = std::move(remade.source);
    renderer_->setSource(source_);
    caches_.clear();
    playback_ = {};
    unsavedEdits_ = true;
    for (const std::string& text : remade.messages) message(text);
    return true;
}

void Workbench::showAs(const DataRef& data, const std::string& title) {
    jobs_.start("open", title, [this, title, from = source_, data](const Progress& progress) -> Jobs::Finish {
        const auto made = std::make_shared<Remade>(Remade{from, nullptr, data, {}});
        made->source = openSource(data, made->messages, progress);
        return [this, title, made] {
            if (!show(std::move(*made))) message(title + ": not shown, as the data have changed meanwhile");
        };
    });
}

void Workbench::pack(const std::string& path) {
    std::vector<std::string> inputs;
    for (const DataFile& file : session_.data.files) inputs.push_back(file.absolutePath);
    jobs_.start("pack", "Packing " + fs::path(path).filename().string(),
                [this, path, inputs, from = source_, import = session_.data.import, derived = session_.data.derived,
                 program = options_.program](const Progress& progress) -> Jobs::Finish {
                    workInBackground();
                    const PackedArchive archive =
                        packInChild(fs::canonical(program).string(), inputs, import, path, progress.part(0, 0.95));
                    const std::string done =
                        "Packed " + textOfBytes(archive.sourceBytes) + " into " + textOfBytes(archive.archiveBytes);
                    const auto made = std::make_shared<Remade>(Remade{from, nullptr, dataOf({path}, {}), {}});
                    made->data.derived = derived;
                    made->source = openSource(made->data, made->messages, progress.part(0.95, 1));
                    return [this, path, done, made] {
                        message(done + (show(std::move(*made)) ? ", now shown from " : ": ") + path);
                    };
                });
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
                [this, below = volume::underived(source_), wanted = derivedWanted_,
                 from = source_](const Progress& progress) -> Jobs::Finish {
                    auto messages = std::make_shared<std::vector<std::string>>();
                    const auto made = volume::deriveAll(below, wanted, *messages, progress);
                    return [this, messages, made, wanted, from] {
                        if (source_ != from) { // gone on, or other data, meanwhile: derived from those
                            derivedWanted_ = derivedShown_;
                            return;
                        }
                        source_ = made;
                        derivedShown_ = wanted;
                        renderer_->setSource(source_);
                        caches_.clear();
                        fitSession(session_, source_->info(), *messages);
                        for (const std::string& text : *messages) message(text, true);
                    };
                });
}

} // namespace tessera::app
