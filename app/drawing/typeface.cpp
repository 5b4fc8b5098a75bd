#include "app/drawing/typeface.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <ft2build.h>
#include FT_FREETYPE_H
#include <initializer_list>

namespace tessera::app {

namespace {

const char* installed(std::initializer_list<const char*> paths) {
    for (const char* path : paths) {
        std::error_code problem;
        if (std::filesystem::is_regular_file(path, problem)) return path;
    }
    return nullptr;
}

constexpr std::size_t kAdvances = 256; // of Latin-1

/// How far the characters of a face move the pen, in ems.
std::array<double, kAdvances> advancesOf(Face face) {
    std::array<double, kAdvances> out;
    out.fill(0.56);
    const char* file = typeface(face).file;
    FT_Library library = nullptr;
    FT_Face loaded = nullptr;
    if (!file || FT_Init_FreeType(&library) != 0) return out;
    if (FT_New_Face(library, file, 0, &loaded) == 0) {
        for (std::size_t code = 0; code < kAdvances; ++code)
            if (const FT_UInt glyph = FT_Get_Char_Index(loaded, FT_ULong(code));
                glyph != 0 && FT_Load_Glyph(loaded, glyph, FT_LOAD_NO_SCALE) == 0)
                out[code] = double(loaded->glyph->advance.x) / double(loaded->units_per_EM);
        FT_Done_Face(loaded);
    }
    FT_Done_FreeType(library);
    return out;
}

} // namespace

const Typeface& typeface(Face face) {
    constexpr double kRobotoLine = 2400.0 / 2048;
    static const std::array<Typeface, 3> faces{
        Typeface{"Roboto", "400",
                 installed({"/usr/share/fonts/truetype/roboto/unhinted/RobotoTTF/Roboto-Regular.ttf",
                            "/usr/share/fonts/truetype/roboto/hinted/Roboto-Regular.ttf"}),
                 kRobotoLine},
        Typeface{"Roboto", "500",
                 installed({"/usr/share/fonts/truetype/roboto/unhinted/RobotoTTF/Roboto-Medium.ttf",
                            "/usr/share/fonts/truetype/roboto/hinted/Roboto-Medium.ttf"}),
                 kRobotoLine},
        Typeface{"FontAwesome", "400", installed({"/usr/share/fonts/truetype/font-awesome/fontawesome-webfont.ttf"}),
                 1}};
    return faces[static_cast<std::size_t>(face)];
}

double textWidth(std::string_view text, Face face) {
    static const std::array<std::array<double, kAdvances>, 3> advances{advancesOf(Face::Text), advancesOf(Face::Bold),
                                                                       advancesOf(Face::Icons)};
    double width = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const bool more = byte >= 0xc0 && i + 1 < text.size(); // UTF-8: Latin-1 has two bytes
        const std::size_t code = more ? (byte & 31u) << 6 | (static_cast<unsigned char>(text[i + 1]) & 63u) : byte;
        width += byte < 0x80 || byte == 0xc2 || byte == 0xc3 ? advances[static_cast<std::size_t>(face)][code] : 0.56;
        while (more && i + 1 < text.size() && (static_cast<unsigned char>(text[i + 1]) & 0xc0) == 0x80) ++i;
    }
    return width;
}

std::vector<std::string> brokenText(const std::string& text, double width, Face face) {
    std::vector<std::string> lines(1);
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        const std::string word = text.substr(at, end - at), longer = lines.back() + " " + word;
        if (at == 0)
            lines.back() = word;
        else if (textWidth(longer, face) <= width)
            lines.back() = longer;
        else
            lines.push_back(word);
        at = end + 1;
    }
    return lines;
}

} // namespace tessera::app
