#pragma once

#include <string>
#include <string_view>
#include <vector>

/// The fonts of windows, pictures and figures.
namespace tessera::app {

enum class Face { Text, Bold, Icons };

struct Typeface {
    const char* family; ///< as programs that show figures know it
    const char* weight; ///< as in SVG: "400", "500"
    const char* file;   ///< null where the font is not installed
    double line;        ///< from the highest ascender to the lowest descender, in ems
};

const Typeface& typeface(Face face);

/// The width of a line of text in ems; characters that the font lacks, and all where it is not installed, are 0.56
/// wide.
double textWidth(std::string_view text, Face face = Face::Text);

/// A text broken at blanks into lines of at most `width` ems; what has no blanks stays whole.
std::vector<std::string> brokenText(const std::string& text, double width, Face face = Face::Text);

} // namespace tessera::app
