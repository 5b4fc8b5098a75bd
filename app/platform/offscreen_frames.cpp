#include "app/platform/drawn_page.h"
#include "app/platform/frame_pixels.h"
#include "app/platform/gui.h"
#include "app/workbench/workbench.h"
#include "volume/base/error.h"

#include <algorithm>
#include <epoxy/gl.h>
#include <imgui.h>
#include <iterator>
#include <thread>
#include <utility>

namespace tessera::app {

namespace {

/// Colours as they were before they were blended onto nothing, which multiplies them by their opacity.
void divideByOpacity(vis::Image& image) {
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        const int opacity = image.rgba[i + 3];
        for (std::size_t c = i; opacity > 0 && opacity < 255 && c < i + 3; ++c)
            image.rgba[c] = static_cast<std::uint8_t>(std::min(255, (image.rgba[c] * 255 + opacity / 2) / opacity));
    }
}

} // namespace

struct OffscreenFrames::Impl {
    glm::ivec2 size;
    bool smooth;
    std::unique_ptr<FramePixels> pixels;
    Theme theme = Theme::Dark; ///< of the last frame
    bool shown = false;        ///< `pixels` show it

    void show() {
        if (!std::exchange(shown, true)) pixels->show(theme);
    }
    /// Draws some triangles of the last frame on nothing.
    vis::Image drawParts(const std::vector<DrawnPart>& parts, glm::ivec2 lo, glm::ivec2 hi) {
        shown = false;
        pixels->showParts(parts);
        vis::Image image = pixels->read(lo, hi);
        divideByOpacity(image);
        return image;
    }
};

OffscreenFrames::OffscreenFrames(glm::ivec2 size, bool smooth)
    : impl_(new Impl{size, smooth, makeFramePixels(Gui::textures(), size)}) {}
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
    Gui::newFrame();
    workbench.frame();
    ImGui::Render();
    impl_->theme = workbench.session().appearance.theme;
    impl_->shown = false;
    impl_->pixels->rehearse(impl_->theme);
}

vis::Image OffscreenFrames::read() const {
    impl_->show();
    vis::Image image = impl_->pixels->read({0, 0}, impl_->size);
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
    if (Gui::textures() == vis::TexturesIn::OpenGl) glFinish();
}

void drawUntilDone(OffscreenFrames& target, Workbench& workbench, float scale) {
    // Several quiet frames in a row: sizes that ImGui learns in one frame are right in the next.
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

vis::Image drawUntilDone(Workbench& workbench, glm::ivec2 size, float scale) {
    OffscreenFrames target(size);
    drawUntilDone(target, workbench, scale);
    return target.read();
}

} // namespace tessera::app
