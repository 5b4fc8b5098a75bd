#pragma once

#include "codec/container/pack_options.h"
#include "volume/base/progress.h"
#include "volume/field/dataset.h"
#include "volume/field/slices.h"

#include <optional>
#include <string>
#include <vector>

/// The pipeline from a data set to an archive.
namespace tessera::codec {

/// Summary of packing.
struct PackSummary {
    std::uint64_t sourceBytes = 0; ///< of all samples read
    std::uint64_t sourceSamples = 0, storedSamples = 0;
    std::uint64_t archiveBytes = 0;                      ///< of the whole file
    std::uint64_t addedBytes = 0;                        ///< of those, by this run
    std::uint64_t storedBytes = 0;                       ///< of the samples on the lattice they are stored on
    std::uint64_t repeatedBricks = 0, repeatedBytes = 0; ///< that are those of an earlier time; what that saves
    std::uint64_t bricks = 0, discardedBricks = 0;       ///< of the grid; left out of every parameter and time
    std::uint64_t weakenedBricks = 0;                    ///< whose threshold was lowered to keep the bound
    double maxError = 0; ///< bound on the error of a sample, relative to its parameter's range
    double seconds = 0;
    /// Seconds of the stages, which overlap: reading and resampling continue while the previous frame is coded.
    double loadSeconds = 0, resampleSeconds = 0, codeSeconds = 0, writeSeconds = 0;
    double waitSeconds = 0;         ///< for reading and resampling with nothing to code
    int trials = 1;                 ///< packed so often to find the error that fits a size
    std::vector<std::string> notes; ///< what the user should know, one line each
};

/// How frames can be read in parts.
struct SlabInput {
    volume::SliceLoad slices; ///< null: not at all
    int layers = 0;           ///< of bricks in memory at a time; 0: only where frames do not fit, as many as do
};

/// History of samples that come from an archive (errors so far); empty for other data.
struct PackedBefore {
    std::optional<volume::Lattice> grid; ///< the samples came from, which their lattice does not tell when it is BCC
    bool lossless = true;
    double maxError = 0; ///< bound on |error|, relative to a parameter's range
};

/// Packs a data set into `path`, which is readable from the first complete time on (with d4, from the second frame).
/// Streams: one time of one parameter and its working copies are in memory; with d4, as many times of every parameter
/// as the filter spans. A time larger than `memoryMb` is processed slab by slab, to the same bytes, if `slices` can
/// read parts of it: only a few brick layers are in memory, the rest is in scratch files beside `path`, as large as the
/// stored samples (with B-splines 4 or 8 more bytes per sample). Unknown ranges are gathered while packing (with
/// `maxError`, in a pass before). Categorical parameters are resampled to the nearest sample and only predicted, so
/// that every level has valid labels. The errors stored in the archive are the sum of `before` and the new ones. If it
/// throws, no file is left: Error for bad input or options, MachineError when the file cannot be written, Cancelled.
/// (What `memoryMb` limits: codec/pack/memory_plan.h.)
PackSummary pack(volume::Dataset& source, const PackOptions& options, const std::string& path,
                 const Progress& progress = {}, const SlabInput& slabs = {}, const PackedBefore& before = {});

/// Appends to an archive with its own options: later times of the same parameters (with d4 preceded by the last times
/// again, volume::continueD4), or further parameters at the same times. Beside these the source may have labels that
/// are equal to those of the archive, sample for sample. If it throws, complete appended times are kept; parameters are
/// appended all together or not at all. `memoryMb` as in the options. Throws Error when the data do not fit the
/// archive.
PackSummary append(volume::Dataset& source, const std::string& path, double memoryMb = 0, const Progress& progress = {},
                   const SlabInput& slabs = {}, const PackedBefore& before = {});

} // namespace tessera::codec
