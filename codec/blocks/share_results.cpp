#include "codec/blocks/share_results.h"

#include "codec/blocks/shared_job.h"
#include "volume/base/error.h"
#include "volume/system/atomic_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>

namespace tessera::codec {

namespace {

namespace fs = std::filesystem;

/// The folder's name, also where the output is a folder that is named with a slash at its end.
std::string withoutSlash(const std::string& path) {
    const fs::path given(path);
    return given.has_filename() ? path : given.parent_path().string();
}

std::string textOf(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw MachineError("cannot be read", path);
    return {std::istreambuf_iterator<char>(in), {}};
}

} // namespace

SharedSummary shareResults(const SharedWork& work, std::size_t count,
                           const std::function<std::string(std::size_t, const Progress&)>& compute,
                           const std::function<void(const std::vector<std::string>&, const Progress&)>& finish,
                           const Progress& progress) {
    constexpr double kFinish = 0.9; // from here on
    const std::string output = withoutSlash(work.output);
    const auto part = [&](std::size_t piece) {
        return progress.part(kFinish * double(piece) / double(count), kFinish * double(piece + 1) / double(count));
    };
    std::vector<std::string> results;
    std::error_code ignored;
    if (!work.launched || (work.launched->count == 1 && !fs::exists(output + ".blocks", ignored))) {
        for (std::size_t piece = 0; piece < count; ++piece) results.push_back(compute(piece, part(piece)));
        finish(results, progress.part(kFinish, 1));
        progress.advance(1);
        return {count, true};
    }
    const SharedJob job(output, work.about, *work.launched, progress);
    const auto file = [&](std::size_t piece) { return job.file("result-" + std::to_string(piece)); };
    SharedSummary summary;
    if (!job.complete())
        summary.own = job.share(
            "piece", count, [&](std::size_t piece) { return job.complete() || fs::exists(file(piece)); },
            [&](std::size_t piece) { writeAtomically(file(piece), compute(piece, part(piece))); }, progress);
    const LockedFile lock = job.lock("finish.lock", progress, kFinish);
    if (job.complete()) return summary;
    for (std::size_t piece = 0; piece < count; ++piece) results.push_back(textOf(file(piece)));
    finish(results, progress.part(kFinish, 1));
    job.setComplete();
    summary.last = true;
    progress.advance(1);
    return summary;
}

} // namespace tessera::codec
