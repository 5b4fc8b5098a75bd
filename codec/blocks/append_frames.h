#pragma once

#include "codec/archive/archive.h"
#include "codec/container/metadata.h"

#include <cstdint>
#include <span>

namespace tessera::codec {

/// Whether frames of two archives can be in one: the same features of the format are used in both, but for those that
/// are only set once they are.
bool codedAlike(const Archive& archive, const Archive& more);

/// Appends the coded frames of another archive to an archive, in one commit and without decoding them: `now` is the
/// metadata of both together, which has either the times of `more` in addition or its parameters at the same times;
/// `componentOf`: index in the archive of each component of `more`, counted through all parameters. Both must have the
/// same grid and be coded alike. The first added time has no change of bricks since the time before. Returns the bytes
/// of the file. Throws Error when the two are not codedAlike(), when `more` is damaged or another program writes the
/// archive; MachineError.
std::uint64_t appendFrames(const Archive& archive, const Archive& more, const Metadata& now,
                           std::span<const std::size_t> componentOf);

} // namespace tessera::codec
