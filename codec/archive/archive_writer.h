#pragma once

#include "codec/archive/archive.h"
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

/// How one frame is coded.
struct FrameOptions {
    std::optional<Wavelet> wavelet = Wavelet::W22; ///< none: the best of some, by trial
    std::optional<bool> bodyCentred;     ///< of BCC (codec/wavelet/body_centred.h); none: the shorter by trial
    std::optional<NumberCoding> numbers; ///< none: chosen for the bound
    double maxError = 0;                 ///< absolute, in stored units; 0: every sample exactly
    double spent = 0; ///< of maxError, by what was done to the samples before: codes and repeats have what is left
    /// A brick may repeat only one whose squares of differences sum up to no more than those of its own codes would.
    bool keepsSquares = false;
    bool keepsAbsent = false; ///< also the stored numbers of absent samples
    int zstdLevel = 3;
    Range range{1, 0}; ///< physical, of the component, that importance refers to; lo > hi: that of the frame
    bool categorical = false;
    volume::ImportanceOptions importance;
};

/// About how many bytes a frame is coded in, from the tokens of at most `bricks` of its bricks.
double estimateFrameBytes(const volume::BrickGrid& grid, const FrameSamples& samples, const FrameOptions& options,
                          std::size_t bricks);

/// Writes an archive frame by frame, whole times at a time: what is committed stays readable whatever happens later.
/// One frame and its coded bytes are in memory at a time (of one in a scratch file a slab of it, its coded bytes in
/// another), and if frames are kept the last one of each component (of D4* the last two): then bricks that did not
/// change are stored as repeats of earlier ones, and it is noted how far the others move. Whoever keeps none saves the
/// memory.
///
/// A new archive is made under a temporary name beside `path`; with its first commit it takes its name, where readers
/// see it grow, and disappears if finish() is not reached. A file that is there already is replaced by finish() only.
/// An archive that is appended to keeps every commit.
class ArchiveWriter {
public:
    /// A new archive. `metadata` gives the shape (lattice, grid, parameters, times); throws MachineError when the file
    /// cannot be made.
    ArchiveWriter(const std::string& path, const Metadata& metadata, bool keepsFrames = true);
    /// Appends to an archive: `metadata` is that of the archive with times behind its last or parameters behind its
    /// last. Throws Error when the archive is of an older version, has changed since it was opened, or another program
    /// is writing it. Bytes of an append that was not finished are cut off.
    ArchiveWriter(const Archive& archive, const Metadata& metadata, bool keepsFrames = true);
    ~ArchiveWriter();
    ArchiveWriter(const ArchiveWriter&) = delete;
    ArchiveWriter& operator=(const ArchiveWriter&) = delete;

    /// Codes and writes one component of a parameter at a time index; each once, in any order. The samples must lie on
    /// the lattice of the metadata and have the parameter's type; frames in scratch files go with a writer that keeps
    /// none. Bricks are coded on all cores; the bytes do not
    /// depend on how many there are.
    void addFrame(int parameter, int component, int time, const FrameSamples& samples, const FrameOptions& options,
                  const Progress& progress = {});

    /// Makes all that was added readable, in a new archive and an appended one: the first `times` times of the
    /// metadata, which must have all their frames. A commit writes the metadata (with the ranges so far) again, so
    /// little is left to wait for the next one: less than 64 times that much.
    void commit(const Metadata& metadata, std::size_t times);

    /// Bricks added that repeat earlier ones, and the bytes that saves.
    Archive::Repeats repeats() const;

    /// Commits everything and closes the file. Returns its bytes.
    std::uint64_t finish(const Metadata& metadata);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace tessera::codec
