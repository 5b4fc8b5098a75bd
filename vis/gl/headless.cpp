#include "vis/gl/headless.h"

#include "vis/gl/requirements.h"
#include "volume/base/error.h"

#include <cerrno>
#include <cstdlib>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fcntl.h>
#include <filesystem>
#include <string_view>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

namespace tessera::vis {

namespace {

bool has(const char* list, std::string_view name) {
    return list && (" " + std::string(list) + " ").find(" " + std::string(name) + " ") != std::string::npos;
}

/// Explains what a driver without GL 4.5 lacks, from the best context it offers.
std::string whyNot(EGLDisplay display, EGLConfig config) {
    const EGLint any[] = {EGL_NONE};
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, any);
    if (context == EGL_NO_CONTEXT) return {};
    std::string text;
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) text = ": " + missingFeatures();
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
    return text;
}

} // namespace

// Avoids eglGetPlatformDisplay, on which libepoxy 1.5 aborts if only EGL 1.4 is advertised.
std::vector<EglDisplay> eglDisplays() {
    std::vector<EglDisplay> hardware, software;
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (has(client, "EGL_EXT_platform_device") &&
        (has(client, "EGL_EXT_device_enumeration") || has(client, "EGL_EXT_device_base"))) {
        EGLDeviceEXT devices[16];
        EGLint count = 0;
        if (eglQueryDevicesEXT(16, devices, &count))
            for (EGLint i = 0; i < count; ++i) {
                const char* extensions = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
                auto& list = has(extensions, "EGL_MESA_device_software") ? software : hardware;
                list.push_back({"device " + std::to_string(i),
                                eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr)});
            }
    }
    std::vector<EglDisplay> all = hardware;
    if (has(client, "EGL_MESA_platform_surfaceless"))
        all.push_back(
            {"surfaceless", eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)});
    all.insert(all.end(), software.begin(), software.end());
    all.push_back({"default display", eglGetDisplay(EGL_DEFAULT_DISPLAY)});
    return all;
}

EglContext makeEglContext(void* display, bool debug) {
    if (display == EGL_NO_DISPLAY) return {nullptr, "no display"};
    if (!eglInitialize(display, nullptr, nullptr)) return {nullptr, "cannot be initialised"};
    const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
    if (!has(extensions, "EGL_KHR_surfaceless_context")) return {nullptr, "no contexts without a surface"};
    if (!eglBindAPI(EGL_OPENGL_API)) return {nullptr, "no OpenGL"};
    EGLConfig config = EGL_NO_CONFIG_KHR;
    if (!has(extensions, "EGL_KHR_no_config_context")) {
        const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
        EGLint count = 0;
        if (!eglChooseConfig(display, wanted, &config, 1, &count) || count == 0) return {nullptr, "no configuration"};
    }
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 4,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 5,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_CONTEXT_OPENGL_DEBUG,
                                 debug ? EGL_TRUE : EGL_FALSE,
                                 EGL_NONE};
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
    if (context == EGL_NO_CONTEXT) return {nullptr, "no OpenGL 4.5 core" + whyNot(display, config)};
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) return {context, {}};
    eglDestroyContext(display, context);
    return {nullptr, "the context cannot be made current"};
}

struct HeadlessContext::Impl {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    ~Impl() {
        if (context == EGL_NO_CONTEXT) return;
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display, context);
        // The display is shared by all contexts of the process, so it is never terminated.
    }
};

HeadlessContext::HeadlessContext(bool debug) : impl_(std::make_unique<Impl>()) {
    guardShaderCache();
    if (!epoxy_has_egl()) throw MachineError("the library EGL is not installed");
    std::string tried;
    for (const EglDisplay& each : eglDisplays()) {
        const EglContext made = makeEglContext(each.display, debug);
        if (made.context != EGL_NO_CONTEXT) {
            impl_->display = each.display;
            impl_->context = made.context;
            if (debug) glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
            guardShaderCache();
            return;
        }
        tried += (tried.empty() ? "" : "; ") + each.name + ": " + made.reason;
    }
    throw MachineError("no OpenGL 4.5 context through EGL (tried " + tried + ")");
}

HeadlessContext::~HeadlessContext() = default;

namespace {

namespace fs = std::filesystem;

/// Bytes that must be free where the list has not been made: its own 1.3 MB and the first shaders.
constexpr off_t kRoom = off_t(4) << 20;

/// The folder of Mesa's cache; "" where there is none.
fs::path cacheFolder() {
    constexpr const char* kName = "mesa_shader_cache";
    const auto stated = [](const char* variable) {
        const char* const value = std::getenv(variable);
        return fs::path(value ? value : "");
    };
    for (const char* const variable : {"MESA_SHADER_CACHE_DIR", "MESA_GLSL_CACHE_DIR", "XDG_CACHE_HOME"})
        if (const fs::path folder = stated(variable); !folder.empty()) return folder / kName;
    const fs::path home = stated("HOME");
    return home.empty() ? fs::path() : home / ".cache" / kName;
}

/// Reserves the first bytes of an open file. File systems that cannot are asked for the room they have.
bool reserve(int file, off_t bytes) {
    int failed = 0;
    while ((failed = ::fallocate(file, 0, 0, bytes) == 0 ? 0 : errno) == EINTR) {
    }
    if (failed == 0) return true;
    if (failed != EOPNOTSUPP && failed != ENOSYS) return false;
    struct statvfs room {};
    return ::fstatvfs(file, &room) != 0 || off_t(room.f_bavail) * off_t(room.f_frsize) >= kRoom;
}

bool hasRoom(const fs::path& folder) {
    if (const int index = ::open((folder / "index").c_str(), O_RDWR | O_CLOEXEC); index >= 0) {
        struct stat state {};
        const bool reserved = ::fstat(index, &state) != 0 || state.st_size == 0 || reserve(index, state.st_size);
        ::close(index);
        return reserved;
    }
    fs::path made = folder; // the part of the path that there is
    std::error_code problem;
    while (!fs::is_directory(made, problem) && made.has_parent_path() && made != made.parent_path())
        made = made.parent_path();
    const int probe = ::open(made.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (probe < 0) {
        struct statvfs room {};
        return ::statvfs(made.c_str(), &room) != 0 || off_t(room.f_bavail) * off_t(room.f_frsize) >= kRoom;
    }
    const bool reserved = reserve(probe, kRoom);
    ::close(probe);
    return reserved;
}

} // namespace

void guardShaderCache() {
    const fs::path folder = cacheFolder();
    if (folder.empty() || hasRoom(folder)) return;
    for (const char* const variable : {"MESA_SHADER_CACHE_DISABLE", "MESA_GLSL_CACHE_DISABLE"}) // newer, older
        ::setenv(variable, "true", 1);
}

} // namespace tessera::vis
