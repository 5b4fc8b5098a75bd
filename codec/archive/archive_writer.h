#pragma once

#include "codec/archive/archive.h"
#include "codec/archive/frame_options.h"
#include "codec/brick/frame_samples.h"
#include "codec/brick/numbers.h"
#include "codec/container/metadata.h"
#include "codec/wavelet/lifting.h"
#include "volume/base/progress.h"
#include "volume/bricks/brick_importance.h"

#include <memory>
#include <optional>
#include <string>

namespace tessera::codec {

/// Writes an archive frame by frame. Committed times stay readable whatever happens later. In memory are one frame and
/// its coded bytes (for a frame in a scratch file, a slab of it, with its coded bytes in another), and, with
/// `keepsFrames`, the last frame of each component (the last two on D4*). The latter are needed to store unchanged
/// bricks as repeats of earlier ones and to store the change of the others.
///
/// A new archive is created under a temporary name beside `path`. It gets its name with the first commit, after which
/// readers see it grow, and is removed if finish() is not reached. An existing file is replaced by finish() only. An
/// archive that is appended to keeps every commit.
class ArchiveWriter {
public:
    /// A new archive. `metadata` gives the shape (lattice, grid, parameters, times); throws MachineError when the file
    /// cannot be made.
    ArchiveWriter(const std::string& path, const Metadata& metadata, bool keepsFrames = true);
    /// Appends to an archive: `metadata` is that of the archive with times after its last or parameters after its last.
    /// Throws Error when the archive has changed since it was opened, or another program is writing it. Bytes of an
    /// incomplete append are cut off.
    ArchiveWriter(const Archive& archive, const Metadata& metadata, bool keepsFrames = true);
    ~ArchiveWriter();
    ArchiveWriter(const ArchiveWriter&) = delete;
    ArchiveWriter& operator=(const ArchiveWriter&) = delete;

    /// Codes and writes one component of a parameter at a time index; each once, in any order. The samples must lie on
    /// the lattice of the metadata and have the type of the parameter; frames in scratch files need a writer that keeps
    /// no frames. Bricks are coded on all cores; the bytes do not depend on their number.
    void addFrame(int parameter, int component, int time, const FrameSamples& samples, const FrameOptions& options,
                  const Progress& progress = {});

    /// Makes everything added so far readable: the first `times` times of the metadata, which must have all their
    /// frames. A commit writes the metadata (with the ranges so far) again, so small additions are delayed: until they
    /// are 64 times as large as the metadata.
    void commit(const Metadata& metadata, std::size_t times);

    /// Number of added bricks that repeat earlier ones, and the bytes saved.
    Archive::Repeats repeats() const;

    /// Commits everything and closes the file. Returns its bytes.
    std::uint64_t finish(const Metadata& metadata);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace tessera::codec
