#include "codec/blocks/pack_blocks.h"

#include "codec/blocks/join.h"
#include "codec/blocks/shared_job.h"
#include "codec/container/options_json.h"
#include "codec/pack/frame_queue.h"
#include "codec/pack/pack_grid.h"
#include "codec/pack/pack_passes.h"
#include "volume/field/quantities.h"
#include "volume/system/atomic_file.h"
#include "volume/system/sync.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>

namespace tessera::codec {

namespace {

namespace fs = std::filesystem;

using Ranges = std::vector<std::vector<Range>>; ///< by parameter, then component

void check(const PackOptions& options) {
    const char* const what = options.lattice == StoredLattice::D4 ? "frames of D4*"
                             : options.sizeMb > 0                 ? "the error that fits a size"
                             : options.discard > 0                ? "the bricks to omit"
                                                                  : nullptr;
    if (what != nullptr)
        throw Error(std::string(what) + " depend on all times: blocks of times cannot be packed apart");
}

/// What all processes must agree on.
std::string aboutJob(const volume::DatasetInfo& info, PackOptions options, std::size_t blockTimes) {
    options.memoryMb = 0;
    nlohmann::json parameters = nlohmann::json::array();
    for (const volume::Parameter& parameter : info.parameters)
        parameters.push_back({{"name", parameter.name},
                              {"unit", parameter.unit},
                              {"components", parameter.components},
                              {"type", volume::name(parameter.type)}});
    const glm::ivec3 size = info.lattice.size;
    return nlohmann::json{{"name", info.name},          {"parameters", parameters},
                          {"times", info.times},        {"size", {size.x, size.y, size.z}},
                          {"options", toJson(options)}, {"blockTimes", blockTimes}}
        .dump();
}

/// Ranges as text that keeps every bit, also of empty ones.
std::string textOf(const Ranges& ranges) {
    std::string text;
    for (const std::vector<Range>& each : ranges) {
        text += std::to_string(each.size());
        for (const Range& range : each) {
            char line[64];
            std::snprintf(line, sizeof line, " %a %a", range.lo, range.hi);
            text += line;
        }
        text += '\n';
    }
    return text;
}

Ranges readRanges(const std::string& path, std::size_t parameters) {
    std::ifstream in(path);
    Ranges ranges(parameters);
    for (std::vector<Range>& each : ranges) {
        std::size_t count = 0;
        in >> count;
        for (std::string lo, hi; each.size() < count && in >> lo >> hi;)
            each.push_back({std::strtod(lo.c_str(), nullptr), std::strtod(hi.c_str(), nullptr)});
        if (each.size() != count) throw Error("is damaged: remove it", path);
    }
    return ranges;
}

void add(PackSummary& sum, const PackSummary& more) {
    sum.sourceBytes += more.sourceBytes;
    sum.sourceSamples += more.sourceSamples;
    sum.storedSamples += more.storedSamples;
    sum.storedBytes += more.storedBytes;
    sum.addedBytes += more.addedBytes;
    sum.repeatedBricks += more.repeatedBricks;
    sum.repeatedBytes += more.repeatedBytes;
    sum.bricks = more.bricks;
    sum.weakenedBricks += more.weakenedBricks;
    sum.maxError = std::max(sum.maxError, more.maxError);
    sum.loadSeconds += more.loadSeconds;
    sum.resampleSeconds += more.resampleSeconds;
    sum.codeSeconds += more.codeSeconds;
    sum.writeSeconds += more.writeSeconds;
    sum.waitSeconds += more.waitSeconds;
    for (const std::string& note : more.notes)
        if (std::ranges::find(sum.notes, note) == sum.notes.end()) sum.notes.push_back(note);
}

/// The blocks of a series, some of them joined already.
class Blocks {
public:
    Blocks(const volume::Dataset& source, const PackOptions& options, const std::string& path, std::size_t times,
           const Launched& launched, const Progress& progress)
        : source_(source), options_(options), path_(path), times_(times),
          job_(path, aboutJob(source.info, options, times), launched, progress) {}

    std::size_t count() const { return (source_.info.times.size() + times_ - 1) / times_; }

    /// Finds the ranges of all times, if bounds are relative to them.
    void gatherRanges(const Progress& progress);
    /// Packs blocks, and joins what is complete; returns how many this process packed.
    std::size_t pack(PackSummary& sum, const PackedBefore& before, const Progress& progress);
    /// Joins the rest and gives the archive its name; false if another process did.
    bool finish(const Progress& progress);

private:
    volume::Dataset block(std::size_t number) const;
    std::string fileOf(std::size_t number) const { return job_.file(std::to_string(number) + ".tsr"); }
    std::string rangesOf(std::size_t number) const { return job_.file("ranges-" + std::to_string(number)); }
    std::string joined() const { return job_.file("joined.tsr"); }
    bool isPacked(std::size_t number);
    void countJoined();
    void joinComplete(const Progress& progress);

