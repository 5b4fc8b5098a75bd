#pragma once

#include <string>

namespace tessera::vis {

/// Lists the OpenGL 4.5 core features that the current context lacks, for an error message: the version, and each
/// feature provided neither by the version nor by an extension. Empty if nothing is missing.
std::string missingFeatures();

} // namespace tessera::vis
