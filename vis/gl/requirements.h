#pragma once

#include <string>

namespace tessera::vis {

/// What the current context lacks of OpenGL 4.5 core, in words for an error message: its version, and each feature that
/// neither the version nor an extension brings. Empty when nothing is missing.
std::string missingFeatures();

} // namespace tessera::vis
