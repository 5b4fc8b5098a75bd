#include "codec/blocks/shared_slabs.h"

#include "volume/base/error.h"

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <thread>

namespace tessera::codec {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kMoment(100), kPatience(10000); ///< until another machine sees a change

/// Gives a file its name when `work` has written all of it, followed by its size. It need not survive a crash of the
/// machine. The caller has a lock, so nobody else writes it.
void writeWhole(const std::string& path, const std::function<void(const SlabTeam::Write&)>& work) {
    const std::string writing = path + ".writing";
    errno = 0;
    std::ofstream out(writing, std::ios::binary | std::ios::trunc);
    const auto requireGood = [&] {
        if (out) return;
        throw MachineError(std::string("cannot be written: ") + std::strerror(errno != 0 ? errno : EIO), writing);
    };
    requireGood();
    std::uint64_t size = 0;
    const auto write = [&](std::span<const std::byte> bytes) {
        errno = 0;
        out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
        requireGood();
        size += bytes.size();
    };
    work(write);
    const std::uint64_t all = size;
    write(std::as_bytes(std::span(&all, 1)));
    out.close();
    requireGood();
    std::error_code problem;
    fs::rename(writing, path, problem);
    if (problem) throw MachineError("cannot be named: " + problem.message(), writing);
}

/// The file, when all of it is seen here; network file systems may show its name before.
SharedResult openWhole(const std::string& path, const Progress& progress) {
    for (auto waited = kMoment;; waited += kMoment) {
        SharedResult result{volume::ScratchFile::of(path), 0};
        const std::uint64_t all = result.file->size();
        if (all >= sizeof result.size) {
            result.file->read(all - sizeof result.size, std::as_writable_bytes(std::span(&result.size, 1)));
            if (result.size + sizeof result.size == all) return result;
        }
        if (waited > kPatience) throw MachineError("is not whole", path);
        progress.advance(0);
        std::this_thread::sleep_for(kMoment);
    }
}

} // namespace

SharedSlabs::SharedSlabs(const SharedJob& job, const std::string& piece, bool writes, const Progress& progress)
    : job_(job), piece_(piece), writes_(writes), progress_{{}, progress.stop} {}

bool SharedSlabs::isOver() const {
    std::error_code ignored;
    return !writes_ && fs::exists(overFile(), ignored);
}

bool SharedSlabs::endsSoon() const {
    for (auto waited = kMoment; !isOver(); waited += kMoment) {
        if (waited > kPatience) return false;
        std::this_thread::sleep_for(kMoment);
    }
    return true;
}

std::vector<SharedResult> SharedSlabs::share(const std::string& step, std::size_t pieces,
                                             const std::function<void(std::size_t, const Write&)>& work) {
    const std::string name = piece_ + "-" + std::to_string(steps_++) + "-" + step;
    const auto fileOf = [&](std::size_t number) { return job_.scratch(name + "-" + std::to_string(number)); };
    const auto isDone = [&](std::size_t number) {
        std::error_code ignored;
        return fs::exists(fileOf(number), ignored) || isOver();
    };
    const auto make = [&](std::size_t number) {
        writeWhole(fileOf(number), [&](const Write& write) { work(number, write); });
    };
    job_.share("scratch-" + name, pieces, isDone, make, progress_);
    std::vector<SharedResult> results;
    for (std::size_t number = 0; number < pieces; ++number) results.push_back(openWhole(fileOf(number), progress_));
    return results;
}

void SharedSlabs::end() const {
    if (std::ofstream over(overFile()); over.flush()) job_.removeScratch(piece_ + "-");
}

} // namespace tessera::codec
