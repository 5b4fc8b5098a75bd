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

/// Mesa, the OpenGL of most Linux systems, keeps compiled shaders in the user's cache folder. It writes the list of
/// them through memory, so that a full disk ends the program by a signal. Reserves the room of that list; where there
/// is none, switches the cache off for this process, by the environment. To be called before OpenGL starts, while no
/// other thread reads the environment, and again once there is a context, when Mesa has made the list.
void guardShaderCache();

} // namespace tessera::vis
