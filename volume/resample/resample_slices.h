#pragma once

#include "volume/field/slices.h"
#include "volume/field/stored_range.h"
#include "volume/resample/resample.h"

#include <string>

/// Resampling of frames larger than memory: slices of the result from slices of the source, bit for bit equal to those
/// of volume/resample/resample.h. Its filters are short along z, except the prefilter of B-splines: their coefficients
/// are computed once, in whole lines along z, through a scratch file.
namespace tessera::volume {

/// A frame that is read in slices.
struct SlicedFrame {
    Lattice lattice;
    SliceReader read;
    StoredExtent extent; ///< of all of it
};

/// Reads a frame once, `step` slices at a time, for its extent.
StoredExtent extentOf(const Lattice& lattice, const SliceReader& read, int step, const Progress& progress = {});

/// A CC frame resampled to another lattice, or the frame itself where that is its own. Samples of up to about `step`
/// slices of the source are in memory at a time while coefficients are made, and later those that the slices asked for
/// need. `scratch`: folder for scratch files. Absent samples as in volume::resample, but slices in which all are
/// present may have a mask. Throws Error for a BCC source on another lattice, MachineError, Cancelled.
SlicedFrame resampled(const SlicedFrame& source, const Lattice& target, const ResampleOptions& options, int step,
                      const std::string& scratch, const Progress& progress = {});

/// The frame with edges enhanced as by volume::sharpened.
SlicedFrame sharpened(const SlicedFrame& source, double amount, int step, const Progress& progress = {});

/// volume::sharpened of a part of a frame: held within the range of the whole.
Field sharpened(const Field& part, double amount, const StoredExtent& extent);

/// Throws Error for an order no filter has.
void checkOrder(const ResampleOptions& options);

} // namespace tessera::volume
