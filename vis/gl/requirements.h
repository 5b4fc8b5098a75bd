#pragma once

#include <string>

namespace tessera::vis {

/// OpenGL 4.5 core features that the current context lacks, as text for an error message: its version, and each feature
/// that neither the version nor an extension provides. Empty if nothing is missing.
std::string missingFeatures();

} // namespace tessera::vis
