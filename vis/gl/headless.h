#pragma once

#include <memory>
#include <string>
#include <vector>

namespace tessera::vis {

/// An off-screen GL 4.5 core context (EGL without a surface; works with Mesa's software GL and GPU drivers), current on
/// the creating thread until destroyed. Throws MachineError with the attempts made if none is available.
class HeadlessContext {
public:
    explicit HeadlessContext(bool debug = false);
    ~HeadlessContext();
    HeadlessContext(const HeadlessContext&) = delete;
    HeadlessContext& operator=(const HeadlessContext&) = delete;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

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
