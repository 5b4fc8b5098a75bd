#pragma once

#include <string>
#include <vector>

namespace tessera::vis {

/// An EGL display, and a name for messages.
struct EglDisplay {
    std::string name;
    void* display = nullptr;
};

/// In order of preference: hardware devices, Mesa's surfaceless platform, software devices, the default display.
std::vector<EglDisplay> eglDisplays();

/// A GL 4.5 core context that needs no surface and shares nothing, current on this thread; or why there is none.
struct EglContext {
    void* context = nullptr;
    std::string reason;
};
EglContext makeEglContext(void* display, bool debug);

} // namespace tessera::vis
