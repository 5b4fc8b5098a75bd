#pragma once

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

} // namespace tessera::app
