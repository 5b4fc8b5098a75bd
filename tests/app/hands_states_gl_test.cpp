#include "app/pane/plot.h"
#include "app/ui/time_text.h"
#include "app/values/plot.h"
#include "tests/app/hands_fixture.h"

#include <algorithm>

/// The mouse where several times come into one plot, and where a difference becomes a picture.
namespace tessera::app {
namespace {

class StateHands : public Hands {
protected:
    /// Clicks an item of the list or menu in front.
    void choose(const std::vector<std::variant<std::string, int>>& path) {
        click(item(popup(), path).GetCenter());
        ++clicks;
    }
    void open(ImRect at) {
        click(at.GetCenter());
        frame(), frame();
        ++clicks;
    }
    static ImU32 ink(std::size_t n, std::size_t count) {
        const glm::vec3 color = stateInk(n, count, darkTheme());
        return toColor({double(color.r), double(color.g), double(color.b)});
    }
    int clicks = 0;
};

TEST_F(StateHands, AnotherTimeIsOneTickInAProfile) {
    ProfileView profile;
    profile.channels = {"T", "c"};
    show(profile, {1000, 600});
    EXPECT_GT(inked(ink(0, 2)).Min.x, inked(ink(0, 2)).Max.x) << "one time, no family";
    open(inPane({"##times"}));
    choose({stateText(workbench.document().info(), 2) + "##2"});
    EXPECT_EQ(view<ProfileView>().times, (std::vector<double>{0.5, 2})) << "the time shown stays";
    EXPECT_LE(clicks, 3) << "View > New takes two more";
    settle();
    for (const std::size_t n : {0u, 1u}) EXPECT_LT(inked(ink(n, 2)).Min.x, inked(ink(n, 2)).Max.x) << n;
    EXPECT_EQ(steps(), 1u);
    undo();
    EXPECT_TRUE(view<ProfileView>().times.empty());
}

TEST_F(StateHands, SectionAveragesHaveAFamilyToo) {
    ProfileView profile;
    profile.channels = {"T"};
    profile.over = ProfileOver::Sections;
    show(profile, {1000, 600});
    open(inPane({"##times"}));
    choose({"Every time"});
    EXPECT_EQ(view<ProfileView>().times, (std::vector<double>{0, 0.5, 2}));
    settle();
    for (const std::size_t n : {0u, 1u, 2u}) EXPECT_LT(inked(ink(n, 3)).Min.x, inked(ink(n, 3)).Max.x) << n;
}

TEST_F(StateHands, ADifferenceIsAPictureAtOnce) {
    show(DataView{}, {500, 900}, [](Session& edited) {
        edited.layers = {{"c", true, vis::VolumeLayer{.channel = "c"}}};
        edited.time = 0;
    });
    open(item(window("data"), {"Minus another time..."}));
    choose({"T"});
    frame(), frame();
    choose({"T minus first"});
    EXPECT_LE(clicks, 4);
    settle();
    EXPECT_EQ(vis::shownChannel(session().layers[0].technique), "T minus first");
    EXPECT_TRUE(session().transfer.at("T minus first").aboutZero);
    EXPECT_EQ(session().time, 2) << "at the first time it is 0 throughout";
    EXPECT_TRUE(workbench.source()->info().findChannel("T minus first"));
    undo();
    EXPECT_TRUE(session().data.derived.empty());
}

} // namespace
} // namespace tessera::app
