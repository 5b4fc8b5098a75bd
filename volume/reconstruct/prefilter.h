#pragma once

namespace tessera::volume {

struct BrickSamples;
struct LevelGeometry;

/// What samples are filtered by before a kernel reads them: Prefiltered (volume/reconstruct/reconstruct.h), or the
/// steps of volume/reconstruct/cubic.h.
enum class Prefilter { None, Linear, Cubic };

/// How many samples of each sublattice on every side a filtered one depends on.
int prefilterReach(Prefilter filter, const LevelGeometry& geometry);

/// By how much of the width of the data's range filtered samples may leave it on either side, at most.
double prefilterOvershoot(Prefilter filter);

/// The samples of a brick gathered with prefilterReach() more on every side, filtered.
BrickSamples prefiltered(const BrickSamples& gathered, const LevelGeometry& geometry, Prefilter filter);

} // namespace tessera::volume
