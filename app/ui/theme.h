#pragma once

#include "app/session/session.h"

#include <imgui.h>

/// Fonts, colours and icons of the window.
namespace tessera::app {

struct Fonts {
    ImFont* text = nullptr; ///< icons are merged into it
    ImFont* bold = nullptr;
    ImFont* icons = nullptr; ///< == text, null where the icon font is not installed
};

/// The pixels per design pixel that fonts are made for.
inline constexpr float kLeastScale = 0.4f, kLargestScale = 6;
/// The pixels per design pixel at which an em of text, its size in print, has so many pixels.
float scaleForText(double emPixels);
/// The pixels of an em at a scale.
double textPixels(float scale);

/// Builds the font atlas for a number of pixels per design pixel: Roboto with the letters and signs of units, Font
/// Awesome merged in; ImGui's own font where they are not installed. The back end must upload the atlas again.
Fonts loadFonts(float scale);

/// Sets ImGui's style: sizes for the scale, colours for the theme.
void applyTheme(Theme theme, float scale);

/// Whether that theme is dark, in ImGui's current context: a picture on white has one of its own beside the window's.
bool darkTheme();

/// Colours for custom drawing, for the theme of ImGui's current context.
struct Palette {
    ImU32 text, muted, accent, accentSoft, panel, plot, grid, line, warning, failure, good;
};
const Palette& palette();

/// Font Awesome 4 code points as UTF-8.
namespace icon {
inline constexpr const char* kFolder = "\xef\x81\xbc";      // f07c
inline constexpr const char* kFile = "\xef\x80\x96";        // f016
inline constexpr const char* kSave = "\xef\x83\x87";        // f0c7
inline constexpr const char* kUndo = "\xef\x83\xa2";        // f0e2
inline constexpr const char* kRedo = "\xef\x80\x9e";        // f01e
inline constexpr const char* kPlay = "\xef\x81\x8b";        // f04b
inline constexpr const char* kPause = "\xef\x81\x8c";       // f04c
inline constexpr const char* kStepBack = "\xef\x81\x88";    // f048
inline constexpr const char* kStepForward = "\xef\x81\x91"; // f051
inline constexpr const char* kFirst = "\xef\x81\x89";       // f049
inline constexpr const char* kLast = "\xef\x81\x90";        // f050
inline constexpr const char* kRepeat = "\xef\x80\xa1";      // f021
inline constexpr const char* kOnce = "\xef\x85\xb8";        // f178
inline constexpr const char* kPingPong = "\xef\x81\xb9";    // f079
inline constexpr const char* kEye = "\xef\x81\xae";         // f06e
inline constexpr const char* kEyeOff = "\xef\x81\xb0";      // f070
inline constexpr const char* kTrash = "\xef\x80\x94";       // f014
inline constexpr const char* kPlus = "\xef\x81\xa7";        // f067
inline constexpr const char* kCross = "\xef\x80\x8d";       // f00d
inline constexpr const char* kUp = "\xef\x81\xb7";          // f077
inline constexpr const char* kDown = "\xef\x81\xb8";        // f078
inline constexpr const char* kGear = "\xef\x80\x93";        // f013
inline constexpr const char* kCamera = "\xef\x80\xb0";      // f030
inline constexpr const char* kHome = "\xef\x80\x95";        // f015
inline constexpr const char* kSearch = "\xef\x80\x82";      // f002
inline constexpr const char* kWarning = "\xef\x81\xb1";     // f071
inline constexpr const char* kInfo = "\xef\x81\x9a";        // f05a
inline constexpr const char* kExpand = "\xef\x81\xa5";      // f065
inline constexpr const char* kCompress = "\xef\x81\xa6";    // f066
inline constexpr const char* kBrush = "\xef\x87\xbc";       // f1fc
inline constexpr const char* kInvert = "\xef\x81\x82";      // f042
inline constexpr const char* kCrosshair = "\xef\x81\x9b";   // f05b
inline constexpr const char* kCopy = "\xef\x83\x85";        // f0c5
inline constexpr const char* kCheck = "\xef\x80\x8c";       // f00c
inline constexpr const char* kDatabase = "\xef\x87\x80";    // f1c0
inline constexpr const char* kCube = "\xef\x86\xb2";        // f1b2
inline constexpr const char* kChain = "\xef\x83\x81";       // f0c1
inline constexpr const char* kChainOff = "\xef\x84\xa7";    // f127
inline constexpr const char* kLock = "\xef\x80\xa3";        // f023
inline constexpr const char* kClock = "\xef\x80\x97";       // f017
} // namespace icon

} // namespace tessera::app
