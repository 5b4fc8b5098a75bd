#include "vis/gl/driver.h"

#include <algorithm>
#include <array>
#include <epoxy/gl.h>

namespace tessera::vis {

namespace {

std::string glText(GLenum name) {
    const GLubyte* found = glGetString(name);
    return found ? reinterpret_cast<const char*>(found) : "";
}

int glNumber(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

} // namespace

bool isSoftware(std::string_view renderer) {
    static constexpr std::array<std::string_view, 5> kSoftware{"llvmpipe", "softpipe", "swrast", "SwiftShader",
                                                               "lavapipe"};
    return std::ranges::any_of(kSoftware,
                               [&](std::string_view name) { return renderer.find(name) != std::string_view::npos; });
}

Driver currentDriver() {
    Driver driver;
    driver.renderer = glText(GL_RENDERER);
    driver.software = isSoftware(driver.renderer);
    driver.fragmentSamplers = glNumber(GL_MAX_TEXTURE_IMAGE_UNITS);
    driver.texture3DEdge = glNumber(GL_MAX_3D_TEXTURE_SIZE);
    if (driver.software) {
        constexpr int kTile = 64; // tile size of llvmpipe in pixels
        driver.compilesAtFirstDraw = true;
        driver.exactFilter = true;
        driver.sharedTile = kTile;
        driver.textureBytes = std::size_t(1) << 30; // Mesa's software GL refuses larger textures
        return driver;
    }
    GLint bits = 0;
    glGetQueryiv(GL_TIME_ELAPSED, GL_QUERY_COUNTER_BITS, &bits);
    driver.timerQueries = bits > 0;
    return driver;
}

void addDriver(ProgramRecipe& recipe, const Driver& driver) {
    if (!driver.exactFilter) recipe.defines.emplace_back("FILTER_IN_SHADER", "1");
}

} // namespace tessera::vis
