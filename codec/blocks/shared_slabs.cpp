#include "codec/blocks/shared_slabs.h"

#include "volume/base/error.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace tessera::codec {

namespace {

namespace fs = std::filesystem;

/// Gives a file its name when `work` has written all of it. It need not survive a crash of the machine. The caller has
/// a lock, so nobody else writes it.
void writeWhole(const std::string& path, const std::function<void(const SlabTeam::Write&)>& work) {
    const std::string writing = path + ".writing";
    errno = 0;
    std::ofstream out(writing, std::ios::binary | std::ios::trunc);
    work([&](std::span<const std::byte> bytes) {
        out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    });
    out.close();
    std::error_code problem;
    if (out) fs::rename(writing, path, problem);
    if (!out || problem)
        throw MachineError(std::string("cannot be written: ") + std::strerror(errno != 0 ? errno : EIO), writing);
}

} // namespace

SharedSlabs::SharedSlabs(const SharedJob& job, const std::string& piece, bool writes, const Progress& progress)
    : job_(job), piece_(piece), writes_(writes), progress_(progress) {}

bool SharedSlabs::isOver() const {
    std::error_code ignored;
    return !writes_ && fs::exists(overFile(), ignored);
}

std::vector<std::unique_ptr<const volume::ScratchFile>>
SharedSlabs::share(const std::string& step, std::size_t pieces,
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
    std::vector<std::unique_ptr<const volume::ScratchFile>> results;
    for (std::size_t number = 0; number < pieces; ++number) results.push_back(volume::ScratchFile::of(fileOf(number)));
    return results;
}

void SharedSlabs::end() const {
    std::ofstream(overFile()).flush();
    job_.removeScratch(piece_ + "-");
}

} // namespace tessera::codec
