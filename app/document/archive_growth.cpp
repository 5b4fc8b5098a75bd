#include "app/document/archive_growth.h"

#include "codec/archive/archive.h"
#include "codec/remote/address.h"
#include "volume/base/error.h"
#include "volume/derived/derived.h"
#include "volume/derived/other_source.h"

#include <algorithm>
#include <filesystem>

namespace tessera::app {

namespace {

/// The samples of a grown archive that are unchanged: all of them, except where D4* frames are shown as BCC: the last
/// times change, since they are interpolated with the three frames after them.
vis::SameSamples sameSamples(const volume::BrickSource& was, const volume::BrickSource& is) {
    const std::vector<volume::Channel> before = was.info().channels(), now = is.info().channels();
    if (now.size() < before.size() || !std::equal(before.begin(), before.end(), now.begin())) return {};
    constexpr int kMadeOfOthers = 4;
    const int times = int(was.info().times.size());
    const bool stored = dynamic_cast<const codec::Archive*>(&is) != nullptr;
    return {int(before.size()), stored ? times : std::max(times - kMadeOfOthers, 0)};
}

/// True if a data set continues another one: the same bricks, with all its parameters and times, and possibly more.
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

/// The data with those of the second data set, if any.
struct Both {
    std::shared_ptr<const volume::BrickSource> own, other;
    explicit Both(const std::shared_ptr<const volume::BrickSource>& source)
        : own(volume::firstDataOf(*source)), other(volume::otherOf(*source)) {
        if (!own) own = source;
    }
    std::shared_ptr<const volume::BrickSource> joined() const { return other ? volume::withOther(own, other) : own; }
};

/// The second data set of a session as a DataRef of its own.
DataRef otherData(const DataRef& data) {
    DataRef other;
    other.remote = data.remote;
    if (data.other) {
        other.files = data.other->files;
        other.import = data.other->import;
    }
    return other;
}

/// Path or address of the archive that holds the data; "" if there is none.
std::string archivePath(const DataRef& data) {
    return isArchive(data) ? data.files[0].absolutePath : "";
}

/// The data shown, with archives read again and without derived parameters. Other files are not read again. Throws
/// Error.
Sources readAgain(const DataRef& data, const Sources& shown) {
    std::vector<std::string> known; // messages already shown at opening
    Both numbers(volume::underived(shown.numbers));
    NumberOrigin origin = shown.origin;
    const auto open = [&](const DataRef& archive, NumberOrigin& of) {
        Sources opened = openArchived(archive, known);
        of = std::move(opened.origin);
        return opened.numbers;
    };
    if (isArchive(data)) {
        numbers.own = open(data, origin);
        origin.other = shown.origin.other;
    }
    if (numbers.other && isArchive(otherData(data))) {
        NumberOrigin same;
        numbers.other = open(otherData(data), same);
    }
    const auto joined = numbers.joined();
    const Sources again{joined, joined, std::move(origin)};
    return shown.pictures == shown.numbers ? again : drawnOn(latticeOf(shown), again);
}

/// Describes what a grown archive has gained; "" = nothing.
std::string grownText(const std::string& path, const volume::BrickSource& was, const volume::BrickSource& is) {
    const std::string name = std::filesystem::path(path).filename().string();
    const std::size_t times = is.info().times.size();
    if (times > was.info().times.size()) return name + " has grown to " + std::to_string(times) + " times";
    return is.info().parameters.size() > was.info().parameters.size() ? name + " has more parameters" : "";
}

} // namespace

bool ArchiveGrowth::changed(const DataRef* data, const std::function<void()>& wake) {
    std::array<std::string, 2> paths;
    if (data) paths = {archivePath(*data), archivePath(otherData(*data))};
    bool any = false;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        if (paths[i].empty())
            watches_[i].reset();
        else if (!watches_[i] || watches_[i]->path() != paths[i])
            watches_[i] =
                std::make_unique<GrowthWatch>(paths[i], wake, (codec::isRemote(paths[i]) ? 10 : 1) * interval_);
        if (watches_[i] && watches_[i]->changed()) any = true;
    }
    return any;
}

std::optional<Grown> readGrown(const DataRef& data, const Sources& shown,
                               const std::vector<volume::DerivedParameter>& derived, const Progress& progress) {
    const auto before = volume::underived(shown.numbers);
    const Both was(before);
    if (data.other.has_value() != (was.other != nullptr)) return {}; // the second data set is being changed
    const Sources now = readAgain(data, shown);
    const Both is(now.numbers);
    if (!goesOn(*was.own, *is.own) || (was.other && !goesOn(*was.other, *is.other))) return {};
    Grown grown;
    const std::string own = grownText(archivePath(data), *was.own, *is.own),
                      other = was.other ? grownText(archivePath(otherData(data)), *was.other, *is.other) : "";
    for (const std::string& text : {own, other})
        if (!text.empty()) grown.news.push_back(text);
    if (grown.news.empty()) return {};
    grown.same = sameSamples(*before, *now.numbers);
    if (!other.empty()) grown.same.channels = std::min(grown.same.channels, int(was.own->info().channels().size()));
    grown.sources = deriveBoth(now, derived, grown.problems, progress);
    return grown;
}

} // namespace tessera::app
