#include "app/session/picture_form.h"

#include "app/command/picture_options.h"
#include "app/described/describe_json.h"
#include "app/dialogs/picture_request.h"
#include "volume/base/error.h"

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

namespace tessera::app {
namespace {

/// What a command line asks for.
PictureRequest requested(const std::string& line) {
    PictureOptions options;
    CLI::App app;
    addPictureOptions(app, options);
    app.parse(line);
    return pictureRequest(options, Session{});
}

// By hand: 85 / 25.4 * 300 = 1003.9, 64 / 25.4 * 300 = 755.9, 174 and 109 at 300 dpi 2055.1 and 1287.4, 400 and 300 at
// 200 dpi 3149.6 and 2362.2.
TEST(PictureForm, PixelsFollowFromMillimetresAndResolution) {
    EXPECT_EQ(PictureSize::preset("oneColumn")->pixels(), glm::ivec2(1004, 756));
    EXPECT_EQ(PictureSize::preset("twoColumns")->pixels(), glm::ivec2(2055, 1287));
    EXPECT_EQ(PictureSize::preset("poster")->pixels(), glm::ivec2(3150, 2362));
    EXPECT_EQ(PictureSize::preset("slide")->pixels(), glm::ivec2(1920, 1080));
    PictureSize inch;
    inch.measure = PictureMeasure::Millimetres;
    inch.widthMm = 25.4;
    inch.heightMm = 12.7;
    inch.dpi = 600;
    EXPECT_EQ(inch.pixels(), glm::ivec2(600, 300));
    inch.heightMm = 0;
    EXPECT_EQ(inch.pixels(), glm::ivec2(600, 450));
    EXPECT_EQ(PictureSize::preset("postcard"), std::nullopt);
}

TEST(PictureForm, TheCommandLineAndJsonMeanTheSame) {
    EXPECT_EQ(requested("").size, glm::ivec2(1600, 1000));
    EXPECT_EQ(requested("").dpi, 0);
    EXPECT_EQ(requested("--size 300x200 --scale 2").size, glm::ivec2(300, 200));
    EXPECT_EQ(requested("--size 300x200 --scale 2").scale, 2);
    const PictureRequest column = requested("--preset oneColumn");
    EXPECT_EQ(column.size, glm::ivec2(1004, 756));
    EXPECT_EQ(column.dpi, 300);
    EXPECT_EQ(requested("--dpi 600 --preset oneColumn").size, glm::ivec2(2008, 1512));
    EXPECT_EQ(requested("--width-mm 85 --dpi 300").size, glm::ivec2(1004, 753)); // 63.75 mm
    EXPECT_EQ(requested("--width-mm 50.8 --height-mm 25.4 --dpi 100").size, glm::ivec2(200, 100));
    EXPECT_EQ(requested("--preset oneColumn --size 300x200").size, glm::ivec2(300, 200));
    EXPECT_THROW(requested("--width-mm 85 --size 300x200"), CLI::ValidationError);
    EXPECT_THROW(requested("--size 300"), CLI::ValidationError);
    EXPECT_EQ(requested("--size 16x16").size, glm::ivec2(16, 16)) << "the least";
    EXPECT_THROW(requested("--size 15x16"), CLI::ValidationError);
    EXPECT_THROW(requested("--size 16x15"), CLI::ValidationError);
    EXPECT_EQ(requested("--size 16384x16").size, glm::ivec2(16384, 16)) << "the most";
    EXPECT_THROW(requested("--size 16385x16"), CLI::ValidationError);
    EXPECT_THROW(requested("--width-mm 1900 --dpi 300"), Error);

    PictureForm form;
    std::vector<JsonIssue> issues;
    fromJson(form, parseJson(R"({"size": "oneColumn", "ground": "white", "decoration": {"legend": false}})", "test"),
             issues);
    EXPECT_TRUE(issues.empty());
    const PictureRequest read = pictureRequest(form, "");
    const PictureRequest line = requested("--preset oneColumn --ground white --without legend");
    EXPECT_EQ(read.size, line.size);
    EXPECT_EQ(read.dpi, line.dpi);
    EXPECT_EQ(read.scale, line.scale);
    EXPECT_EQ(read.ground, PictureGround::White);
    EXPECT_EQ(line.ground, PictureGround::White);
    EXPECT_EQ(read.decoration, line.decoration);
    PictureForm again;
    fromJson(again, toJson(form), issues);
    EXPECT_EQ(again, form);
}

TEST(PictureForm, PartsOfTheDecorationAreLeftOutByName) {
    EXPECT_EQ(requested("").decoration, Decoration{});
    Decoration some;
    some.legend = some.axes = some.scaleBar = false;
    EXPECT_EQ(requested("--without legend,axes --without scaleBar").decoration, some);
    EXPECT_EQ(requested("--no-decoration").decoration, Decoration::preset("none"));
    EXPECT_EQ(requested("--without legend,axes,box,gizmo,cursor,scaleBar,title,outlines").decoration,
              Decoration::preset("none"));
    try {
        requested("--without legends");
        ADD_FAILURE();
    } catch (const CLI::ValidationError& error) {
        EXPECT_NE(std::string(error.what()).find("legend, axes, box"), std::string::npos) << error.what();
    }
}

// Of a font whose lines are 2400 / 2048 em high, as Roboto's: 8 pt at 300 dpi are 33.3 pixels an em, 39 a line, which
// is 2.6 times the 15 pixels of the window.
TEST(PictureForm, TextHasItsSizeInPoints) {
    EXPECT_NEAR(requested("--width-mm 85 --dpi 300 --text-pt 8").scale, 2.604, 0.001);
    EXPECT_NEAR(requested("--width-mm 85 --dpi 600 --text-pt 4").scale, 2.604, 0.001);
    EXPECT_NEAR(requested("--width-mm 40 --dpi 300 --text-pt 8").scale, 2.604, 0.001) << "whatever the width";
    try {
        requested("--width-mm 85 --dpi 1200 --text-pt 8");
        ADD_FAILURE() << "fonts are not made so large";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("133 pixels high; it can be 5 to 77"), std::string::npos)
            << error.what();
    }
}

} // namespace
} // namespace tessera::app
