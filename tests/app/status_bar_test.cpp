#include "app/workbench/status_bar.h"

#include "app/ui/theme.h"
#include "tests/app/drawn_text.h"
#include "tests/app/fed_imgui.h"

namespace tessera::app {
namespace {

TEST(StatusBar, SaysWhatCastsRays) {
    EXPECT_EQ(engineText({.byProcessor = true, .instructions = "AVX2", .refusal = {}}),
              "   rays by the processor (AVX2)");
    EXPECT_EQ(engineText({.byProcessor = false, .instructions = {}, .refusal = "brushes"}),
              "   rays by OpenGL: the processor cannot draw brushes");
    EXPECT_EQ(engineText({}), "");
}

TEST(StatusBar, SaysWhatIsLoaded) {
    EXPECT_EQ(residencyText({}), "");
    vis::ResidencyInfo use;
    use.textureBytes = std::size_t(25) << 19;
    use.textureBudget = std::size_t(512) << 20;
    use.bricksResident = 1;
    EXPECT_EQ(residencyText(use), "   textures 12.5 of 512 MiB, 1 brick");
    use.bricksResident = 96;
    EXPECT_EQ(residencyText(use), "   textures 12.5 of 512 MiB, 96 bricks");
    use.bricksWanted = 4;
    EXPECT_EQ(residencyText(use), "   textures 12.5 of 512 MiB, 96 bricks, 4 loading");
    use.bricksKept = 3, use.bricksHidden = 2;
    EXPECT_EQ(residencyText(use),
              "   textures 12.5 of 512 MiB, 96 bricks, 3 kept from other times, 2 hidden, 4 loading");
}

struct StatusLine : FedImGui {
    StatusLine() : FedImGui({800, 300}) {}
    void SetUp() override {
        loadFonts(1);
        applyTheme(Theme::Dark, 1);
    }
    std::vector<std::string> draw(bool down = false) {
        ImGui::GetIO().MouseDown[0] = down;
        feed([&] { drawStatusBar("data", nullptr, &messages, 24, 1, false); });
        return drawnWords();
    }
    Messages messages{[] { return 0.0; }};
};

TEST_F(StatusLine, AClickTakesTheNewestMessageAway) {
    for (const char* text : {"first", "second", "third"}) messages.add(text);
    draw();
    EXPECT_EQ(draw()[0], "third  +2");
    const auto click = [&] {
        for (const DrawnText& each : drawnTexts())
            if (each.max.y > 270 && each.min.x < 200 && each.text != "x") {
                mouse = each.middle();
                break;
            }
        draw();
        draw(true);
        draw();
        mouse = {-1000, -1000};
        draw();
        return draw()[0];
    };
    EXPECT_EQ(click(), "second  +1");
    EXPECT_EQ(click(), "first");
    EXPECT_EQ(click(), "data");
    EXPECT_EQ(messages.list().size(), 3u) << "they stay in the pane";
}

} // namespace
} // namespace tessera::app
