#include "vis/demand/termination_reader.h"

namespace tessera::vis {

void TerminationReader::resize(glm::ivec2 size) {
    const glm::ivec2 tiles = TerminationMap{{}, {}, size, {}}.tiles();
    Texture made = makeTexture2D(tiles, GL_R32F, GL_NEAREST, "ray ends");
    framebuffer_ = makeFramebuffer({made.name()}, "ray ends");
    tiles_ = std::move(made);
    reader_.resize(std::size_t(tiles.x) * std::size_t(tiles.y));
}

void TerminationReader::start(const Program& program, GLuint vertices, GLuint termination, glm::ivec2 first,
                              glm::ivec2 size, const Camera& camera, const WorldFrame& frame) {
    map_ = {camera, frame, size, {}};
    const glm::ivec2 tiles = map_.tiles();
    program.set("termination", 0);
    program.set("first", glm::vec2(first));
    program.set("size", glm::vec2(size));
    glBindTextureUnit(0, termination);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, tiles.x, tiles.y);
    glUseProgram(program.name());
    glBindVertexArray(vertices);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    reader_.start(tiles_.name(), tiles, GL_RED);
    map_.farthest.resize(std::size_t(tiles.x) * std::size_t(tiles.y));
}

std::optional<TerminationMap> TerminationReader::take(bool wait) {
    if (!reader_.take(map_.farthest, wait)) return std::nullopt;
    return std::move(map_);
}

} // namespace tessera::vis
