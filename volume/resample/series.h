#pragma once

#include "volume/base/progress.h"
#include "volume/field/field.h"
#include "volume/field/lattice4.h"
#include "volume/resample/resample.h"

#include <functional>
#include <memory>

/// A field over time, frame by frame, and operations that hold only a few frames at once.
namespace tessera::volume {

/// Component of a parameter on a lattice in space and time. `frame(k)` lies on lattice.grid(k); may be called from one
/// thread at a time. Masks may say the parts of samples (volume/field/part_masks.h): of several frames only samples of
/// one part are mixed, that of the nearest, and results say theirs.
struct Series {
    Lattice4 lattice;
    bool categorical = false; ///< labels: the nearest in space and time, no arithmetic
    std::function<std::shared_ptr<const Field>(int frame)> frame;
};

/// The same series with a cache of the last `frames` different frames.
Series remembering(Series series, std::size_t frames);

/// Number of frames that `toD4Frame` spans in time: the cache size for `remembering`.
int framesSpanned(const ResampleOptions& options);

/// A float field in another type, rounded and held within it.
Field converted(const Field& field, ScalarType type);

/// Interpolation between frames: of two frames of each parity, or of four (Catmull-Rom).
enum class TimeFilter : std::uint8_t { Linear, Cubic };
inline constexpr std::string_view kTimeFilterNames[] = {"linear", "cubic"};

/// Frame `frame` of a D4* lattice from a CC series: blended in time, then resampled. B-splines are Catmull-Rom in time.
/// Beyond the first and the last time by the straight line through the two at that end (labels: the last).
/// Result in the type of the source; 32-bit integers keep 24 bits.
Field toD4Frame(const Series& cc, const Lattice4& d4, int frame, const ResampleOptions& options);

/// A CC or D4* series at any real time (in frames; beyond the ends the nearest frame). On D4* each parity is
/// interpolated between its own frames, which gives a BCC field. The type is float unless the result is a single frame.
/// A sample is absent where frames with more than half of the (linear) weight lack it.
Field atTime(const Series& series, double time, TimeFilter filter);

/// A D4* series with samples filtered for quasi-interpolation of order two: 5/3 at the centre and -1/24 on the sixteen
/// neighbours, eight in the frame before and eight in the one after. An absent neighbour counts as the centre. Values
/// are float and may leave the range of the data. Before the first and after the last frame their neighbours repeat.
Series prefiltered(const Series& d4);

} // namespace tessera::volume
