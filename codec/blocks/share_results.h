#pragma once

#include "volume/base/progress.h"
#include "volume/system/launched.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tessera::codec {

/// Work whose pieces, such as the times of a series, processes share.
struct SharedWork {
    std::string output; ///< what is made; the processes agree in the folder OUTPUT.blocks
    std::string about;  ///< describes the work, the same in all processes
    /// How the processes were started; nothing: this one does everything by itself, whatever others do.
    std::optional<Launched> launched = std::nullopt;
    /// Whether the files that a piece has made beside its result are still there; empty: it makes none.
    std::function<bool(std::size_t piece, const std::string& result)> isMade = {};
};

struct SharedResults {
    std::vector<std::string> results; ///< of all pieces, whoever did them
    std::size_t own = 0;              ///< pieces that this process did
    bool last = false;                ///< this process called `finish`
};

/// Does the pieces 0 .. count - 1, each in one of the processes that share the work (codec/blocks/shared_job.h), and
/// calls `finish` in one of them with the results of all pieces in their order. `compute` returns a piece's result as
/// text; files that it writes itself must appear whole or not at all. Returns when everything is done. What is complete
/// when all processes have ended is continued by the next run, also by a process alone. A process that was started
/// alone makes no folder. Throws what the callbacks throw, and as SharedJob.
SharedResults shareResults(const SharedWork& work, std::size_t count,
                           const std::function<std::string(std::size_t, const Progress&)>& compute,
                           const std::function<void(const std::vector<std::string>&, const Progress&)>& finish,
                           const Progress& progress = {});

} // namespace tessera::codec
