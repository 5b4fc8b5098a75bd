#pragma once

#include "codec/pack/pack_summary.h"

#include <string>

namespace tessera::codec {

/// Appends the times of another archive to the archive `path`, or its parameters, without decoding and coding them
/// again: the bytes of its frames are copied. Both must have been packed with the same options on the same grid, and
/// have either the same parameters, then the times of `more` must lie after those of the archive, or none in common and
/// the same times. If a parameter's range becomes wider, the archive's bound relative to it is the larger of the two.
/// Archives on D4* cannot be joined, since the frames at their ends depend on times beyond. If it throws, the archive
/// is unchanged: Error when the two do not match or one is damaged, MachineError when the file cannot be written.
PackSummary join(const std::string& path, const std::string& more);

/// Whether join() is the way to append an archive: both were packed with the same options into bricks of the same size,
/// not on D4*, and have the same parameters; whether the times follow is said by join(). Throws Error when one of them
/// cannot be opened.
bool canJoin(const std::string& path, const std::string& more);

} // namespace tessera::codec
