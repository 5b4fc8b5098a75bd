#include "app/platform/gui.h"

#include "app/pane/view_parts.h"
#include "app/ui/keys.h"

#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>
#include <string_view>

namespace tessera::app {

namespace {

constexpr const char* kInMemory = "memory"; ///< name of the back end without OpenGL

} // namespace

Gui::Gui(vis::TexturesIn where) {
    IMGUI_CHECKVERSION();
    former_ = ImGui::GetCurrentContext();
    context_ = ImGui::CreateContext();
    ImGui::SetCurrentContext(context_);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr; // the session stores the arrangement
    io.LogFilename = nullptr;
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    setUpKeys(io);
    if (where == vis::TexturesIn::OpenGl) {
        ImGui_ImplOpenGL3_Init("#version 450 core");
        return;
    }
    io.BackendRendererName = kInMemory;
    io.BackendRendererUserData = &letters_;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    uploadFonts();
}

Gui::~Gui() {
    ImGui::SetCurrentContext(context_);
    if (textures() == vis::TexturesIn::OpenGl)
        ImGui_ImplOpenGL3_Shutdown();
    else
        ImGui::GetIO().BackendRendererUserData = nullptr; // else newer versions miss the end of a back end
    ImGui::DestroyContext(context_);
    ImGui::SetCurrentContext(former_);
}

vis::TexturesIn Gui::textures() {
    const char* name = ImGui::GetIO().BackendRendererName;
    return name && std::string_view(name) == kInMemory ? vis::TexturesIn::Memory : vis::TexturesIn::OpenGl;
}

void Gui::newFrame() {
    if (textures() == vis::TexturesIn::OpenGl) ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
}

void Gui::uploadFonts() {
    const ImGuiIO& io = ImGui::GetIO();
    if (textures() == vis::TexturesIn::Memory) {
        auto& letters = *static_cast<vis::MemoryTexture*>(io.BackendRendererUserData);
        unsigned char* pixels = nullptr;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &letters.size.x, &letters.size.y);
        letters.rgba.assign(pixels, pixels + std::ptrdiff_t(letters.size.x) * letters.size.y * 4);
        io.Fonts->SetTexID(textureId(letters.name()));
        return;
    }
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
    draw(*ImGui::GetDrawData());
}

void Gui::draw(ImDrawData& data) {
    // The back end binds the program again that was bound. One that has been deleted lasts until then only.
    glUseProgram(0);
    ImGui_ImplOpenGL3_RenderDrawData(&data);
}

glm::vec3 windowGround(Theme theme) {
    return glm::vec3(theme == Theme::Dark ? 0.075f : 0.87f);
}

} // namespace tessera::app
