#pragma once

#include "volume/field/stored_range.h"

namespace tessera::volume {

/// Edge enhancement: adds `amount` times the difference of every present sample to the mean of its nearest neighbours
/// (6 on CC, 8 on BCC), within the range of its part. Where one of two opposite neighbours is absent or of another
/// part, both count as the sample itself.
Field sharpened(const Field& source, double amount);
/// The same of a part of a frame, within the range of the whole.
Field sharpened(const Field& part, double amount, const StoredExtent& extent);

} // namespace tessera::volume
