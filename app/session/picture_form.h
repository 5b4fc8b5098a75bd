#pragma once

#include "volume/base/presets.h"

#include <glm/vec2.hpp>
#include <optional>
#include <string_view>

/// In what form a picture is saved: how large, on what ground, and what is drawn over the data.
namespace tessera::app {

/// What is drawn over and beside the data in a picture.
struct Decoration {
    bool legend = true, axes = true, box = true, gizmo = true, cursor = true, scaleBar = true, title = true,
         outlines = true;
    bool operator==(const Decoration&) const = default;
    static constexpr std::string_view kPresetNames[] = {"all", "none"};
    static constexpr std::string_view kPresetDoc = "All decoration, or none";
    /// One of kPresetNames; nullopt of others.
    static std::optional<Decoration> preset(std::string_view name);
    static void describe(auto& self, auto&& visit) {
        visit(self.legend, FieldInfo{"legend", "Colour legends"});
        visit(self.axes, FieldInfo{"axes", "Axes with ticks and units"});
        visit(self.box, FieldInfo{"box", "The box around the data, the frame of a slice"});
        visit(self.gizmo, FieldInfo{"gizmo", "The axis triad"});
        visit(self.cursor, FieldInfo{"cursor", "The linked cross-hair and its values"});
        visit(self.scaleBar, FieldInfo{"scaleBar", "The scale bar"});
        visit(self.title, FieldInfo{"title", "Time or operating point, stretch, place of a slice, name of a variant"});
        visit(self.outlines, FieldInfo{"outlines", "Outlines of lenses and brushes, and profile lines"});
    }
};

enum class PictureMeasure { Pixels, Millimetres };
inline constexpr std::string_view kPictureMeasureNames[] = {"pixels", "millimetres"};

/// How large a picture is, and the text in it.
struct PictureSize {
    PictureMeasure measure = PictureMeasure::Pixels;
    int width = 1920, height = 1080;
    double scale = 1;
    double widthMm = 85, heightMm = 0, dpi = 300, textPt = 8;
    bool operator==(const PictureSize&) const = default;

    bool onPaper() const { return measure == PictureMeasure::Millimetres; }
    /// What the picture measures in pixels: on paper round(mm / 25.4 * dpi).
    glm::ivec2 pixels() const;
    /// Pixels of an em of text on paper.
    double textPixels() const { return textPt / 72 * dpi; }

    static constexpr std::string_view kPresetNames[] = {"screen", "slide", "oneColumn", "twoColumns", "poster"};
    static constexpr std::string_view kPresetDoc =
        "Size for a purpose, which other options override: screen (1920x1080 pixels), slide (the same with larger "
        "text), oneColumn (85 x 64 mm, 300 dpi), twoColumns (174 x 109 mm, 300 dpi), poster (400 x 300 mm, 200 dpi)";
    /// One of kPresetNames; nullopt of others.
    static std::optional<PictureSize> preset(std::string_view name);
    static void describe(auto& self, auto&& visit) {
        visit(self.measure, FieldInfo{.key = "measure",
                                      .doc = "Size in pixels, for screens, or in millimetres, for print",
                                      .names = kPictureMeasureNames});
        const bool paper = self.onPaper();
        visit(self.width, FieldInfo{.key = "width",
                                    .doc = "Width of the picture",
                                    .unit = "pixel",
                                    .range = Range{16, 16384},
                                    .logScale = true,
                                    .applies = !paper});
        visit(self.height, FieldInfo{.key = "height",
                                     .doc = "Height of the picture",
                                     .unit = "pixel",
                                     .range = Range{16, 16384},
                                     .logScale = true,
                                     .applies = !paper});
        visit(self.scale,
              FieldInfo{.key = "scale", .doc = "Size of text and lines", .range = Range{0.25, 8}, .applies = !paper});
        visit(self.widthMm, FieldInfo{.key = "widthMm",
                                      .doc = "Width on paper",
                                      .unit = "mm",
                                      .range = Range{5, 2000},
                                      .logScale = true,
                                      .applies = paper});
        visit(self.heightMm, FieldInfo{.key = "heightMm",
                                       .doc = "Height on paper; 0: three quarters of the width",
                                       .unit = "mm",
                                       .range = Range{0, 2000},
                                       .applies = paper});
        visit(self.dpi, FieldInfo{.key = "dpi",
                                  .doc = "Pixels per inch on paper; the PNG says so",
                                  .range = Range{36, 2400},
                                  .logScale = true,
                                  .applies = paper});
        visit(self.textPt, FieldInfo{.key = "textPt",
                                     .doc = "Size of text on paper, in points of 1/72 inch",
                                     .unit = "pt",
                                     .range = Range{3, 144},
                                     .logScale = true,
                                     .applies = paper});
    }
};

enum class PictureGround { Shown, White };
inline constexpr std::string_view kPictureGroundNames[] = {"shown", "white"};

enum class PictureFormat { Png, Svg, Pdf };
inline constexpr std::string_view kPictureFormatNames[] = {"png", "svg", "pdf"};

struct PictureForm {
    PictureSize size = {};
    PictureGround ground = PictureGround::Shown;
    Decoration decoration = {};
    PictureFormat format = PictureFormat::Png;
    bool operator==(const PictureForm&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.format, FieldInfo{.key = "format",
                                     .doc = "PNG: a raster picture; SVG and PDF: texts and lines as vectors, views as "
                                            "pictures of the size above. Each contains the session",
                                     .names = kPictureFormatNames});
        visit(self.size, FieldInfo{"size", "Size of the picture and of its text"});
        visit(self.ground, FieldInfo{.key = "ground",
                                     .doc = "Background: as on screen, or white with dark text",
                                     .names = kPictureGroundNames});
        visit(self.decoration, FieldInfo{"decoration", "What is drawn over and beside the data"});
    }
};

} // namespace tessera::app
