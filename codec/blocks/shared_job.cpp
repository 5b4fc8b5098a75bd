#include "codec/blocks/shared_job.h"

#include "volume/base/error.h"
#include "volume/system/atomic_file.h"
#include "volume/system/input_file.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <thread>
#include <unistd.h>
#include <vector>

namespace tessera::codec {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kPause(100), kShortest(5);
constexpr auto kLongest = std::chrono::minutes(10); ///< from the first to the last process that is ready
constexpr const char *kLock = "job.lock", *kAbout = "job.json", *kComplete = "complete";
/// Files of jobs of launchers: how many processes they have, and which of them have come and left.
constexpr std::string_view kRanks = "ranks-", kCame = "came-", kLeft = "left-";

std::string contentOf(const std::string& path) {
    if (!whyNoFile(path).empty()) return {};
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

bool isThere(const std::string& path) {
    std::error_code ignored;
    return fs::exists(path, ignored);
}

std::string fileOf(std::string_view begin, const std::string& job, int rank) {
    return std::string(begin) + job + "-" + std::to_string(rank);
}

std::vector<std::string> namesIn(const std::string& folder, std::string_view begin) {
    std::vector<std::string> names;
    std::error_code problem;
    for (fs::directory_iterator at(folder, problem), end; !problem && at != end; at.increment(problem))
        if (const std::string name = at->path().filename().string(); name.starts_with(begin)) names.push_back(name);
    return names;
}

} // namespace

SharedJob::SharedJob(const std::string& output, const std::string& about, const Launched& launched,
                     const Progress& progress)
    : folder_(output + ".blocks"), launched_(launched) {
    const auto begin = std::chrono::steady_clock::now();
    const std::string own = file(fileOf(kLeft, launched.job, launched.rank));
    bool made = false; // by this process: whoever has been in the folder belongs to this run
    for (;;) {
        std::error_code problem;
        if (launched.rank == 0) made = fs::create_directory(folder_, problem) || made;
        if (problem) throw MachineError("cannot be made: " + problem.message(), folder_);
        // Whether this process belongs to the work that has been completed here, and has not been in it yet.
        const auto isOwn = [&] {
            return launched.count > 1 && contentOf(file(kComplete)) == launched.job && !isThere(own);
        };
        if (auto alone = LockedFile::tryLock(file(kLock), LockedFile::Kind::Exclusive);
            alone && alone->isAt(file(kLock))) {
            if (complete() && !isOwn()) {
                if (!remove(std::move(*alone))) throw MachineError("is complete, and cannot be removed", folder_);
                continue;
            }
            if (!complete()) removeEnded(launched.rank == 0 && !made);
            removeScratch({});
        }
        inside_ = LockedFile::tryLock(file(kLock), LockedFile::Kind::Shared);
        if (inside_ && inside_->isAt(file(kLock)) && (!complete() || isOwn())) break;
        inside_.reset(); // somebody is removing it
        if (!isThere(folder_) && std::chrono::steady_clock::now() - begin > kLongest)
            throw MachineError(
                "the first process of the job has not made it; where each process has work of its own, say "
                "--alone",
                folder_);
        progress.advance(0, "waiting for the first process");
        std::this_thread::sleep_for(kPause);
    }
    const LockedFile alone = lock("about.lock", progress, 0);
    if (launched.count > 1) {
        writeAtomically(file(std::string(kRanks) + launched.job), std::to_string(launched.count));
        std::ofstream(file(fileOf(kCame, launched.job, launched.rank))).flush();
    }
    if (!isThere(file(kAbout))) writeAtomically(file(kAbout), about);
    if (contentOf(file(kAbout)) != about)
        throw Error("belongs to other data or options; finish that work, or remove the folder", folder_);
}

SharedJob::~SharedJob() {
    std::ofstream(file(fileOf(kLeft, launched_.job, launched_.rank))).flush();
    inside_.reset();
    if (!complete() && holdsWork()) return;
    try {
        auto alone = LockedFile::tryLock(file(kLock), LockedFile::Kind::Exclusive);
        if (!alone || !alone->isAt(file(kLock)) || (!complete() && holdsWork())) return;
        for (const std::string& ranks : namesIn(folder_, kRanks)) {
            const std::string job = ranks.substr(kRanks.size());
            const int count = std::atoi(contentOf(file(ranks)).c_str());
            for (int rank = 0; rank < count; ++rank) // one that came and did not leave was killed, as nobody is inside
                if (!isThere(file(fileOf(kLeft, job, rank))) && !isThere(file(fileOf(kCame, job, rank)))) return;
        }
        remove(std::move(*alone));
    } catch (const Error&) { // the folder stays
    }
}

void SharedJob::removeScratch(const std::string& begin) const {
    std::error_code ignored;
    for (const std::string& name : namesIn(folder_, kScratch + begin)) fs::remove(file(name), ignored);
}

/// Removes what processes left that have ended without completing the work; nobody is inside. Those of this job may
/// have left it to others that are still to come: only its first process can tell (`ownToo`), where it found the folder
/// instead of making it, that they are of an earlier run.
void SharedJob::removeEnded(bool ownToo) const {
    const std::string own = launched_.job + "-", ownRanks = std::string(kRanks) + launched_.job;
    std::error_code ignored;
    for (const std::string_view begins : {kRanks, kCame, kLeft})
        for (const std::string& name : namesIn(folder_, begins)) {
            const bool isOwn = name == ownRanks || (begins != kRanks && name.starts_with(std::string(begins) + own));
            if (ownToo || !isOwn) fs::remove(file(name), ignored);
        }
}

/// Whether there is something that the next run can go on from.
bool SharedJob::holdsWork() const {
    return std::ranges::any_of(namesIn(folder_, {}), [](const std::string& name) {
        return !name.ends_with(".lock") && name != kAbout && !name.starts_with(kRanks) && !name.starts_with(kCame) &&
               !name.starts_with(kLeft) && !name.starts_with(kScratch);
    });
}

/// Removes the folder, in which nobody else is; false if it cannot be. It gets another name first: so nobody enters
/// meanwhile, and network file systems do not keep the locked file in it.
bool SharedJob::remove(LockedFile alone) const {
    const std::string removed = folder_ + ".removed-" + std::to_string(::getpid());
    std::error_code problem;
    fs::rename(folder_, removed, problem);
    if (problem) return false;
    { const LockedFile ends = std::move(alone); }
    fs::remove_all(removed, problem);
    return true;
}

void SharedJob::pause(std::chrono::milliseconds& time, const Progress& progress, double fraction) const {
    if (!isThere(folder_)) throw MachineError("was removed meanwhile", folder_);
    progress.advance(fraction, "waiting for other processes");
    std::this_thread::sleep_for(time);
    time = std::min(2 * time, kPause);
}

std::size_t SharedJob::share(const std::string& name, std::size_t count, const std::function<bool(std::size_t)>& isDone,
                             const std::function<void(std::size_t)>& work, const Progress& progress,
                             const std::function<void(std::size_t)>& help) const {
    std::size_t own = 0;
    for (const bool waits : {false, true})
        for (std::size_t piece = 0; piece < count; ++piece) {
            bool helped = false;
            for (auto wait = kShortest;; pause(wait, progress, double(piece) / double(count))) {
                const auto lock = LockedFile::tryLock(file(name + "-" + std::to_string(piece) + ".lock"),
                                                      LockedFile::Kind::Exclusive);
                if (lock && !isDone(piece)) {
                    work(piece);
                    ++own;
                }
                if (lock || (!waits && !help)) break;
                if (help && !helped) help(piece);
                helped = true;
            }
        }
    return own;
}

LockedFile SharedJob::lock(const std::string& name, const Progress& progress, double fraction) const {
    for (auto wait = kShortest;; pause(wait, progress, fraction))
        if (auto lock = LockedFile::tryLock(file(name), LockedFile::Kind::Exclusive)) return std::move(*lock);
}

void SharedJob::setComplete() const {
    writeAtomically(file(kComplete), launched_.job);
}

bool SharedJob::complete() const {
    return isThere(file(kComplete));
}

} // namespace tessera::codec
