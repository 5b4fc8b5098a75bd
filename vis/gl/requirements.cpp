#include "vis/gl/requirements.h"

#include <epoxy/gl.h>

namespace tessera::vis {

namespace {

/// A feature used by the renderer, and the core OpenGL version that introduced it.
struct Feature {
    int version; ///< 10 * major + minor
    const char *extension, *name;
};
constexpr Feature kFeatures[] = {{41, "GL_ARB_separate_shader_objects", "uniforms of a program that is not bound"},
                                 {42, "GL_ARB_texture_storage", "immutable textures"},
                                 {42, "GL_ARB_shading_language_420pack", "GLSL 4.20"},
                                 {43, "GL_ARB_copy_image", "copies between textures"},
                                 {45, "GL_ARB_direct_state_access", "direct state access"}};

} // namespace

std::string missingFeatures() {
    const int version = epoxy_gl_version();
    if (version >= 45) return {};
    std::string text = "the driver offers OpenGL " + std::to_string(version / 10) + '.' + std::to_string(version % 10) +
                       ", 4.5 is needed; it lacks";
    bool first = true;
    for (const Feature& feature : kFeatures) {
        if (version >= feature.version || epoxy_has_gl_extension(feature.extension)) continue;
        text += (first ? " " : ", ") + std::string(feature.name);
        first = false;
    }
    return first ? text + " GLSL 4.50" : text;
}

} // namespace tessera::vis
