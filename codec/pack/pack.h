#pragma once

#include "codec/brick/slab_team.h"
#include "codec/container/pack_options.h"
#include "codec/pack/pack_summary.h"
#include "codec/unpack/packed_before.h"
#include "volume/base/progress.h"
#include "volume/field/dataset.h"

#include <string>
#include <vector>

/// The pipeline from a data set to an archive.
namespace tessera::codec {

/// Packs a data set into `path`, which is readable from the first complete time on (with d4, from the second frame).
///
/// Streams: one time of one parameter and its working copies are in memory; with d4, as many times of every parameter
/// as the filter spans. A time larger than `memoryMb` is processed slab by slab, with identical output, if the source
/// can be read in parts: only a few brick layers are in memory, and the rest is in scratch files beside `path`, as
/// large as the stored samples (with B-splines 4 or 8 more bytes per sample). codec/pack/memory_plan.h defines what
/// `memoryMb` limits. `slabLayers`: number of brick layers in memory, for a source that can be read in parts; 0: slabs
/// only if frames do not fit, with as many layers as fit. `team`: processes that call this alike to pack the same data
/// together, slab by slab, from a source that can be read in parts; one of them writes the archive.
///
/// Unknown ranges are computed while packing (with `maxError`, in a pass before). Categorical parameters are resampled
/// to the nearest sample and only predicted, so that every level has valid labels. The errors stored in the archive are
/// the sum of `before` and the new ones. If it throws, no file is left: Error for bad input or options, MachineError
/// when the file cannot be written, Cancelled.
PackSummary pack(volume::Dataset& source, const PackOptions& options, const std::string& path,
                 const Progress& progress = {}, const PackedBefore& before = {}, int slabLayers = 0,
                 SlabTeam* team = nullptr);

/// The unknown ranges of a data set that is going to be packed, by parameter, then component, from a pass over it
/// within the memory of the options, which the processes of a team share; those without a sample are empty (lo > hi).
/// Throws as pack().
std::vector<std::vector<Range>> unknownRanges(volume::Dataset& source, const PackOptions& options,
                                              const std::string& path, const Progress& progress = {},
                                              SlabTeam* team = nullptr);

/// Appends to an archive with its own options: later times of the same parameters (not with d4), or further parameters
/// at the same times. In addition the source may have labels that equal those of the archive sample by sample. If it
/// throws, complete appended times are kept; parameters are appended all or none. `memoryMb` as in the options. Throws
/// Error when the data do not match the archive.
PackSummary append(volume::Dataset& source, const std::string& path, double memoryMb = 0, const Progress& progress = {},
                   const PackedBefore& before = {}, int slabLayers = 0);

} // namespace tessera::codec
