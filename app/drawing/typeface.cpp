#include "app/drawing/typeface.h"

#include <array>
#include <filesystem>
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

} // namespace tessera::app
