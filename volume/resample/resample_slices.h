#pragma once

#include "volume/base/progress.h"
#include "volume/field/slices.h"
#include "volume/field/stored_range.h"
#include "volume/resample/resample_options.h"

#include <memory>
#include <string>

/// Resampling of frames larger than memory: slices of the result from slices of the source, bit for bit equal to those
/// of volume/resample/resample.h. Its filters are short along z, except the prefilter of B-splines: their coefficients
/// are computed once, in whole lines along z, through a scratch file.
namespace tessera::volume {

/// A frame that is read in slices.
struct SlicedFrame {
    Lattice lattice;
    SliceReader read;
    StoredExtent extent;                    ///< of all of it; not needed of a frame in memory
    std::shared_ptr<Field> whole = nullptr; ///< all of it, of a frame in memory
};

/// A frame in memory.
SlicedFrame inMemory(Field field);

/// What work on frames larger than memory may hold.
struct SliceMemory {
    int step = 0;       ///< slices of a source in memory at a time; 0: whole frames
    std::string folder; ///< for scratch files
};

/// Reads a frame once, `step` slices at a time, for its extent.
StoredExtent extentOf(const Lattice& lattice, const SliceReader& read, int step, const Progress& progress = {});

/// A CC frame resampled to another lattice, or the frame itself if that is its own. A frame in memory stays there
/// (volume::resample). Of others samples of about `memory.step` slices of the source are in memory at a time while
/// coefficients are computed, and later those that the requested slices need. Absent samples as in volume::resample,
/// but slices in which all are present may have a mask. Throws Error for a BCC source on another lattice, MachineError,
/// Cancelled.
SlicedFrame resampled(const SlicedFrame& source, const Lattice& target, const ResampleOptions& options,
                      const SliceMemory& memory, const Progress& progress = {});

/// The frame with edges enhanced as by volume::sharpened.
SlicedFrame sharpened(const SlicedFrame& source, double amount, int step, const Progress& progress = {});

} // namespace tessera::volume
