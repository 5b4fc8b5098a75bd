#include "codec/blocks/pack_blocks.h"

#include "codec/blocks/join.h"
#include "codec/blocks/shared_job.h"
#include "codec/blocks/shared_slabs.h"
#include "codec/container/json_text.h"
#include "codec/container/options_json.h"
#include "codec/pack/frame_queue.h"
#include "codec/pack/pack_grid.h"
#include "codec/pack/pack_passes.h"
#include "volume/field/part_masks.h"
#include "volume/field/quantities.h"
#include "volume/resample/resample.h"
#include "volume/system/atomic_file.h"
#include "volume/system/input_file.h"
#include "volume/system/part_file.h"
#include "volume/system/sync.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>
#include <thread>
#include <vector>

namespace tessera::codec {

namespace {

namespace fs = std::filesystem;

using Ranges = std::vector<std::vector<Range>>; ///< by parameter, then component

void check(const volume::Dataset& source, const PackOptions& options, const BlockOptions& blocks) {
    const char* const what = options.lattice == StoredLattice::D4 ? "frames of D4*"
                             : options.sizeMb > 0                 ? "the error that fits a size"
                             : options.discard > 0                ? "the bricks to omit"
                                                                  : nullptr;
    if (what != nullptr)
        throw Error(std::string(what) + " depend on all times: blocks of times cannot be packed apart");
    if (!blocks.bySlab) return;
    if (hasThreshold(options)) throw Error("a threshold depends on all slabs of a time: they cannot be packed apart");
    if (!source.read.inParts())
        throw Error(
            "slabs are those of raw files, uncompressed NRRD files and archives on the requested lattice; other "
            "data are read as a whole");
}

/// What all processes must agree on.
std::string aboutJob(const volume::DatasetInfo& info, PackOptions options, const BlockOptions& blocks) {
    options.memoryMb = 0;
    nlohmann::json parameters = nlohmann::json::array();
    for (const volume::Parameter& parameter : info.parameters)
        parameters.push_back({{"name", parameter.name},
                              {"unit", parameter.unit},
                              {"components", parameter.components},
                              {"type", volume::name(parameter.type)}});
    const glm::ivec3 size = info.lattice.size;
    return jsonText({{"name", info.name},
                     {"parameters", parameters},
                     {"times", info.times},
                     {"size", {size.x, size.y, size.z}},
                     {"options", toJson(options)},
                     {"blockTimes", blocks.times},
                     {"byParameter", blocks.byParameter},
                     {"bySlab", blocks.bySlab},
                     {"inputs", blocks.inputs}});
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
    std::ifstream in = openInput(path);
    Ranges ranges(parameters);
    for (std::vector<Range>& each : ranges) {
        std::size_t count = 0;
        if (!(in >> count)) throw Error("is damaged: remove it", path);
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
    sum.loadSeconds += more.loadSeconds;
    sum.resampleSeconds += more.resampleSeconds;
    sum.codeSeconds += more.codeSeconds;
    sum.writeSeconds += more.writeSeconds;
    sum.waitSeconds += more.waitSeconds;
    for (const std::string& note : more.notes)
        if (std::ranges::find(sum.notes, note) == sum.notes.end()) sum.notes.push_back(note);
}

/// The blocks of a series, some of them joined already. A block is one piece, or one for each parameter.
class Blocks {
public:
    Blocks(const volume::Dataset& source, const PackOptions& options, const std::string& path,
           const BlockOptions& blocks, const Progress& progress)
        : source_(source), options_(options), path_(path), times_(blocks.times),
          pieces_(blocks.byParameter ? source.info.parameters.size() : 1), bySlab_(blocks.bySlab),
          job_(path, aboutJob(source.info, options, blocks), blocks.launched, progress) {
        // An automatic size of bricks depends on the number of times; a last block of one time has the same.
        const volume::Lattice& lattice = source.info.lattice;
        const bool toBcc = options.lattice == StoredLattice::BCC && lattice.kind == volume::LatticeKind::CC;
        options_.brickSize = gridFor(toBcc ? volume::bccFor(lattice) : lattice, source.info, options).brickSize;
    }

    std::size_t count() const { return (source_.info.times.size() + times_ - 1) / times_; }
    std::size_t pieces() const { return count() * pieces_; }

    /// Finds the ranges of all times, if bounds are relative to them.
    void gatherRanges(const Progress& progress);
    /// Packs pieces, and joins what is complete; returns how many this process packed.
    std::size_t pack(PackSummary& sum, const PackedBefore& before, const Progress& progress);
    /// Joins the rest and gives the archive its name; false if another process did.
    bool finish(const Progress& progress);

private:
    volume::Dataset blockOf(std::size_t number) const, piece(std::size_t number) const;
    PackedBefore beforeOf(std::size_t number, std::size_t times, PackedBefore before) const;
    std::string fileOf(std::size_t block) const { return job_.file(std::to_string(block) + ".tsr"); }
    std::string pieceOf(std::size_t number) const {
        if (pieces_ == 1) return fileOf(number);
        return job_.file(std::to_string(number / pieces_) + "-" + std::to_string(number % pieces_) + ".tsr");
    }
    std::string rangesOf(std::size_t piece) const { return job_.file("ranges-" + std::to_string(piece)); }
    std::string joined() const { return job_.file("joined.tsr"); }
    /// States that a block is joined: network file systems show new names at once, but what another machine has written
    /// into a file maybe later.
    std::string statementOf(std::size_t block) const { return job_.file(std::to_string(block) + ".joined"); }
    bool isPacked(std::size_t piece, const Progress& progress);
    bool countJoined(bool waits, const Progress& progress);
    void countJoinedSeen();
    bool seesAllJoined() const { return joinedBlocks_ == count() || !fs::exists(statementOf(joinedBlocks_)); }
    double share(std::size_t piece) const { return double(piece) / double(pieces()); }
    void mergeComplete(std::size_t block) const;
    std::size_t shareOut(const std::string& name, const std::function<bool(std::size_t)>& isDone,
                         const std::function<void(std::size_t, SlabTeam*)>& work,
                         const std::function<void(std::size_t, SlabTeam*)>& help, const Progress& progress) const;
    void joinComplete(bool waits, const Progress& progress);

    volume::Dataset source_;
    PackOptions options_;
    std::string path_;
    std::size_t times_, pieces_; ///< of a block
    bool bySlab_;
    SharedJob job_;
    std::size_t joinedBlocks_ = 0;   ///< at least so many
    std::uintmax_t joinedBytes_ = 0; ///< of the file when they were counted
};

volume::Dataset Blocks::blockOf(std::size_t number) const {
    const std::size_t first = number / pieces_ * times_, end = std::min(first + times_, source_.info.times.size());
    std::vector<int> times(end - first);
    std::iota(times.begin(), times.end(), int(first));
    return volume::withTimes(source_, times);
}

volume::Dataset Blocks::piece(std::size_t number) const {
    const volume::Dataset block = blockOf(number);
    return pieces_ == 1 ? block : volume::withParameters(block, {int(number % pieces_)});
}

/// What is known of the source, for one piece: the blocks together have compared as many samples as the source.
PackedBefore Blocks::beforeOf(std::size_t number, std::size_t times, PackedBefore before) const {
    if (pieces_ > 1 && !before.resampled.empty()) before.resampled = {before.resampled[number % pieces_]};
    before.source.reset();                       // of all times
    before.keepsNumbers = number % pieces_ == 0; // of all parameters
    if (pieces_ > 1) before.whole = blockOf(number);
    before.ofSeries = before.ofSeries || source_.info.times.size() > 1;
    for (std::optional<ResampleError>& error : before.resampled)
        if (error) error->samples *= double(times) / double(source_.info.times.size());
    return before;
}

void Blocks::gatherRanges(const Progress& progress) {
    std::vector<volume::Parameter>& parameters = source_.info.parameters;
    const auto known = [](const volume::Parameter& parameter) { return !parameter.ranges.empty(); };
    if (std::ranges::all_of(parameters, known)) return;
    const auto isDone = [&](std::size_t number) { return fs::exists(rangesOf(number)); };
    const auto find = [&](std::size_t number, SlabTeam* team) {
        volume::Dataset own = piece(number);
        return unknownRanges(own, options_, rangesOf(number), progress.part(share(number), share(number + 1)), team);
    };
    const auto work = [&](std::size_t number, SlabTeam* team) {
        writeAtomically(rangesOf(number), textOf(find(number, team)));
    };
    shareOut("ranges", isDone, work, find, progress);
    Ranges all(parameters.size());
    for (std::size_t number = 0; number < pieces(); ++number) {
        const std::size_t first = number % pieces_, own = parameters.size() / pieces_;
        const Ranges more = readRanges(rangesOf(number), own);
        for (std::size_t p = 0; p < own; ++p) widenRanges(all[first + p], more[p]);
    }
    settleRanges(source_.info, all);
}

/// Finds out how many blocks have been joined; false if this machine does not see all of them, where it does
/// not wait for that. The caller has the lock.
bool Blocks::countJoined(bool waits, const Progress& progress) {
    constexpr std::chrono::milliseconds kLongest{10000}, kPause{100};
    for (auto waited = kPause;; waited += kPause) {
        try {
            countJoinedSeen();
            if (seesAllJoined()) return true;
            if (waited > kLongest) break;
        } catch (const Error&) { // a part of it is seen
            if (waited > kLongest) throw;
        }
        joinedBytes_ = 0; // open it again
        if (!waits) return false;
        progress.advance(share(joinedBlocks_ * pieces_), "waiting for other processes");
        std::this_thread::sleep_for(kPause);
    }
    for (std::size_t block = joinedBlocks_; block < count(); ++block) fs::remove(statementOf(block)); // it was removed
    return true;
}

void Blocks::countJoinedSeen() {
    std::error_code missing;
    const std::uintmax_t bytes = fs::file_size(joined(), missing);
    if (job_.complete())
        joinedBlocks_ = count();
    else if (missing)
        joinedBlocks_ = 0;
    else if (bytes != joinedBytes_)
        joinedBlocks_ = (Archive(joined()).info().times.size() + times_ - 1) / times_;
    joinedBytes_ = missing ? 0 : bytes;
}

bool Blocks::isPacked(std::size_t piece, const Progress& progress) {
    const std::size_t block = piece / pieces_;
    const auto isThere = [&] {
        return block < joinedBlocks_ || fs::exists(pieceOf(piece)) || fs::exists(fileOf(block)) || job_.complete() ||
               (fs::exists(statementOf(block)) && fs::exists(joined()));
    };
    if (isThere()) return true;
    const LockedFile lock = job_.lock("join.lock", progress, share(piece)); // it is not being joined now
    return isThere();
}

/// Makes a block of its pieces, if they are all there; the caller has the lock.
void Blocks::mergeComplete(std::size_t block) const {
    if (pieces_ == 1) return;
    const std::size_t first = block * pieces_;
    const auto isThere = [&](std::size_t piece) { return fs::exists(pieceOf(first + piece)); };
    if (!fs::exists(fileOf(block))) {
        for (std::size_t piece = 0; piece < pieces_; ++piece)
            if (!isThere(piece)) return;
        const std::string merged = job_.file(std::to_string(block) + ".merging");
        fs::copy_file(pieceOf(first), merged, fs::copy_options::overwrite_existing);
        for (std::size_t piece = 1; piece < pieces_; ++piece) join(merged, pieceOf(first + piece));
        fs::rename(merged, fileOf(block));
        syncFolderOf(fileOf(block));
    }
    for (std::size_t piece = 0; piece < pieces_; ++piece) fs::remove(pieceOf(first + piece));
}

/// Joins the complete blocks that follow those joined before; the caller has the lock.
void Blocks::joinComplete(bool waits, const Progress& progress) {
    if (!countJoined(waits, progress)) return;
    for (std::size_t block = 0; block < joinedBlocks_; ++block) fs::remove(fileOf(block)); // after a crash
    for (; joinedBlocks_ < count(); ++joinedBlocks_) {
        mergeComplete(joinedBlocks_);
        if (!fs::exists(fileOf(joinedBlocks_))) break;
        progress.advance(share(joinedBlocks_ * pieces_), "joining");
        const std::string next = fileOf(joinedBlocks_);
        std::error_code problem;
        if (joinedBlocks_ > 0)
            join(joined(), next);
        else
            fs::create_hard_link(next, joined(), problem); // in place of no blocks that are not seen here yet
        if (problem == std::errc::file_exists) throw MachineError("is there already", joined());
        if (problem) fs::rename(next, joined()); // a file system without links
        std::ofstream(statementOf(joinedBlocks_)).flush();
        fs::remove(next); // not before: so a block that is joined again after a crash is the same
    }
}

/// Shares pieces as SharedJob::share; by slabs, processes that do not `work` on a piece `help` with it.
std::size_t Blocks::shareOut(const std::string& name, const std::function<bool(std::size_t)>& isDone,
                             const std::function<void(std::size_t, SlabTeam*)>& work,
                             const std::function<void(std::size_t, SlabTeam*)>& help, const Progress& progress) const {
    const auto plain = [&](std::size_t number) { work(number, nullptr); };
    if (!bySlab_) return job_.share(name, pieces(), isDone, plain, progress);
    const auto teamOf = [&](std::size_t number, bool writes) {
        return SharedSlabs(job_, name + "-" + std::to_string(number), writes, progress);
    };
    const auto together = [&](std::size_t number) {
        SharedSlabs team = teamOf(number, true);
        work(number, &team);
        team.end();
    };
    const auto helped = [&](std::size_t number) {
        SharedSlabs team = teamOf(number, false);
        try {
            if (!team.isOver()) help(number, &team);
        } catch (const MachineError&) {
            if (!team.endsSoon()) throw;
        }
    };
    return job_.share(name, pieces(), isDone, together, progress, helped);
}

std::size_t Blocks::pack(PackSummary& sum, const PackedBefore& before, const Progress& progress) {
    const auto isDone = [&](std::size_t number) { return isPacked(number, progress); };
    const auto packTo = [&](const std::string& path, std::size_t number, SlabTeam* team) {
        volume::Dataset own = piece(number);
        const Progress part = progress.part(share(number), share(number + 1));
        const PackedBefore known = beforeOf(number, own.info.times.size(), before);
        return codec::pack(own, options_, path, part, known, 0, team);
    };
    const auto help = [&](std::size_t number, SlabTeam* team) {
        // Processes of other machines may have the same number.
        const std::string own = std::to_string(std::random_device()()) + std::to_string(std::random_device()());
        packTo(job_.scratch(std::to_string(number) + "-helped-" + own), number, team);
    };
    const auto work = [&](std::size_t number, SlabTeam* team) {
        const std::string growing = job_.file(std::to_string(number) + ".packing"); // readable from its first time on
        add(sum, packTo(growing, number, team));
        fs::rename(growing, pieceOf(number));
        syncFolderOf(pieceOf(number));
        if (const auto lock = LockedFile::tryLock(job_.file("join.lock"), LockedFile::Kind::Exclusive))
            joinComplete(false, progress);
    };
    return shareOut("block", isDone, work, help, progress);
}

bool Blocks::finish(const Progress& progress) {
    const LockedFile lock = job_.lock("join.lock", progress, 1);
    joinComplete(true, progress);
    if (job_.complete()) return false;
    if (joinedBlocks_ < count())
        throw MachineError(
            "block " + std::to_string(joinedBlocks_ + 1) + " of " + std::to_string(count()) + " is missing", joined());
    fs::rename(joined(), path_);
    syncFolderOf(path_);
    job_.setComplete();
    return true;
}

} // namespace

std::size_t blockTimes(std::size_t times, const Launched& launched) {
    constexpr std::size_t kUsual = 16;
    const auto processes = std::size_t(launched.count);
    return std::clamp((times + processes - 1) / processes, std::size_t(1), kUsual);
}

BlockSummary packInBlocks(const volume::Dataset& source, const PackOptions& options, const std::string& output,
                          const BlockOptions& blocks, const Progress& progress, const PackedBefore& before) {
    check(source, options, blocks);
    const std::string path = replacedFile(output);
    if (fs::is_directory(path)) throw Error("is a folder", path);
    BlockOptions settled = blocks;
    if (settled.times == 0) settled.times = blocks.bySlab ? 1 : blockTimes(source.info.times.size(), blocks.launched);
    BlockSummary summary;
    const auto started = std::chrono::steady_clock::now();
    Blocks all(source, options, path, settled, progress);
    summary.blocks = all.pieces();
    const double begin = isRelative(options) ? 0.3 : 0;
    if (isRelative(options)) all.gatherRanges(progress.part(0, begin));
    summary.packed = all.pack(summary.own, before, progress.part(begin, 1));
    summary.last = all.finish(progress);
    const Archive archive(path);
    summary.own.archiveBytes = archive.fileBytes();
    summary.own.maxError = archive.metadata().maxError;
    summary.own.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    progress.advance(1);
    return summary;
}

} // namespace tessera::codec
