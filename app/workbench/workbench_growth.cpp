#include "app/workbench/workbench.h"

#include "codec/archive/archive.h"
#include "volume/base/error.h"
#include "volume/derived/derived.h"
#include "volume/derived/other_source.h"
#include "volume/sources/labelled_source.h"

#include <algorithm>
#include <array>
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

/// True if a data set is another one gone on: the same bricks, all its parameters and times, and maybe more of them.
bool goesOn(const volume::BrickSource& was, const volume::BrickSource& is) {
    const volume::DatasetInfo &before = was.info(), &now = is.info();
    if (was.grid() != is.grid() || now.times.size() < before.times.size() ||
        now.parameters.size() < before.parameters.size() ||
        !std::equal(before.times.begin(), before.times.end(), now.times.begin()))
        return false;
    const auto same = [](const volume::Parameter& a, const volume::Parameter& b) {
        return a.name == b.name && a.components == b.components && a.type == b.type;
    };
    return std::equal(before.parameters.begin(), before.parameters.end(), now.parameters.begin(), same);
}

/// Data with those beside them, if any.
struct Both {
    std::shared_ptr<const volume::BrickSource> own, other;
    explicit Both(const std::shared_ptr<const volume::BrickSource>& source)
        : own(volume::besideOther(*source)), other(volume::otherOf(*source)) {
        if (!own) own = source;
    }
    std::shared_ptr<const volume::BrickSource> joined() const { return other ? volume::withOther(own, other) : own; }
};

/// The other data of a session on their own.
DataRef otherData(const DataRef& data) {
    DataRef other;
    if (data.other) {
        other.files = data.other->files;
        other.import = data.other->import;
    }
    return other;
}

/// Path of the archive that the data are; "" = they are none.
std::string archivePath(const DataRef& data) {
    return isArchive(data) ? data.files[0].absolutePath : "";
}

/// What is shown, with all that its archives hold by now, without derived parameters. What is no archive is not read
/// again. Throws Error.
Sources readAgain(const DataRef& data, const Sources& shown) {
    std::vector<std::string> known; // was said when they were opened
    Both pictures(volume::underived(shown.pictures)), numbers(volume::underived(shown.numbers));
    NumberOrigin origin = shown.origin;
    const auto open = [&](const DataRef& archive, NumberOrigin& of) {
        const Sources opened = openArchived(archive, known);
        of = opened.origin;
        return volume::withLabelNames(opened.pictures, archive.import.labels);
    };
    if (isArchive(data)) {
        pictures.own = numbers.own = open(data, origin);
        origin.other = shown.origin.other;
    }
    if (pictures.other && isArchive(otherData(data))) {
        NumberOrigin same;
        pictures.other = numbers.other = open(otherData(data), same);
    }
    const auto joined = pictures.joined();
    const bool one = pictures.own == numbers.own && pictures.other == numbers.other;
    return {joined, one ? joined : numbers.joined(), origin};
}

/// What an archive has got that has gone on; "" = nothing.
std::string grownText(const std::string& path, const volume::BrickSource& was, const volume::BrickSource& is) {
    const std::string name = std::filesystem::path(path).filename().string();
    const std::size_t times = is.info().times.size();
    if (times > was.info().times.size()) return name + " has grown to " + std::to_string(times) + " times";
    return is.info().parameters.size() > was.info().parameters.size() ? name + " has more parameters" : "";
}

} // namespace

/// Takes over what has become whole in archives that grow while they are shown, the first or the one beside it; the
/// view of the data stays as it is.
void Workbench::followGrowth() {
    const bool follow = source_ && !options_.headless && !session_.data.timeAxis;
    std::array<std::string, 2> paths;
    if (follow) paths = {archivePath(session_.data), archivePath(otherData(session_.data))};
    bool changed = false;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        if (paths[i].empty())
            growth_[i].reset();
        else if (!growth_[i] || growth_[i]->path() != paths[i])
            growth_[i] = std::make_unique<GrowthWatch>(paths[i], jobs_.wake, options_.growthInterval);
        if (growth_[i] && growth_[i]->changed()) changed = true;
    }
    if (!changed) return;
    jobs_.start(
        "growth", "Reading what is new",
        [this, paths, data = session_.data, from = sources(),
         derived = derivedShown_](const Progress& progress) -> Jobs::Finish {
            auto messages = std::make_shared<std::vector<std::string>>();
            const Both was(volume::underived(from.pictures));
            if (data.other.has_value() != (was.other != nullptr)) return {}; // about to be shown otherwise
            Sources made;
            try {
                made = readAgain(data, from);
            } catch (const Error&) {
                return {}; // being replaced: what is shown stays good
            }
            const Both is(made.pictures);
            if (!goesOn(*was.own, *is.own) || (was.other && !goesOn(*was.other, *is.other))) return {};
            const std::string grown = grownText(paths[0], *was.own, *is.own),
                              otherGrown = was.other ? grownText(paths[1], *was.other, *is.other) : "";
            if (grown.empty() && otherGrown.empty()) return {};
            vis::SameSamples same = sameSamples(*volume::underived(from.pictures), *made.pictures);
            if (!otherGrown.empty()) same.channels = std::min(same.channels, int(was.own->info().channels().size()));
            made = deriveBoth(made, derived, *messages, progress);
            return [this, grown, otherGrown, messages, made, from, same] {
                if (source_ != from.pictures) { // other data, or derived anew from what was there: look again
                    growth_ = {};
                    return;
                }
                take(made, same); // views keep what they have: a drag goes on
                fitSession(session_, source_->info(), *messages);
                for (const std::string& text : {grown, otherGrown})
                    if (!text.empty()) message(text);
                for (const std::string& text : *messages) message(text, true);
            };
        },
        true);
}

} // namespace tessera::app
