#include "codec/blocks/shared_job.h"

#include "volume/base/error.h"
#include "volume/system/atomic_file.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

namespace tessera::codec {

namespace {

namespace fs = std::filesystem;

constexpr auto kPause = std::chrono::milliseconds(50);
constexpr const char *kLock = "job.lock", *kAbout = "job.json", *kComplete = "complete";

std::string contentOf(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

bool isThere(const std::string& path) {
    std::error_code ignored;
    return fs::exists(path, ignored);
}

/// Says that a process of a launcher's job has done its part.
std::string leftFile(const Launched& launched, int rank) {
    return "left-" + launched.job + "-" + std::to_string(rank);
}

void pause(const Progress& progress) {
    if (progress.stop.stop_requested()) throw Cancelled();
    std::this_thread::sleep_for(kPause);
}

} // namespace

SharedJob::SharedJob(const std::string& output, const std::string& about, const Launched& launched,
                     const Progress& progress)
    : folder_(output + ".blocks"), launched_(launched) {
    for (;; pause(progress)) {
        std::error_code problem;
        if (launched.rank == 0) fs::create_directory(folder_, problem);
        if (problem) throw MachineError("cannot be made: " + problem.message(), folder_);
        if (!isThere(folder_)) continue; // the first process of the job makes it
        inside_ = LockedFile::tryLock(file(kLock), LockedFile::Kind::Shared);
        if (!inside_ || !inside_->hasName()) continue; // somebody is removing it
        if (!complete() || (launched.count > 1 && contentOf(file(kComplete)) == launched.job)) break;
        // It is left of work that was completed before: this is the next.
        inside_.reset();
        const auto alone = LockedFile::tryLock(file(kLock), LockedFile::Kind::Exclusive);
        if (alone && alone->hasName()) fs::remove_all(folder_, problem);
    }
    // A launcher may give the runs of a job the same name: who has left a former one has not left this one.
    std::error_code ignored;
    for (int rank = 0; launched.rank == 0 && rank < launched.count; ++rank)
        fs::remove(file(leftFile(launched, rank)), ignored);
    const LockedFile alone = lock("about.lock", progress);
    if (!isThere(file(kAbout))) writeAtomically(file(kAbout), about);
    if (contentOf(file(kAbout)) != about)
        throw Error("belongs to other data or options; finish that work, or remove the folder", folder_);
}

SharedJob::~SharedJob() {
    std::error_code ignored;
    std::ofstream(file(leftFile(launched_, launched_.rank))).flush();
    const bool isComplete = complete();
    inside_.reset();
    if (!isComplete) return;
    try {
        const auto alone = LockedFile::tryLock(file(kLock), LockedFile::Kind::Exclusive);
        if (!alone || !alone->hasName()) return;
        for (int rank = 0; rank < launched_.count; ++rank)
            if (!isThere(file(leftFile(launched_, rank)))) return; // it has not come yet
        fs::remove_all(folder_, ignored);
    } catch (const Error&) { // the folder stays
    }
}

std::size_t SharedJob::share(const std::string& name, std::size_t count, const std::function<bool(std::size_t)>& isDone,
                             const std::function<void(std::size_t)>& work, const Progress& progress) const {
    std::size_t own = 0;
    for (const bool waits : {false, true})
        for (std::size_t piece = 0; piece < count; ++piece)
            for (; !isDone(piece); pause(progress)) {
                const auto lock = LockedFile::tryLock(file(name + "-" + std::to_string(piece) + ".lock"),
                                                      LockedFile::Kind::Exclusive);
                if (lock && !isDone(piece)) {
                    work(piece);
                    ++own;
                }
                if (lock || !waits) break;
                progress.advance(double(piece) / double(count), "waiting for other processes");
            }
    return own;
}

LockedFile SharedJob::lock(const std::string& name, const Progress& progress) const {
    for (;; pause(progress))
        if (auto lock = LockedFile::tryLock(file(name), LockedFile::Kind::Exclusive)) return std::move(*lock);
}

void SharedJob::setComplete() const {
    writeAtomically(file(kComplete), launched_.job);
}

bool SharedJob::complete() const {
    return isThere(file(kComplete));
}

} // namespace tessera::codec
