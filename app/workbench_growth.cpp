#include "app/workbench.h"

#include "codec/archive.h"
#include "volume/error.h"
#include "volume/labelled_source.h"
#include "volume/other_source.h"

#include <algorithm>
#include <filesystem>

namespace tessera::app {

namespace {

/// What an archive that has grown has of what it was: everything, but where frames of D4* are shown as BCC the last
/// times were made without the frames that have come.
vis::SameSamples sameSamples(const volume::BrickSource& was, const volume::BrickSource& is) {
    const std::vector<volume::Channel> before = was.info().channels(), now = is.info().channels();
    if (now.size() < before.size() || !std::equal(before.begin(), before.end(), now.begin())) return {};
    constexpr int kMadeOfOthers = 2;
    const int times = int(was.info().times.size());
    const bool stored = dynamic_cast<const codec::Archive*>(&is) != nullptr;
    return {int(before.size()), stored ? times : std::max(times - kMadeOfOthers, 0)};
}

/// True if a data set is another one gone on: the same bricks, all its parameters and times, and more of them.
bool goesOn(const volume::BrickSource& was, const volume::BrickSource& is) {
    const volume::DatasetInfo &before = was.info(), &now = is.info();
    if (was.grid() != is.grid() || now.times.size() < before.times.size() ||
        now.parameters.size() < before.parameters.size() ||
        !std::equal(before.times.begin(), before.times.end(), now.times.begin()))
        return false;
    const auto same = [](const volume::Parameter& a, const volume::Parameter& b) {
        return a.name == b.name && a.components == b.components && a.type == b.type;
    };
    if (!std::equal(before.parameters.begin(), before.parameters.end(), now.parameters.begin(), same)) return false;
    return now.times.size() > before.times.size() || now.parameters.size() > before.parameters.size();
}

} // namespace

/// Takes over what has become whole in an archive that grows while it is shown; the view of the data stays as it is.
void Workbench::followGrowth() {
    const auto& files = session_.data.files;
    const bool archive = source_ && !options_.headless && files.size() == 1 && files[0].absolutePath.ends_with(".tsr");
    if (!archive) {
        growth_.reset();
        return;
    }
    const std::string path = files[0].absolutePath;
    if (!growth_ || growth_->path() != path)
        growth_ = std::make_unique<GrowthWatch>(path, jobs_.wake, options_.growthInterval);
    if (!growth_->changed()) return;
    jobs_.start(
        "growth", "Reading what is new",
        [this, path, data = session_.data, from = source_,
         derived = derivedShown_](const Progress& progress) -> Jobs::Finish {
            auto messages = std::make_shared<std::vector<std::string>>();
            Sources made;
            try {
                std::vector<std::string> known; // was said when it was opened
                made = openArchived(data, known);
                made.pictures = made.numbers = volume::withLabelNames(made.pictures, data.import.labels);
            } catch (const Error&) {
                return {}; // being replaced: what is shown stays good
            }
            if (const auto other = volume::otherOf(*volume::underived(from))) {
                const auto both = volume::withOther(made.pictures, other);
                made = {both, both, made.origin};
            }
            if (!goesOn(*volume::underived(from), *made.pictures)) return {};
            const vis::SameSamples same = sameSamples(*volume::underived(from), *made.pictures);
            made = deriveBoth(made, derived, *messages, progress);
            return [this, path, messages, made, from, same] {
                if (source_ != from) { // other data, or derived anew from what was there: look again
                    growth_.reset();
                    return;
                }
                const std::size_t times = made.pictures->info().times.size(),
                                  more = times - source_->info().times.size();
                take(made, same); // views keep what they have: a drag goes on
                fitSession(session_, source_->info(), *messages);
                const std::string name = std::filesystem::path(path).filename().string();
                message(name +
                        (more > 0 ? " has grown to " + std::to_string(times) + " times" : " has more parameters"));
                for (const std::string& text : *messages) message(text, true);
            };
        },
        true);
}

} // namespace tessera::app
