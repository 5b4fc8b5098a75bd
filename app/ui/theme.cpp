#include "app/ui/theme.h"

#include "app/drawing/typeface.h"

#include <cmath>

namespace tessera::app {

namespace {

constexpr float kTextSize = 15; // from the highest ascender to the lowest descender

ImVec4 rgb(unsigned hex, float alpha = 1) {
    return {float(hex >> 16 & 255) / 255, float(hex >> 8 & 255) / 255, float(hex & 255) / 255, alpha};
}

ImU32 pack(const ImVec4& color) {
    return ImGui::ColorConvertFloat4ToU32(color);
}

} // namespace

float scaleForText(double emPixels) {
    return static_cast<float>(emPixels * typeface(Face::Text).line / double(kTextSize));
}

double textPixels(float scale) {
    return double(scale * kTextSize) / typeface(Face::Text).line;
}

Fonts loadFonts(float scale) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    atlas.Clear();
    // Latin, Greek, sub- and superscripts, minus, arrows and the signs units are made of.
    static const ImWchar letters[] = {0x20,   0xFF,   0x100,  0x17F,  0x370,  0x3FF,  0x2010, 0x2027, 0x2030,
                                      0x205E, 0x2070, 0x209F, 0x2126, 0x2126, 0x2190, 0x2193, 0x2202, 0x2207,
                                      0x2212, 0x221E, 0x2248, 0x2265, 0x25A0, 0x25FF, 0};
    static const ImWchar icons[] = {0xF000, 0xF2E0, 0};
    const float size = std::round(kTextSize * scale);
    Fonts fonts;
    const char* text = typeface(Face::Text).file;
    const char* bold = typeface(Face::Bold).file;
    const char* symbol = typeface(Face::Icons).file;
    const auto add = [&](const char* path) {
        ImFontConfig config;
        config.OversampleH = scale < 1.5f ? 3 : 2;
        config.OversampleV = 1;
        config.PixelSnapH = false;
        config.RasterizerMultiply = 1.08f;
        ImFont* font = nullptr;
        if (path) {
            font = atlas.AddFontFromFileTTF(path, size, &config, letters);
        } else {
            config.SizePixels = std::round(13 * scale);
            font = atlas.AddFontDefault(&config);
        }
        if (symbol) {
            ImFontConfig merge;
            merge.MergeMode = true;
            merge.GlyphMinAdvanceX = std::round(size * 1.1f);
            merge.GlyphOffset = {0, std::round(scale)};
            merge.OversampleH = 2;
            atlas.AddFontFromFileTTF(symbol, std::round(size * 0.92f), &merge, icons);
        }
        return font;
    };
    fonts.text = add(text);
    fonts.bold = bold ? add(bold) : fonts.text;
    if (symbol) fonts.icons = fonts.text;
    atlas.Build();
    return fonts;
}

