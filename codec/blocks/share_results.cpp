#include "codec/blocks/share_results.h"

#include "codec/blocks/shared_job.h"
#include "volume/base/error.h"
#include "volume/system/atomic_file.h"
#include "volume/system/input_file.h"
#include "volume/system/part_file.h"

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

std::optional<std::string> textIn(const std::string& path) {
    if (!whyNoFile(path).empty()) return std::nullopt;
    std::ifstream in(path, std::ios::binary);
    if (!in) return std::nullopt;
    return std::string(std::istreambuf_iterator<char>(in), {});
}

} // namespace

SharedResults shareResults(const SharedWork& work, std::size_t count,
                           const std::function<std::string(std::size_t, const Progress&)>& compute,
                           const std::function<void(const std::vector<std::string>&, const Progress&)>& finish,
                           const Progress& progress) {
    constexpr double kFinish = 0.9; // from here on
    const std::string output = replacedFile(withoutSlash(work.output));
    const auto part = [&](std::size_t piece) {
        return progress.part(kFinish * double(piece) / double(count), kFinish * double(piece + 1) / double(count));
    };
    SharedResults shared;
    std::error_code ignored;
    if (!work.launched || (work.launched->count == 1 && !fs::exists(output + ".blocks", ignored))) {
        for (std::size_t piece = 0; piece < count; ++piece) shared.results.push_back(compute(piece, part(piece)));
        finish(shared.results, progress.part(kFinish, 1));
        shared.own = count;
        shared.last = true;
        progress.advance(1);
        return shared;
    }
    const SharedJob job(output, work.about, *work.launched, progress);
    const auto file = [&](std::size_t piece) { return job.file("result-" + std::to_string(piece)); };
    const auto isDone = [&](std::size_t piece) {
        if (job.complete()) return true;
        const std::optional<std::string> result = textIn(file(piece));
        return result && (!work.isMade || work.isMade(piece, *result));
    };
    shared.own = job.share(
        "piece", count, isDone, [&](std::size_t piece) { writeAtomically(file(piece), compute(piece, part(piece))); },
        progress.part(0, kFinish));
    const LockedFile lock = job.lock("finish.lock", progress, kFinish);
    for (std::size_t piece = 0; piece < count; ++piece) {
        std::optional<std::string> result = textIn(file(piece));
        if (!result) throw MachineError("cannot be read", file(piece));
        shared.results.push_back(std::move(*result));
    }
    if (!job.complete()) {
        finish(shared.results, progress.part(kFinish, 1));
        job.setComplete();
        shared.last = true;
    }
    progress.advance(1);
    return shared;
}

} // namespace tessera::codec
