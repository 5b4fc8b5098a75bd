#pragma once

#include "codec/container/pack_options.h"
#include "codec/container/resample_error.h"
#include "codec/pack/pack_summary.h"
#include "volume/base/progress.h"
#include "volume/field/dataset.h"

#include <optional>
#include <string>
#include <vector>

/// The pipeline from a data set to an archive.
namespace tessera::codec {

/// History of samples that come from an archive (errors so far); empty for other data.
struct PackedBefore {
    std::optional<volume::Lattice> grid; ///< the samples came from, which their lattice does not tell when it is BCC
    bool lossless = true;
    double maxError = 0;                                      ///< bound on |error|, relative to a parameter's range
    std::vector<std::optional<ResampleError>> resampled = {}; ///< Metadata::resampled of that archive
};

/// Packs a data set into `path`, which is readable from the first complete time on (with d4, from the second frame).
/// Streams: one time of one parameter and its working copies are in memory; with d4, as many times of every parameter
/// as the filter spans. A time larger than `memoryMb` is processed slab by slab, to the same bytes, if the source is
/// read in parts: only a few brick layers are in memory, the rest is in scratch files beside `path`, as large as the
/// stored samples (with B-splines 4 or 8 more bytes per sample). Unknown ranges are gathered while packing (with
/// `maxError`, in a pass before). Categorical parameters are resampled to the nearest sample and only predicted, so
/// that every level has valid labels. The errors stored in the archive are the sum of `before` and the new ones. If it
/// throws, no file is left: Error for bad input or options, MachineError when the file cannot be written, Cancelled.
/// (What `memoryMb` limits: codec/pack/memory_plan.h.) `slabLayers`: number of brick layers in memory, of a source that
/// is read in parts; 0: slabs only if frames do not fit, with as many layers as fit.
PackSummary pack(volume::Dataset& source, const PackOptions& options, const std::string& path,
                 const Progress& progress = {}, const PackedBefore& before = {}, int slabLayers = 0);

/// Appends to an archive with its own options: later times of the same parameters (with d4 preceded by the last times
/// again, volume::continueD4), or further parameters at the same times. Beside these the source may have labels that
/// are equal to those of the archive, sample for sample. If it throws, complete appended times are kept; parameters are
/// appended all together or not at all. `memoryMb` as in the options. Throws Error when the data do not fit the
/// archive.
PackSummary append(volume::Dataset& source, const std::string& path, double memoryMb = 0, const Progress& progress = {},
                   const PackedBefore& before = {}, int slabLayers = 0);

} // namespace tessera::codec
