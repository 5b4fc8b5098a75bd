#include "app/pane/scale_bar.h"

#include <gtest/gtest.h>

namespace tessera::app {
namespace {

vis::Camera front() {
    vis::Camera camera;
    camera.projection = vis::Projection::Orthographic;
    camera.orientation = {1, 0, 0, 0};
    return camera;
}

TEST(ScaleBar, IsARoundLengthThatFits) {
    vis::Camera camera = front();
    const vis::WorldFrame world = vis::worldFrame({{0, 0, 0}, {0.004, 0.002, 0.002}}, glm::dvec3(1)); // metres
    for (float distance = 0.5f; distance < 20; distance *= 1.17f) {
        camera.distance = distance;
        const ScaleBar bar = scaleBar(camera, world, glm::dvec3(1), "m", 600, 150);
        EXPECT_LE(bar.pixels, 150.01f);
        EXPECT_GT(bar.pixels, 150 / 2.51f);
        const char lead = bar.text[bar.text.find_first_not_of("0.")];
        EXPECT_TRUE(lead == '1' || lead == '2' || lead == '5') << bar.text;
    }
    // One world unit is 4 mm; 600 pixels show 2 d tan(fov / 2) of them.
    camera.distance = 1;
    camera.fieldOfView = 53.13010235f; // tan of half of it is 1/2
    const ScaleBar bar = scaleBar(camera, world, glm::dvec3(1), "m", 600, 160);
    EXPECT_EQ(bar.text, "1 mm");
    EXPECT_NEAR(bar.pixels, 150, 0.01f);
    camera.projection = vis::Projection::Perspective;
    EXPECT_EQ(scaleBar(camera, world, glm::dvec3(1), "m", 600, 160).text, "~1 mm");
}

TEST(ScaleBar, SaysWhichAxisIsStretched) {
    const glm::dvec3 stretch(2, 4, 1);
    const vis::WorldFrame world = vis::worldFrame({{0, 0, 0}, {1, 1, 1}}, stretch);
    const std::string across = scaleBar(front(), world, stretch, "m", 600, 150).text;
    EXPECT_NE(across.find("along x, stretched 2 times"), std::string::npos) << across;
    vis::Camera side = front();
    side.orientation = vis::standardOrientation(vis::StandardView::Right);
    const std::string along = scaleBar(side, world, stretch, "m", 600, 150).text;
    EXPECT_TRUE(along.ends_with(" along z")) << along;
    const std::string even = scaleBar(front(), world, glm::dvec3(3), "m", 600, 150).text;
    EXPECT_TRUE(even.ends_with(", stretched 3 times")) << even;
    EXPECT_EQ(even.find("along"), std::string::npos);
}

} // namespace
} // namespace tessera::app
