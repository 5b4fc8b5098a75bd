#pragma once

#include "app/importer/arrays/array_file.h"

namespace tessera::importer {

/// Makes a source of the arrays that share the commonest grid: three axes of space before two, then most arrays, then
/// most samples. Others are named in a note. Axes of arrays that name none are guessed: [z, y, x], [t, z, y, x], or
/// with 3 components as a last axis; one-dimensional arrays named x, y, z are coordinates then; t, time or times are
/// times. Throws if there is no grid.
void openArrays(ArrayFile file, Source& source);

} // namespace tessera::importer
