#include "vis/gl/pixel_reader.h"

namespace tessera::vis {

void PixelReader::resize(std::size_t floats) {
    bytes_ = floats * sizeof(float);
    buffer_ = makeBuffer(GLsizeiptr(bytes_), nullptr, GL_MAP_READ_BIT | GL_CLIENT_STORAGE_BIT, "texels read back");
    fence_.reset();
}

void PixelReader::start(GLuint texture, glm::ivec2 size, GLenum format) {
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer_.name());
    glGetTextureSubImage(texture, 0, 0, 0, 0, size.x, size.y, 1, format, GL_FLOAT, GLsizei(bytes_), nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    fence_.reset(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
}

bool PixelReader::take(std::span<float> into, bool wait) {
    constexpr GLuint64 kSecond = 1'000'000'000;
    if (!fence_) return false;
    GLenum state = glClientWaitSync(fence_.get(), GL_SYNC_FLUSH_COMMANDS_BIT, 0);
    while (wait && state == GL_TIMEOUT_EXPIRED) state = glClientWaitSync(fence_.get(), 0, kSecond);
    if (state == GL_TIMEOUT_EXPIRED) return false;
    fence_.reset();
    glGetNamedBufferSubData(buffer_.name(), 0, GLsizeiptr(into.size_bytes()), into.data());
    return true;
}

} // namespace tessera::vis
