#include "vis/demand/reach_reader.h"

namespace tessera::vis {

void ReachReader::resize(glm::ivec2 size) {
    const glm::ivec2 tiles = ReachMap{{}, {}, size, {}}.tiles();
    Texture made = makeTexture2D(tiles, GL_R32F, GL_NEAREST, "ray ends");
    framebuffer_ = makeFramebuffer({made.name()}, "ray ends");
    tiles_ = std::move(made);
    read_ = makeBuffer(GLsizeiptr(sizeof(float)) * tiles.x * tiles.y, nullptr, GL_MAP_READ_BIT | GL_CLIENT_STORAGE_BIT,
                       "ray ends");
    fence_.reset();
}

void ReachReader::start(const Program& program, GLuint vertices, GLuint reach, glm::ivec2 first, glm::ivec2 size,
                        const Camera& camera, const WorldFrame& frame) {
    map_ = {camera, frame, size, {}};
    const glm::ivec2 tiles = map_.tiles();
    program.set("reach", 0);
    program.set("first", glm::vec2(first));
    program.set("size", glm::vec2(size));
    glBindTextureUnit(0, reach);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, tiles.x, tiles.y);
    glUseProgram(program.name());
    glBindVertexArray(vertices);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, read_.name());
    glGetTextureSubImage(tiles_.name(), 0, 0, 0, 0, tiles.x, tiles.y, 1, GL_RED, GL_FLOAT,
                         GLsizei(sizeof(float)) * tiles.x * tiles.y, nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    fence_.reset(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
}

std::optional<ReachMap> ReachReader::take(bool wait) {
    constexpr GLuint64 kSecond = 1'000'000'000;
    if (!fence_) return std::nullopt;
    GLenum state = glClientWaitSync(fence_.get(), GL_SYNC_FLUSH_COMMANDS_BIT, 0);
    while (wait && state == GL_TIMEOUT_EXPIRED) state = glClientWaitSync(fence_.get(), 0, kSecond);
    if (state == GL_TIMEOUT_EXPIRED) return std::nullopt;
    fence_.reset();
    const glm::ivec2 tiles = map_.tiles();
    map_.farthest.resize(std::size_t(tiles.x) * std::size_t(tiles.y));
    glGetNamedBufferSubData(read_.name(), 0, GLsizeiptr(map_.farthest.size() * sizeof(float)), map_.farthest.data());
    return std::move(map_);
}

} // namespace tessera::vis
