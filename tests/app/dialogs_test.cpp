#include "app/dialogs/dialogs.h"
#include "app/dialogs/file_questions.h"
#include "app/ui/keys.h"
#include "app/ui/theme.h"
#include "codec/pack/pack.h"
#include "tests/app/drawn_text.h"
#include "tests/app/fed_imgui.h"
#include "tests/app/formula_cell.h"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <unistd.h>

/// What dialogs say, and that they close.
namespace tessera::app {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class Dialogs : public FedImGui {
protected:
    Dialogs() : FedImGui({900, 700}) {}
    void SetUp() override {
        fonts = loadFonts(1);
        applyTheme(Theme::Dark, 1);
        fs::create_directories(folder);
    }
    void TearDown() override { fs::remove_all(folder); }
    static DrawnText find(const std::string& text) {
        for (const DrawnText& each : drawnTexts())
            if (each.text == text) return each;
        ADD_FAILURE() << "not drawn: " << text;
        return {};
    }

    Fonts fonts;
    fs::path folder = fs::path(testing::TempDir()) / ("dialogs_" + std::to_string(::getpid()));
};

TEST_F(Dialogs, AboutIsClosedByItsButtonAndItsCross) {
    HelpDialogs dialogs;
    const auto draw = [&] { dialogs.draw({}, fonts, {}); };
    for (const bool byButton : {true, false}) {
        dialogs.showAbout();
        frames(4, draw);
        EXPECT_THAT(drawnWords(), Contains("A workbench for simulations with many values per point."));
        const DrawnText title = find("About Tessera"), button = find("Close");
        click(byButton ? button.middle() : ImVec2{button.max.x + 24, title.middle().y},
              draw); // the cross is at the end
        EXPECT_THAT(drawnWords(), Not(Contains("About Tessera"))) << byButton;
    }
}

TEST_F(Dialogs, APictureSaysThatItHoldsItsSessionAndWhatAreVectors) {
    Session session;
    addView(session, *viewOfKind("volume"));
    PictureDialog dialog;
    dialog.show("volume");
    const auto draw = [&] { dialog.draw(session, {}, ""); };
    frames(4, draw);
    const auto holds = HasSubstr("The picture contains the session"),
               vectors = HasSubstr("Texts and lines are vectors");
    EXPECT_THAT(drawnWords(), Contains(holds));
    EXPECT_THAT(drawnWords(), Not(Contains(vectors)));
    click(find("PNG").middle(), draw);
    click(find("PDF").middle(), draw);
    EXPECT_THAT(drawnWords(), Contains(vectors));
    EXPECT_THAT(drawnWords(), Contains(holds));
}

TEST_F(Dialogs, EnterInANumberFieldEndsItsNumberAlone) {
    Session session;
    addView(session, *viewOfKind("volume"));
    PictureDialog dialog;
    dialog.show("volume");
    std::optional<PictureRequest> saved;
    const auto draw = [&] {
        if (auto request = dialog.draw(session, {}, "")) saved = request;
    };
    frames(4, draw);
    const auto enter = [&] {
        for (const bool down : {true, false}) {
            feedKey(ImGui::GetIO(), key::kEnter, down);
            frames(2, draw);
        }
    };
    DrawnText number;
    for (const DrawnText& each : drawnTexts())
        if (each.text.starts_with("1920") && number.text.empty()) number = each;
    ASSERT_FALSE(number.text.empty());
    mouse = number.middle();
    frames(2, draw);
    feedModifiers(ImGui::GetIO(), true, false, false);
    click(number.middle(), draw);
    feedModifiers(ImGui::GetIO(), false, false, false);
    ImGui::GetIO().AddInputCharactersUTF8("800");
    frames(2, draw);
    enter();
    EXPECT_FALSE(saved) << "the number alone was meant";
    EXPECT_THAT(drawnWords(), Contains(HasSubstr("800 x 1080 pixels")));
    enter();
    ASSERT_TRUE(saved) << "now nothing is typed";
    EXPECT_EQ(saved->size.x, 800);
}

// 640x360 at scale 1 are 1280x720 at scale 2.
TEST_F(Dialogs, ButtonsOfAPictureAreInSightWhereItsSettingsScroll) {
    Session session;
    addView(session, *viewOfKind("volume"));
    PictureDialog dialog;
    dialog.show("volume");
    const auto draw = [&] { dialog.draw(session, {}, ""); };
    frames(5, draw);
    const float whole = find("Save...").min.y - find("What").min.y;
    EXPECT_NEAR(find("Save...").min.y - find("Fit").max.y, 3 * ImGui::GetFrameHeight(), ImGui::GetFrameHeight())
        << "no gap above the buttons of a window with room";
    ImGui::GetIO().DisplaySize = {640, 360};
    frames(5, draw);
    for (const char* each : {"Cancel", "Save..."}) EXPECT_LT(find(each).max.y, 360) << each;
    EXPECT_GT(find("What").min.y, 0);
    EXPECT_THAT(drawnWords(), Not(Contains("Fit"))) << "settings scroll";
    mouse = find("Height").middle();
    for (int i = 0; i < 9; ++i) {
        ImGui::GetIO().MouseWheel = -2;
        frames(2, draw);
    }
    EXPECT_LT(find("Fit").max.y, find("Save...").min.y);
    EXPECT_LT(find("Save...").max.y, 360);
    ImGui::GetIO().DisplaySize = {900, 700};
    frames(5, draw);
    EXPECT_NEAR(find("Save...").min.y - find("What").min.y, whole, 1);
}

TEST_F(Dialogs, StayInAWindowThatBecomesSmaller) {
    HelpDialogs dialogs;
    const auto draw = [&] { dialogs.draw({}, fonts, {}); };
    dialogs.showAbout();
    frames(4, draw);
    const DrawnText before = find("Close");
    frames(2, draw);
    EXPECT_EQ(find("Close").min.x, before.min.x) << "it stays where it is";
    const ImVec2 small{before.min.x - 40, before.min.y - 30}; // the button would lie outside
    ImGui::GetIO().DisplaySize = small;
    frames(3, draw);
    const DrawnText after = find("Close");
    EXPECT_LE(after.max.x, small.x);
    EXPECT_LE(after.max.y, small.y);
    EXPECT_GE(find("About Tessera").min.x, 0);
}

TEST_F(Dialogs, AQuestionForAFileHasItsTitle) {
    Jobs jobs;
    FileQuestions questions(jobs);
    const auto draw = [&] { questions.draw(); };
    questions.startIn(folder.string());
    questions.askSave("Save the table", "t.csv", ".csv", [](const std::string&) {});
    frames(4, draw);
    EXPECT_THAT(drawnWords(), Contains("Save the table"));
    ImGui::GetIO().DisplaySize = {900, 700};
    FileQuestions others(jobs);
    others.startIn(folder.string());
    others.askData("Compare with", [](const std::vector<std::string>&, const volume::ImportOptions&) {});
    frames(4, [&] { others.draw(); });
    for (const char* word : {"Compare with", "Units", "Names", "Lengths in"}) EXPECT_THAT(drawnWords(), Contains(word));
    others.askOpen("Open a colour map", [](const std::vector<std::string>&) {});
    frames(4, [&] { others.draw(); });
    EXPECT_THAT(drawnWords(), Contains("Open a colour map"));
    for (const char* field : {"Units", "Names", "Lengths in"})
        EXPECT_THAT(drawnWords(), Not(Contains(field))) << "nothing can be stated of it";
}

TEST_F(Dialogs, APreviewListsParametersOrSaysWhatIsWrongWhere) {
    Jobs jobs;
    ImportForm form(jobs);
    const auto previewOf = [&](const std::string& name) {
        const std::string path = (folder / name).string();
        form.previewOf(path);
        jobs.wait();
        jobs.collect();
        return form.previewOf(path);
    };
    volume::Dataset cell = formula::makeCell();
    codec::pack(cell, {}, (folder / "cell.tsr").string());
    const FilePreview good = previewOf("cell.tsr");
    EXPECT_FALSE(good.failed);
    for (const char* line : {"\nT [K]  ", "\nc [mol/m3]  ", "\nU (vector) [m/s]  ", "\nregion  "})
        EXPECT_THAT(good.text, HasSubstr(line));
    std::ofstream(folder / "broken.tsr") << "no archive";
    std::ofstream(folder / "broken.tessera.json") << R"({"app": {"name": "tessera", "schema": 3}, "session": )";
    for (const char* name : {"broken.tsr", "broken.tessera.json"}) {
        const FilePreview bad = previewOf(name);
        EXPECT_TRUE(bad.failed) << name;
        EXPECT_THAT(bad.text, HasSubstr(name));
        EXPECT_THAT(bad.text, Not(HasSubstr(folder.string()))) << "the list shows the folder";
        EXPECT_GT(bad.text.size(), std::string(name).size() + 10) << "and the reason";
    }
}

} // namespace
} // namespace tessera::app
