#include "app/dialogs/machine_dialog.h"
#include "app/ui/theme.h"
#include "app/user_files/machines.h"
#include "codec/remote/consent.h"
#include "tests/app/drawn_text.h"
#include "tests/app/fed_imgui.h"
#include "tests/app/open_fixture.h"

#include <gmock/gmock.h>

namespace tessera::app {
namespace {

using testing::Contains;
using testing::HasSubstr;

class MachineQuestion : public FedImGui {
protected:
    MachineQuestion() : FedImGui({900, 700}) {}
    void SetUp() override {
        fonts = loadFonts(1);
        applyTheme(Theme::Dark, 1);
        for (const char* const machine : {"https://one.org", "sftp://two", "https://one.org"})
            dialog.show({"Opening " + std::string(machine), machine, {}});
    }
    void draw() {
        if (auto made = dialog.draw()) decisions.push_back(std::move(*made));
    }
    void answer(const std::string& button) {
        const auto each = [this] { draw(); };
        frames(4, each);
        for (const DrawnText& text : drawnTexts())
            if (text.text == button) return click(text.middle(), each);
        ADD_FAILURE() << "not drawn: " << button;
    }
    Fonts fonts;
    MachineDialog dialog;
    std::vector<MachineDialog::Decision> decisions;
};

TEST_F(MachineQuestion, NamesTheMachineAndWhatItIsAskedFor) {
    frames(4, [this] { draw(); });
    EXPECT_THAT(drawnWords(), Contains(HasSubstr("https://one.org")));
    EXPECT_THAT(drawnWords(), Contains(HasSubstr("Opening")));
    EXPECT_TRUE(decisions.empty()) << "nothing is decided by drawing it";
}

TEST_F(MachineQuestion, IsAskedOncePerMachine) {
    answer("Open");
    ASSERT_EQ(decisions.size(), 1u);
    EXPECT_EQ(decisions[0].answer, MachineDialog::Answer::Once);
    EXPECT_EQ(decisions[0].jobs.size(), 2u) << "both that wait for it";
    answer("Always");
    ASSERT_EQ(decisions.size(), 2u);
    EXPECT_EQ(decisions[1].answer, MachineDialog::Answer::Always);
    EXPECT_EQ(decisions[1].jobs[0].machine, "sftp://two");
    EXPECT_FALSE(dialog.shown());
}

TEST_F(MachineQuestion, EnterEscAndTheButtonSayNo) {
    const auto each = [this] { draw(); };
    const auto press = [&](int key) {
        frames(4, each);
        for (const bool down : {true, false}) feed([&] { each(); }), feedKey(ImGui::GetIO(), key, down), feed(each);
    };
    press(key::kEnter);
    ASSERT_EQ(decisions.size(), 1u);
    EXPECT_EQ(decisions[0].answer, MachineDialog::Answer::No);
    press(key::kEscape);
    ASSERT_EQ(decisions.size(), 2u);
    EXPECT_EQ(decisions[1].answer, MachineDialog::Answer::No);
    dialog.show({"Opening", "https://three", {}});
    answer("No");
    ASSERT_EQ(decisions.size(), 3u);
    EXPECT_EQ(decisions[2].answer, MachineDialog::Answer::No);
}

TEST(JobsTest, OneThatMayNotAskAMachineIsStartedAgainWhereTheUserAllowsIt) {
    codec::requireConsent([](const std::string&) { return false; });
    Jobs jobs;
    int finished = 0;
    const auto work = [&](const Progress&) -> Jobs::Finish {
        codec::requireAllowed(codec::parseAddress("sftp://jobs.example/a.tsr"));
        return [&] { ++finished; };
    };
    const auto collected = [&] {
        jobs.wait();
        return jobs.collect();
    };
    jobs.start("open", "Opening a", work);
    EXPECT_THAT(collected(), testing::ElementsAre(HasSubstr("nobody has allowed"))) << "nobody to ask";
    std::vector<Jobs::Refused> refused;
    jobs.refused = [&](Jobs::Refused job) { refused.push_back(std::move(job)); };
    jobs.start("open", "Opening a", work);
    EXPECT_TRUE(collected().empty());
    ASSERT_EQ(refused.size(), 1u);
    EXPECT_EQ(refused[0].machine, "sftp://jobs.example");
    EXPECT_EQ(refused[0].title, "Opening a");
    EXPECT_EQ(finished, 0);
    codec::allowMachine(refused[0].machine);
    refused[0].again();
    EXPECT_TRUE(collected().empty());
    EXPECT_EQ(finished, 1);
    codec::allowAllMachines();
}

TEST_F(OpenTest, MachinesThatTheUserNamesAreKnownLater) {
    const std::string state = folder.string();
    EXPECT_FALSE(isKnownMachine(state, "sftp://two"));
    allowNamed({"--option", "a.tsr", "sftp://me@Two/a.tsr", "http://-bad/a", "sftp://two/b.tsr"}, state);
    EXPECT_TRUE(isKnownMachine(state, "sftp://two"));
    EXPECT_FALSE(isKnownMachine(state, "https://two"));
    EXPECT_FALSE(isKnownMachine("", "sftp://two"));
    std::ofstream(folder / "machines.json") << "broken [";
    EXPECT_FALSE(isKnownMachine(state, "sftp://two"));
    rememberMachine(state, "https://x");
    EXPECT_TRUE(isKnownMachine(state, "https://x"));
    rememberMachine("/proc/none", "https://x"); // harmless
}

} // namespace
} // namespace tessera::app
