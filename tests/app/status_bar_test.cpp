#include "app/workbench/status_bar.h"

#include "app/ui/theme.h"
#include "tests/app/drawn_text.h"
#include "tests/app/fed_imgui.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <thread>

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
        feed([&] { drawStatusBar("data", jobs, &messages, 24, 1, false); });
        return drawnWords();
    }
    Jobs* jobs = nullptr;
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

TEST_F(StatusLine, TheMouseOnAMessageShowsAllThatAreNewWhole) {
    messages.add("an earlier one");
    messages.add("begin " + std::string(300, 'x') + " end of it");
    draw();
    for (const DrawnText& each : drawnTexts())
        if (each.text.starts_with("begin")) mouse = {each.min.x + 20, each.middle().y};
    for (int i = 0; i < 3; ++i) draw(); // a tooltip has its size in the second picture
    std::string said;
    for (const std::string& word : drawnWords()) said += word + "|";
    for (const char* text : {"end of it", "an earlier one"})
        EXPECT_NE(said.find(text), std::string::npos) << text << " in " << said;
}

// The cross of a job is beside its own bar, not beside the title of the next.
TEST_F(StatusLine, JobsAreApart) {
    Jobs working;
    std::atomic<bool> done = false;
    for (const char* title : {"one", "two"})
        working.start(title, title, [&done](const Progress&) {
            while (!done) std::this_thread::sleep_for(std::chrono::milliseconds(1));
            return Jobs::Finish();
        });
    std::this_thread::sleep_for(std::chrono::milliseconds(200)); // shorter ones are not listed
    jobs = &working;
    draw();
    draw();
    std::map<std::string, std::vector<DrawnText>> found;
    for (const DrawnText& text : drawnTexts()) found[text.text].push_back(text);
    done = true;
    working.wait();
    ASSERT_EQ(found["one"].size() + found["two"].size(), 2u);
    ASSERT_EQ(found["x"].size(), 2u);
    const float title = std::max(found["one"][0].min.x, found["two"][0].min.x);
    const float cross = std::min(found["x"][0].max.x, found["x"][1].max.x);
    EXPECT_GT(title - cross, 1.3f * ImGui::GetFontSize());
}

} // namespace
} // namespace tessera::app