    volume::Dataset source_;
    PackOptions options_;
    std::string path_;
    std::size_t times_;
    SharedJob job_;
    std::size_t joinedBlocks_ = 0; ///< at least so many
};

volume::Dataset Blocks::block(std::size_t number) const {
    const std::size_t first = number * times_, end = std::min(first + times_, source_.info.times.size());
    std::vector<int> times(end - first);
    std::iota(times.begin(), times.end(), int(first));
    return volume::withTimes(source_, times);
}

void Blocks::gatherRanges(const Progress& progress) {
    std::vector<volume::Parameter>& parameters = source_.info.parameters;
    const auto known = [](const volume::Parameter& parameter) { return !parameter.ranges.empty(); };
    if (std::ranges::all_of(parameters, known)) return;
    const auto isDone = [&](std::size_t number) { return fs::exists(rangesOf(number)); };
    const auto work = [&](std::size_t number) {
        volume::Dataset own = block(number);
        const Ranges found =
            unknownRanges(own, options_, rangesOf(number),
                          progress.part(double(number) / double(count()), double(number + 1) / double(count())));
        writeAtomically(rangesOf(number), textOf(found));
    };
    job_.share("ranges", count(), isDone, work, progress);
    Ranges all(parameters.size());
    for (std::size_t number = 0; number < count(); ++number) {
        const Ranges more = readRanges(rangesOf(number), parameters.size());
        for (std::size_t p = 0; p < more.size(); ++p) widenRanges(all[p], more[p]);
    }
    settleRanges(source_.info, all);
}

/// Finds out how many blocks have been joined.
void Blocks::countJoined() {
    joinedBlocks_ = count();
    if (job_.complete()) return;
    joinedBlocks_ = 0;
    if (fs::exists(joined())) joinedBlocks_ = (Archive(joined()).info().times.size() + times_ - 1) / times_;
}

bool Blocks::isPacked(std::size_t number) {
    if (number < joinedBlocks_ || fs::exists(fileOf(number))) return true;
    const LockedFile lock = job_.lock("join.lock", {});
    countJoined();
    return number < joinedBlocks_ || fs::exists(fileOf(number));
}

/// Joins the complete blocks that follow those joined before; the caller has the lock.
void Blocks::joinComplete(const Progress& progress) {
    countJoined();
    for (std::size_t number = 0; number < joinedBlocks_; ++number) fs::remove(fileOf(number)); // after a crash
    for (; joinedBlocks_ < count() && fs::exists(fileOf(joinedBlocks_)); ++joinedBlocks_) {
        if (progress.stop.stop_requested()) throw Cancelled();
        const std::string next = fileOf(joinedBlocks_);
        if (joinedBlocks_ == 0) {
            fs::rename(next, joined());
        } else {
            join(joined(), next);
            fs::remove(next);
        }
    }
}

std::size_t Blocks::pack(PackSummary& sum, const PackedBefore& before, const Progress& progress) {
    const auto isDone = [&](std::size_t number) { return isPacked(number); };
    const auto work = [&](std::size_t number) {
        volume::Dataset own = block(number);
        const std::string growing = job_.file(std::to_string(number) + ".packing"); // readable from its first time on
        const Progress part = progress.part(double(number) / double(count()), double(number + 1) / double(count()));
        add(sum, codec::pack(own, options_, growing, part, before));
        fs::rename(growing, fileOf(number));
        syncFolderOf(fileOf(number));
        if (const auto lock = LockedFile::tryLock(job_.file("join.lock"), LockedFile::Kind::Exclusive))
            joinComplete(progress);
    };
    return job_.share("block", count(), isDone, work, progress);
}

bool Blocks::finish(const Progress& progress) {
    const LockedFile lock = job_.lock("join.lock", progress);
    joinComplete(progress);
    if (!job_.complete()) job_.setComplete();
    if (!fs::exists(joined())) return false;
    fs::rename(joined(), path_);
    syncFolderOf(path_);
    return true;
}

} // namespace

std::size_t blockTimes(std::size_t times, const Launched& launched) {
    constexpr std::size_t kUsual = 16;
    const auto processes = std::size_t(launched.count);
    return std::clamp((times + processes - 1) / processes, std::size_t(1), kUsual);
}

BlockSummary packInBlocks(const volume::Dataset& source, const PackOptions& options, const std::string& path,
                          const BlockOptions& blocks, const Progress& progress, const PackedBefore& before) {
    check(options);
    const std::size_t times = blocks.times > 0 ? blocks.times : blockTimes(source.info.times.size(), blocks.launched);
    BlockSummary summary;
    Blocks all(source, options, path, times, blocks.launched, progress);
    summary.blocks = all.count();
    const double begin = isRelative(options) ? 0.3 : 0;
    if (isRelative(options)) all.gatherRanges(progress.part(0, begin));
    summary.packed = all.pack(summary.own, before, progress.part(begin, 1));
    summary.last = all.finish(progress);
    summary.own.archiveBytes = fs::file_size(path);
    progress.advance(1);
    return summary;
}

} // namespace tessera::codec
