#pragma once

#include <algorithm>
#include <cmath>
#include <imgui.h>
#include <limits>
#include <map>
#include <string>
#include <vector>

/// What the last frame of ImGui drew, read back from its triangles: texts of widgets and plots alike, and their places.
namespace tessera::app {

/// Letters that follow each other on one line.
struct DrawnText {
    std::string text; ///< UTF-8
    ImVec2 min, max;  ///< pixels around the letters
    ImVec2 middle() const { return {(min.x + max.x) / 2, (min.y + max.y) / 2}; }
};

/// In the order they were drawn, turned ones too. A part of a text that lies outside of the clip rectangle is missing.
inline std::vector<DrawnText> drawnTexts() {
    std::map<std::pair<float, float>, const ImFontGlyph*> glyphs; // by the corner of their picture
    float space = 0;
    for (const ImFont* font : ImGui::GetIO().Fonts->Fonts)
        for (const ImFontGlyph& glyph : font->Glyphs) {
            if (glyph.Visible) glyphs[{glyph.U0, glyph.V0}] = &glyph;
            if (glyph.Codepoint == ' ') space = std::max(space, glyph.AdvanceX);
        }
    std::vector<DrawnText> texts;
    const ImDrawData* data = ImGui::GetDrawData();
    for (int list = 0; data && list < data->CmdListsCount; ++list) {
        const ImVector<ImDrawVert>& corners = data->CmdLists[list]->VtxBuffer;
        ImVec2 pen{0, 0}; // where the next letter of this text would be
        bool open = false;
        for (int i = 0; i + 3 < corners.Size; ++i) {
            const auto found = glyphs.find({corners[i].uv.x, corners[i].uv.y});
            if (found == glyphs.end() || corners[i + 2].uv.x != found->second->U1 ||
                corners[i + 2].uv.y != found->second->V1) {
                open = false;
                continue;
            }
            const ImFontGlyph& glyph = *found->second;
            const ImVec2 at = corners[i].pos, right = corners[i + 1].pos, down = corners[i + 3].pos;
            const float width = std::hypot(right.x - at.x, right.y - at.y);
            const float height = std::hypot(down.x - at.x, down.y - at.y);
            const float scale = width / (glyph.X1 - glyph.X0);
            const ImVec2 x{(right.x - at.x) / width, (right.y - at.y) / width},
                y{(down.x - at.x) / height, (down.y - at.y) / height};
            const float left = glyph.X0 * scale, top = glyph.Y0 * scale;
            const ImVec2 begin{at.x - x.x * left - y.x * top, at.y - x.y * left - y.y * top};
            const ImVec2 gap{begin.x - pen.x, begin.y - pen.y};
            const float along = gap.x * x.x + gap.y * x.y, across = gap.x * y.x + gap.y * y.y;
            constexpr float kInfinity = std::numeric_limits<float>::infinity();
            if (!open || std::abs(across) > 0.5f || along < -0.5f || along > 2.5f * space * scale)
                texts.push_back({"", {kInfinity, kInfinity}, {-kInfinity, -kInfinity}});
            else
                texts.back().text.append(std::size_t(std::lround(along / (space * scale))), ' ');
            DrawnText& text = texts.back();
            char letter[5];
            const unsigned code = glyph.Codepoint;
            const int bytes = code < 0x80 ? 1 : code < 0x800 ? 2 : 3;
            for (int b = bytes - 1; b > 0; --b) letter[b] = char(0x80 | (code >> (6 * (bytes - 1 - b)) & 0x3f));
            letter[0] = char(bytes == 1 ? code : bytes == 2 ? 0xc0 | code >> 6 : 0xe0 | code >> 12);
            text.text.append(letter, std::size_t(bytes));
            for (int corner = 0; corner < 4; ++corner) {
                const ImVec2 p = corners[i + corner].pos;
                text.min = {std::min(text.min.x, p.x), std::min(text.min.y, p.y)};
                text.max = {std::max(text.max.x, p.x), std::max(text.max.y, p.y)};
            }
            const float advance = glyph.AdvanceX * scale;
            pen = {begin.x + x.x * advance, begin.y + x.y * advance};
            open = true;
            i += 3;
        }
    }
    return texts;
}

/// The texts alone.
inline std::vector<std::string> drawnWords() {
    std::vector<std::string> words;
    for (const DrawnText& each : drawnTexts()) words.push_back(each.text);
    return words;
}

/// Corners of what was drawn in one colour.
inline std::vector<ImVec2> drawnIn(ImU32 color) {
    std::vector<ImVec2> places;
    const ImDrawData* data = ImGui::GetDrawData();
    for (int list = 0; data && list < data->CmdListsCount; ++list)
        for (const ImDrawVert& corner : data->CmdLists[list]->VtxBuffer)
            if (corner.col == color) places.push_back(corner.pos);
    return places;
}

} // namespace tessera::app
