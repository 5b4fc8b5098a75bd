#include "app/platform/frame_pixels.h"

#include "app/platform/drawn_pixels.h"
#include "app/platform/gui.h"
#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <epoxy/gl.h>
#include <glm/common.hpp>
#include <glm/ext/vector_uint4_sized.hpp>
#include <glm/vec4.hpp>
#include <utility>

namespace tessera::app {

namespace {

/// A colour buffer of a given size, bound while it lives.
class Framebuffer {
public:
    explicit Framebuffer(glm::ivec2 size) {
        GLint largest = 0;
        glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
        if (size.x < 1 || size.y < 1 || size.x > largest || size.y > largest)
            throw MachineError("a picture of " + std::to_string(size.x) + "x" + std::to_string(size.y) +
                               " is too large; this machine can draw up to " + std::to_string(largest));
        glGetIntegerv(GL_FRAMEBUFFER_BINDING, &former_);
        glCreateRenderbuffers(1, &color_);
        glNamedRenderbufferStorage(color_, GL_RGBA8, size.x, size.y);
        glCreateFramebuffers(1, &name_);
        glNamedFramebufferRenderbuffer(name_, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color_);
        if (glCheckNamedFramebufferStatus(name_, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
            throw MachineError("OpenGL cannot draw into a framebuffer of this size");
    }
    ~Framebuffer() {
        glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(former_));
        glDeleteFramebuffers(1, &name_);
        glDeleteRenderbuffers(1, &color_);
    }
    Framebuffer(const Framebuffer&) = delete;
    Framebuffer& operator=(const Framebuffer&) = delete;
    void bind() const { glBindFramebuffer(GL_FRAMEBUFFER, name_); }

private:
    GLuint name_ = 0, color_ = 0;
    GLint former_ = 0;
};

/// The pixels from `lo` to before `hi`, counted from the top, of the bound framebuffer, which is `height` high.
vis::Image readPixels(glm::ivec2 lo, glm::ivec2 hi, int height) {
    const glm::ivec2 size = hi - lo;
    vis::Image image;
    image.size = size;
    const std::size_t row = static_cast<std::size_t>(size.x) * 4;
    std::vector<std::uint8_t> upside(row * static_cast<std::size_t>(size.y));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(lo.x, height - hi.y, size.x, size.y, GL_RGBA, GL_UNSIGNED_BYTE, upside.data());
    image.rgba.resize(upside.size());
    for (std::size_t y = 0; y < static_cast<std::size_t>(size.y); ++y) {
        const auto from =
            upside.begin() + static_cast<std::ptrdiff_t>((static_cast<std::size_t>(size.y) - 1 - y) * row);
        std::copy(from, from + static_cast<std::ptrdiff_t>(row),
                  image.rgba.begin() + static_cast<std::ptrdiff_t>(y * row));
    }
    return image;
}

class GlFramePixels : public FramePixels {
public:
    explicit GlFramePixels(glm::ivec2 size) : size_(size), target_(size) {}

    void rehearse(Theme theme) override {
        speck_.bind();
        Gui::draw(size_, theme);
    }
    void show(Theme theme) override {
        target_.bind();
        Gui::draw(size_, theme);
    }
    void showParts(const std::vector<DrawnPart>& parts) override {
        ImDrawData& frame = *ImGui::GetDrawData();
        std::vector<ImVector<ImDrawCmd>> all(static_cast<std::size_t>(frame.CmdListsCount));
        for (int n = 0; n < frame.CmdListsCount; ++n) all[std::size_t(n)].swap(frame.CmdLists[n]->CmdBuffer);
        for (const DrawnPart& part : parts) part.list->CmdBuffer.push_back(part.command);
        target_.bind();
        glViewport(0, 0, size_.x, size_.y);
        glDisable(GL_SCISSOR_TEST);
        glClearColor(0, 0, 0, 0);
        glClear(GL_COLOR_BUFFER_BIT);
        Gui::draw(frame);
        for (int n = 0; n < frame.CmdListsCount; ++n) all[std::size_t(n)].swap(frame.CmdLists[n]->CmdBuffer);
    }
    vis::Image read(glm::ivec2 lo, glm::ivec2 hi) const override {
        target_.bind();
        return readPixels(lo, hi, size_.y);
    }

private:
    glm::ivec2 size_;
    Framebuffer target_;
    Framebuffer speck_{{1, 1}}; ///< what frames are drawn into that nobody looks at: the same calls, next to no pixels
};

class MemoryFramePixels : public FramePixels {
public:
    explicit MemoryFramePixels(glm::ivec2 size) {
        image_.size = size;
        image_.rgba.resize(std::size_t(size.x) * std::size_t(size.y) * 4);
    }

    void rehearse(Theme) override {}
    void show(Theme theme) override {
        const ImDrawData& frame = *ImGui::GetDrawData();
        const glm::u8vec4 ground(glm::vec4(windowGround(theme), 1) * 255.0f + 0.5f);
        for (std::size_t i = 0; i < image_.rgba.size(); ++i) image_.rgba[i] = ground[int(i % 4)];
        for (int n = 0; n < frame.CmdListsCount; ++n)
            for (const ImDrawCmd& command : frame.CmdLists[n]->CmdBuffer)
                if (!command.UserCallback) drawPixels(*frame.CmdLists[n], command, {0, 0}, image_);
    }
    void showParts(const std::vector<DrawnPart>& parts) override {
        std::ranges::fill(image_.rgba, std::uint8_t(0));
        for (const DrawnPart& part : parts) drawPixels(*part.list, part.command, {0, 0}, image_);
    }
    vis::Image read(glm::ivec2 lo, glm::ivec2 hi) const override {
        vis::Image out;
        out.size = hi - lo;
        for (int y = lo.y; y < hi.y; ++y) {
            const auto row = image_.rgba.begin() + (std::ptrdiff_t(y) * image_.size.x + lo.x) * 4;
            out.rgba.insert(out.rgba.end(), row, row + std::ptrdiff_t(out.size.x) * 4);
        }
        return out;
    }

private:
    vis::Image image_;
};

} // namespace

std::unique_ptr<FramePixels> makeFramePixels(vis::TexturesIn where, glm::ivec2 size) {
    if (where == vis::TexturesIn::OpenGl) return std::make_unique<GlFramePixels>(size);
    return std::make_unique<MemoryFramePixels>(size);
}

} // namespace tessera::app
