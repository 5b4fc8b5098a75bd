#pragma once

#include "volume/base/pieces.h"
#include "volume/system/scratch_file.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tessera::codec {

/// What one of the processes of a team wrote.
struct SharedResult {
    std::unique_ptr<const volume::ScratchFile> file;
    std::uint64_t size = 0;
};

/// Processes that pack the same frames together. Each of them takes the same steps in the same order; the slabs of some
/// steps are shared among them.
class SlabTeam {
public:
    using Write = std::function<void(std::span<const std::byte> bytes)>;

    virtual ~SlabTeam() = default;
    /// Has `work(piece, write)` called for all pieces of a step, each in one of the processes; returns files of what it
    /// wrote once all are done. Throws MachineError, Cancelled, and what `work` throws.
    virtual std::vector<SharedResult> share(const std::string& step, std::size_t pieces,
                                            const std::function<void(std::size_t, const Write&)>& work) = 0;
    /// Whether this process writes the archive; the others only help.
    virtual bool writes() const = 0;

    /// The same for results in memory.
    Pieces pieces(const std::string& step) {
        return [this, step](std::size_t count, const std::function<std::vector<std::byte>(std::size_t)>& work) {
            std::vector<std::vector<std::byte>> results;
            const auto writeWork = [&](std::size_t piece, const Write& write) { write(work(piece)); };
            for (const SharedResult& result : share(step, count, writeWork))
                result.file->read(0, results.emplace_back(result.size));
            return results;
        };
    }
};

} // namespace tessera::codec
