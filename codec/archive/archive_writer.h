#pragma once

#include "codec/archive/archive.h"
#include "codec/archive/frame_options.h"
#include "codec/brick/frame_samples.h"
#include "codec/brick/numbers.h"
#include "codec/container/metadata.h"
#include "codec/wavelet/lifting.h"
#include "volume/base/progress.h"
#include "volume/bricks/brick_importance.h"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace tessera::codec {

/// Writes an archive frame by frame. Committed times stay readable whatever happens later. Memory: one frame and its
/// coded bytes (for a frame in a scratch file, one slab, with the coded bytes in another scratch file), and with
/// `keepsFrames` the last frame of each component (the last two on D4*). These are needed to store unchanged bricks as
/// repeats and to record the change of the others.
///
/// A new archive is written under a temporary name beside `path` and renamed by the first commit, so that readers see
/// it grow; it is removed if finish() is not called. An existing file is only replaced by finish(). Appending keeps
/// every commit.
class ArchiveWriter {
public:
    /// Creates an archive. `metadata` gives its shape (lattice, grid, parameters, times). Throws MachineError when the
    /// file cannot be created.
    ArchiveWriter(const std::string& path, const Metadata& metadata, bool keepsFrames = true);
    /// Appends to an archive: `metadata` is its metadata with additional times at the end, or additional parameters.
    /// Bytes of an interrupted append are truncated. Throws Error when the archive has changed since it was opened or
    /// another program is writing it.
    ArchiveWriter(const Archive& archive, const Metadata& metadata, bool keepsFrames = true);
    ~ArchiveWriter();
    ArchiveWriter(const ArchiveWriter&) = delete;
    ArchiveWriter& operator=(const ArchiveWriter&) = delete;

    /// Codes and writes one component of a parameter at a time index; each once, in any order. The samples must be on
    /// the lattice of the metadata and have the type of the parameter; frames in scratch files require keepsFrames =
    /// false. Bricks are coded on all cores; the bytes do not depend on their number. Returns the largest error of the
    /// frame in stored units if only its mean was bounded and it was measured. Of a frame that a team shares, the
    /// processes that do not write only code some slabs; they must not commit. `unrounded`: integers that `samples` are
    /// rounded from, at a coarser scale, within the bound of the options: they are coded with quantised coefficients
    /// instead if that is shorter; stored units are theirs. `parts`: numbers of the parts that the samples belong to by
    /// the label that the metadata name, of 8 bits; quantised coefficients are then of one part each if that is
    /// shorter.
    std::optional<double> addFrame(int parameter, int component, int time, const FrameSamples& samples,
                                   const FrameOptions& options, const Progress& progress = {},
                                   const FrameSamples* unrounded = nullptr, const FrameSamples* parts = nullptr);

    /// Makes the first `times` times of the metadata readable; all their frames must have been added. A commit rewrites
    /// the metadata (with the ranges known so far), so it is delayed until the additions are 64 times as large;
    /// `metadata` is called only when they may be.
    void commit(std::size_t times, const std::function<Metadata()>& metadata);

    /// The archive as it would be if it were committed now, described by `metadata`; all its frames must have been
    /// added.
    std::shared_ptr<const Archive> written(const Metadata& metadata) const;
    /// Appends bytes that the metadata of the next commit must name: an archive of corrections
    /// (codec/unpack/corrections.h) or a block of numbers of regions. `feature`: of these. Returns where they are.
    FileRange addPart(std::span<const std::byte> bytes, std::uint32_t feature);

    /// Number of bricks stored as repeats, and the bytes saved.
    Archive::Repeats repeats() const;

    /// Commits everything and closes the file. Returns its size in bytes.
    std::uint64_t finish(const Metadata& metadata);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace tessera::codec
