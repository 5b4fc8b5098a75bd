#pragma once

#include "tests/vis/gl_fixture.h"
#include "vis/gl/handles.h"
#include "vis/gl/program.h"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <unistd.h>

namespace tessera::test {

/// Evaluates GLSL expressions for 64 random inputs, to compare them with their C++ twins.
class ShaderProbe : public GlTest {
protected:
    static constexpr int kCases = 64;

    ShaderProbe() {
        std::mt19937 random(7);
        std::uniform_real_distribution<float> number(-1, 1);
        for (auto* list : {&a, &b, &c})
            for (glm::vec4& v : *list) v = {number(random), number(random), number(random), number(random)};
    }

    /// Evaluates an expression of a[i], b[i], c[i] (vec4) for every i. `recipe` may bring slots and defines, `prepare`
    /// sets uniforms and textures of the program.
    std::array<glm::vec4, kCases> evaluate(const std::string& includes, const std::string& expression,
                                           vis::ProgramRecipe recipe = {},
                                           const std::function<void(const vis::Program&)>& prepare = {}) {
        const std::filesystem::path folder =
            std::filesystem::path(TESSERA_BINARY_DIR) / ("shader-probe-" + std::to_string(getpid()));
        std::filesystem::create_directories(folder);
        std::ofstream(folder / "probe.frag.glsl")
            << includes << "uniform vec4 a[64], b[64], c[64];\nout vec4 result;\n"
            << "void main() { int i = int(gl_FragCoord.x); result = " << expression << "; }\n";
        setenv("TESSERA_SHADER_DIR", folder.c_str(), 1);
        recipe.vertex = "screen.vert.glsl";
        recipe.fragment = "probe.frag.glsl";
        const vis::Program program = vis::makeProgram(recipe);
        unsetenv("TESSERA_SHADER_DIR");
        std::filesystem::remove_all(folder);
        program.set("a", std::span<const glm::vec4>(a));
        program.set("b", std::span<const glm::vec4>(b));
        program.set("c", std::span<const glm::vec4>(c));
        if (prepare) prepare(program);
        const vis::Texture texture = vis::makeTexture2D({kCases, 1}, GL_RGBA32F, GL_NEAREST, "probe");
        const vis::Framebuffer framebuffer = vis::makeFramebuffer({texture.name()}, "probe");
        const vis::VertexArray vertices = vis::makeVertexArray("probe");
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
        glViewport(0, 0, kCases, 1);
        glUseProgram(program.name());
        glBindVertexArray(vertices.name());
        glDrawArrays(GL_TRIANGLES, 0, 3);
        std::array<glm::vec4, kCases> out;
        glGetTextureImage(texture.name(), 0, GL_RGBA, GL_FLOAT, sizeof out, out.data());
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        return out;
    }

    std::array<glm::vec4, kCases> a, b, c;
};

} // namespace tessera::test