namespace {

ImGuiStyle styleSizes(bool dark, float scale) {
    ImGuiStyle style;
    style.WindowPadding = {10, 8};
    style.FramePadding = {8, 4};
    style.ItemSpacing = {8, 6};
    style.ItemInnerSpacing = {6, 4};
    style.CellPadding = {6, 3};
    style.IndentSpacing = 16;
    style.ScrollbarSize = 11;
    style.GrabMinSize = 10;
    style.WindowRounding = 6;
    style.ChildRounding = 4;
    style.FrameRounding = 4;
    style.PopupRounding = 6;
    style.ScrollbarRounding = 6;
    style.GrabRounding = 4;
    style.TabRounding = 4;
    style.WindowBorderSize = 1;
    style.FrameBorderSize = dark ? 0.0f : 1.0f;
    style.PopupBorderSize = 1;
    style.WindowTitleAlign = {0.02f, 0.5f};
    style.WindowMenuButtonPosition = ImGuiDir_None;
    style.ScaleAllSizes(scale);
    style.WindowBorderSize = style.PopupBorderSize = std::max(1.0f, std::floor(scale));
    return style;
}

/// The base colours of the theme.
struct Shades {
    explicit Shades(bool isDark) : dark(isDark) {}
    bool dark;
    ImVec4 text = dark ? rgb(0xDADDE2) : rgb(0x23272E);
    ImVec4 muted = dark ? rgb(0x8A919C) : rgb(0x6A717C);
    ImVec4 window = dark ? rgb(0x1D2025) : rgb(0xFAFAFB);
    ImVec4 host = dark ? rgb(0x131519) : rgb(0xDFE2E6);
    ImVec4 frame = dark ? rgb(0x2A2E35) : rgb(0xFFFFFF);
    ImVec4 frameHover = dark ? rgb(0x343942) : rgb(0xF0F4FA);
    ImVec4 border = dark ? rgb(0x34383F) : rgb(0xC9CED5);
    ImVec4 accent = dark ? rgb(0x5AA2F0) : rgb(0x1F6FCB);
    ImVec4 tint(float alpha) const { return {accent.x, accent.y, accent.z, alpha}; }
};

void setColors(ImVec4* c, const Shades& shades) {
    c[ImGuiCol_Text] = shades.text;
    c[ImGuiCol_TextDisabled] = shades.muted;
    c[ImGuiCol_WindowBg] = shades.window;
    c[ImGuiCol_ChildBg] = {0, 0, 0, 0};
    c[ImGuiCol_PopupBg] = shades.dark ? rgb(0x24272D, 0.98f) : rgb(0xFFFFFF, 0.99f);
    c[ImGuiCol_Border] = shades.border;
    c[ImGuiCol_BorderShadow] = {0, 0, 0, 0};
    c[ImGuiCol_FrameBg] = shades.frame;
    c[ImGuiCol_FrameBgHovered] = shades.frameHover;
    c[ImGuiCol_FrameBgActive] = shades.dark ? rgb(0x3B414B) : rgb(0xE4EDF8);
    c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgCollapsed] = shades.host;
    c[ImGuiCol_TitleBgActive] = shades.dark ? rgb(0x1A1D22) : rgb(0xD3D8DE);
    c[ImGuiCol_MenuBarBg] = shades.host;
    c[ImGuiCol_ScrollbarBg] = {0, 0, 0, 0};
    c[ImGuiCol_ScrollbarGrab] = shades.dark ? rgb(0x444A54) : rgb(0xC2C8D0);
    c[ImGuiCol_ScrollbarGrabHovered] = shades.dark ? rgb(0x59606C) : rgb(0xA9B1BB);
    c[ImGuiCol_ScrollbarGrabActive] = shades.accent;
    c[ImGuiCol_CheckMark] = shades.accent;
    c[ImGuiCol_SliderGrab] = shades.tint(0.5f);
    c[ImGuiCol_SliderGrabActive] = shades.accent;
    c[ImGuiCol_Button] = shades.dark ? rgb(0x2F343C) : rgb(0xEBEEF2);
    c[ImGuiCol_ButtonHovered] = shades.dark ? rgb(0x3B424C) : rgb(0xDDE6F2);
    c[ImGuiCol_ButtonActive] = shades.tint(0.55f);
    c[ImGuiCol_Header] = shades.tint(shades.dark ? 0.22f : 0.16f);
    c[ImGuiCol_HeaderHovered] = shades.tint(shades.dark ? 0.30f : 0.22f);
    c[ImGuiCol_HeaderActive] = shades.tint(0.42f);
    c[ImGuiCol_Separator] = shades.border;
    c[ImGuiCol_SeparatorHovered] = shades.tint(0.6f);
    c[ImGuiCol_SeparatorActive] = shades.accent;
    c[ImGuiCol_ResizeGrip] = {0, 0, 0, 0};
    c[ImGuiCol_ResizeGripHovered] = shades.tint(0.5f);
    c[ImGuiCol_ResizeGripActive] = shades.accent;
    c[ImGuiCol_Tab] = c[ImGuiCol_TabUnfocused] = shades.host;
    c[ImGuiCol_TabHovered] = shades.frameHover;
    c[ImGuiCol_TabActive] = c[ImGuiCol_TabUnfocusedActive] = shades.window;
    c[ImGuiCol_PlotLines] = c[ImGuiCol_PlotHistogram] = shades.accent;
    c[ImGuiCol_PlotLinesHovered] = c[ImGuiCol_PlotHistogramHovered] = shades.tint(0.8f);
    c[ImGuiCol_TableHeaderBg] = shades.dark ? rgb(0x24282E) : rgb(0xECEFF3);
    c[ImGuiCol_TableBorderStrong] = shades.border;
    c[ImGuiCol_TableBorderLight] = shades.dark ? rgb(0x2A2E34) : rgb(0xE0E4E9);
    c[ImGuiCol_TableRowBg] = {0, 0, 0, 0};
    c[ImGuiCol_TableRowBgAlt] = shades.dark ? rgb(0xFFFFFF, 0.025f) : rgb(0x000000, 0.025f);
    c[ImGuiCol_TextSelectedBg] = shades.tint(0.35f);
    c[ImGuiCol_DragDropTarget] = shades.accent;
    c[ImGuiCol_NavHighlight] = {0, 0, 0, 0}; // KeyboardFocus draws the mark
    c[ImGuiCol_NavWindowingHighlight] = shades.accent;
    c[ImGuiCol_NavWindowingDimBg] = {0, 0, 0, 0.35f};
    c[ImGuiCol_ModalWindowDimBg] = {0, 0, 0, shades.dark ? 0.5f : 0.28f};
}

Palette paletteOf(const Shades& shades) {
    Palette made{};
    made.text = pack(shades.text);
    made.muted = pack(shades.muted);
    made.accent = pack(shades.accent);
    made.accentSoft = pack(shades.tint(0.25f));
    made.panel = pack(shades.host);
    made.plot = pack(shades.dark ? rgb(0x15171B) : rgb(0xFFFFFF));
    made.grid = pack(shades.dark ? rgb(0x2B2F36) : rgb(0xE4E7EB));
    made.line = pack(shades.border);
    made.warning = pack(shades.dark ? rgb(0xE5B25D) : rgb(0xA86A00));
    made.failure = pack(shades.dark ? rgb(0xEF7B72) : rgb(0xBF2F26));
    made.good = pack(shades.dark ? rgb(0x7CC38A) : rgb(0x2C7D3D));
    return made;
}

} // namespace

void applyTheme(Theme theme, float scale) {
    const Shades shades(theme == Theme::Dark);
    ImGuiStyle style = styleSizes(shades.dark, scale);
    setColors(style.Colors, shades);
    ImGui::GetStyle() = style;
}

bool darkTheme() {
    const ImVec4 background = ImGui::GetStyleColorVec4(ImGuiCol_WindowBg);
    return background.x + background.y + background.z < 1.5f;
}

const Palette& palette() {
    static const Palette dark = paletteOf(Shades(true)), light = paletteOf(Shades(false));
    return darkTheme() ? dark : light;
}

} // namespace tessera::app
