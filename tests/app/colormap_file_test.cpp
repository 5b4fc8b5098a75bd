#include "app/user_files/colormap_file.h"
#include "volume/base/error.h"

#include <gtest/gtest.h>

namespace tessera::app {
namespace {

TEST(ColormapFile, OwnAndForeignOnesAreRead) {
    const auto own = parseColormap(
        R"({"colors": [{"position": 3, "color": [0, 0, 1]}, {"position": 1, "color": [1, 0, 0]}, {"position": 1.5, "color": [0, 1, 0]}]})",
        "own.json");
    const std::vector<vis::ColorStop> wanted{{0, {1, 0, 0}}, {0.25f, {0, 1, 0}}, {1, {0, 0, 1}}};
    EXPECT_EQ(own, wanted);
    EXPECT_EQ(parseColormap(R"([{"Name": "x", "RGBPoints": [1, 1, 0, 0, 1.5, 0, 1, 0, 3, 0, 0, 1]}])", "pv.json"),
              wanted);
}

TEST(ColormapFile, OthersAreRefusedWithTheirPlace) {
    for (const char* text :
         {"", "{}", "[]", "nonsense", R"({"colors": []})", R"({"colors": [{"position": 0, "color": [0, 0, 0]}]})",
          R"({"colors": [{"position": 0, "color": [0, 0, 2]}, {"position": 1, "color": [0, 0, 0]}]})",
          R"({"colors": [{"position": 0, "color": [0, 0]}, {"position": 1, "color": [0, 0, 0]}]})",
          R"({"colors": [{"position": 2, "color": [0, 0, 0]}, {"position": 2, "color": [0, 0, 0]}]})",
          R"([{"RGBPoints": [0, 1, 1]}])", R"([{"RGBPoints": ["a", 1, 1, 1, 0, 0, 0, 0]}])"})
        EXPECT_THROW(parseColormap(text, "map.json"), Error) << text;
    try {
        parseColormap(R"({"colors": [{"position": 0, "color": [0, 0, 2]}, {"position": 1, "color": [0, 0, 0]}]})",
                      "map.json");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.file(), "map.json");
        EXPECT_EQ(error.place(), "/colors/0/color");
    }
}

} // namespace
} // namespace tessera::app
