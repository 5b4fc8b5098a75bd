#include "app/platform/gui.h"

#include "app/platform/drawn_page.h"
#include "app/ui/keys.h"
#include "app/workbench/workbench.h"
#include "volume/base/error.h"

#include <algorithm>
#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>
#include <iterator>
#include <thread>
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

/// Colours as they were before they were blended onto nothing, which multiplies them by their opacity.
void divideByOpacity(vis::Image& image) {
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        const int opacity = image.rgba[i + 3];
        for (std::size_t c = i; opacity > 0 && opacity < 255 && c < i + 3; ++c)
            image.rgba[c] = static_cast<std::uint8_t>(std::min(255, (image.rgba[c] * 255 + opacity / 2) / opacity));
    }
}

} // namespace

Gui::Gui() {
    IMGUI_CHECKVERSION();
    former_ = ImGui::GetCurrentContext();
    context_ = ImGui::CreateContext();
    ImGui::SetCurrentContext(context_);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr; // the session stores the arrangement
    io.LogFilename = nullptr;
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    setUpKeys(io);
    ImGui_ImplOpenGL3_Init("#version 450 core");
}

Gui::~Gui() {
    ImGui::SetCurrentContext(context_);
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext(context_);
    ImGui::SetCurrentContext(former_);
}

void Gui::uploadFonts() {
#if IMGUI_VERSION_NUM < 19200 // newer back ends update the texture themselves
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
#endif
}

void Gui::draw(glm::ivec2 framebuffer, Theme theme) {
    glViewport(0, 0, framebuffer.x, framebuffer.y);
    glDisable(GL_SCISSOR_TEST);
    const glm::vec3 ground = windowGround(theme);
    glClearColor(ground.r, ground.g, ground.b, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

glm::vec3 windowGround(Theme theme) {
    return glm::vec3(theme == Theme::Dark ? 0.075f : 0.87f);
}

struct OffscreenFrames::Impl {
    glm::ivec2 size;
    Framebuffer target;
    bool smooth;
    Framebuffer speck{{1, 1}}; ///< what frames are drawn into that nobody looks at: the same calls, next to no pixels
    Theme theme = Theme::Dark; ///< of the last frame
    bool shown = false;        ///< `target` shows it

    void show() {
        if (std::exchange(shown, true)) return;
        target.bind();
        Gui::draw(size, theme);
    }

    /// Draws some triangles of the last frame on nothing.
    vis::Image drawParts(const std::vector<DrawnPart>& parts, glm::ivec2 lo, glm::ivec2 hi) {
        ImDrawData& frame = *ImGui::GetDrawData();
        std::vector<ImVector<ImDrawCmd>> all(static_cast<std::size_t>(frame.CmdListsCount));
        for (int n = 0; n < frame.CmdListsCount; ++n) all[std::size_t(n)].swap(frame.CmdLists[n]->CmdBuffer);
        for (const DrawnPart& part : parts) part.list->CmdBuffer.push_back(part.command);
        shown = false;
        target.bind();
        glViewport(0, 0, size.x, size.y);
        glDisable(GL_SCISSOR_TEST);
        glClearColor(0, 0, 0, 0);
        glClear(GL_COLOR_BUFFER_BIT);
        ImGui_ImplOpenGL3_RenderDrawData(&frame);
        for (int n = 0; n < frame.CmdListsCount; ++n) all[std::size_t(n)].swap(frame.CmdLists[n]->CmdBuffer);
        vis::Image image = readPixels(lo, hi, size.y);
        divideByOpacity(image);
        return image;
    }
};

OffscreenFrames::OffscreenFrames(glm::ivec2 size, bool smooth) : impl_(new Impl{size, Framebuffer(size), smooth}) {}
OffscreenFrames::~OffscreenFrames() = default;

void OffscreenFrames::draw(Workbench& workbench, float scale, const std::function<void(ImGuiIO&)>& input) {
    if (workbench.prepare(scale)) Gui::uploadFonts();
    ImGui::GetStyle().AntiAliasedLines = ImGui::GetStyle().AntiAliasedFill = impl_->smooth;
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {static_cast<float>(impl_->size.x), static_cast<float>(impl_->size.y)};
    io.DeltaTime = 1.0f / 60;
    io.MousePos = {-FLT_MAX, -FLT_MAX};
    std::fill(std::begin(io.MouseDown), std::end(io.MouseDown), false);
    if (input) input(io);
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
    workbench.frame();
    ImGui::Render();
    impl_->theme = workbench.session().appearance.theme;
    impl_->shown = false;
    impl_->speck.bind();
    Gui::draw(impl_->size, impl_->theme);
}

vis::Image OffscreenFrames::read() const {
    impl_->show();
    impl_->target.bind();
    vis::Image image = readPixels({0, 0}, impl_->size, impl_->size.y);
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
    return image;
}

VectorPage OffscreenFrames::page(const Workbench& workbench, double points) const {
    const auto drawn = [&](const std::vector<DrawnPart>& parts, glm::ivec2 lo, glm::ivec2 hi) {
        return impl_->drawParts(parts, lo, hi);
    };
    VectorPage page = pageOf(*ImGui::GetDrawData(), workbench.look().fonts(), points, drawn);
    const glm::vec4 ground(windowGround(workbench.session().appearance.theme), 1);
    page.marks.insert(page.marks.begin(), {shapes::Rect{.box = {{0, 0}, page.size}, .color = ground}});
    return page;
}

void OffscreenFrames::show() {
    impl_->show();
}

void OffscreenFrames::finish() {
    glFinish();
}

namespace {

void drawUntilQuiet(OffscreenFrames& target, Workbench& workbench, float scale) {
    // Two quiet frames in a row: sizes that ImGui learns in one frame are right in the next.
    int quiet = 0;
    for (int frames = 0; quiet < 3; ++frames) {
        target.draw(workbench, scale);
        if (workbench.busy()) {
            quiet = 0;
            if (!workbench.jobs().list().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
        } else {
            ++quiet;
        }
        if (frames > 100000) throw MachineError("the picture was not completed");
    }
}

} // namespace

vis::Image drawUntilDone(Workbench& workbench, glm::ivec2 size, float scale) {
    OffscreenFrames target(size);
    drawUntilQuiet(target, workbench, scale);
    return target.read();
}

VectorPage drawPageUntilDone(Workbench& workbench, glm::ivec2 size, float scale, double points) {
    OffscreenFrames target(size, false);
    drawUntilQuiet(target, workbench, scale);
    return target.page(workbench, points);
}

} // namespace tessera::app
