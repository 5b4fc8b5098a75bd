#include "app/data/library.h"
#include "app/pane/view_parts.h"
#include "app/session/own_functions.h"
#include "app/user_files/own_functions.h"
#include "app/views/transfer/library_page.h"
#include "tests/app/formula_cell.h"
#include "tests/app/hands_fixture.h"
#include "tests/app/views_fixture.h"
#include "volume/base/error.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <unistd.h>

/// The library of transfer functions: applied by name, and as pictures that the mouse picks from.
namespace tessera::app {
namespace {

namespace fs = std::filesystem;

TEST(Library, AppliesByNameToTheFirstLayerOrAParameter) {
    const auto source = fuelCell(volume::LatticeKind::CC);
    const volume::DatasetInfo& info = source->info();
    Session session = defaultSession(info, {});
    const std::string first = functionOfLayer(session, info, 0)->function;
    applyNamed(session, *source, "ct-BONE", {});
    const auto bone = *std::ranges::find(vis::transferLibrary(), "CT bone", &vis::TransferRecipe::name);
    const int channel = *info.findChannel(first);
    EXPECT_EQ(session.transfer[first],
              vis::madeFrom(bone, readDistribution(*source, channel, 0), info.channel(channel).unit));
    const vis::TransferFunction before = session.transfer["T"];
    applyNamed(session, *source, "T=Temperature", {});
    EXPECT_NE(session.transfer["T"], before);
    vis::TransferRecipe mine = bone;
    mine.name = "CT bone";
    mine.colormap = "magma";
    mine.colors.clear();
    applyNamed(session, *source, "CT bone", std::vector{mine});
    EXPECT_EQ(session.transfer[first].colormap, "magma") << "one's own comes first";
    session.layers.clear();
    EXPECT_THROW(applyNamed(session, *source, "gas", {}), Error);
    EXPECT_THROW(applyNamed(session, *source, "nowhere=gas", {}), Error);
    try {
        applyNamed(session, *source, "T=gaz", std::vector{mine});
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("CT skin"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("gaz"), std::string::npos);
    }
}

TEST(Library, ADistributionIsThatOfItsChannel) {
    const auto source = volume::makeMemorySource(formula::makeCell(), {});
    const volume::DatasetInfo& info = source->info();
    for (const char* name : {"T", "c", "|U|"}) {
        const vis::ValueDistribution values = readDistribution(*source, *info.findChannel(name), 1);
        EXPECT_FLOAT_EQ(float(values.range.lo), float(formula::rangeOf(name).lo)) << name;
        EXPECT_FLOAT_EQ(float(values.range.hi), float(formula::rangeOf(name).hi)) << name;
        double samples = 0, wanted = 0;
        for (const auto count : values.count) samples += double(count);
        formula::forEachPlace([&](formula::Place at) { wanted += formula::value(name, at, 1).has_value(); });
        EXPECT_EQ(samples, wanted) << name;
    }
}

TEST(Library, TheSelectedLayerIsThatOfTheList) {
    const auto source = fuelCell(volume::LatticeKind::CC);
    Session session = defaultSession(source->info(), {});
    session.layers = {{"a", true, vis::VolumeLayer{.channel = "O2"}},
                      {"b", true, vis::IsoLayer{.channel = "O2", .colorBy = "T"}, "", "b's own"}};
    EXPECT_EQ(selectedLayer(session), 0u);
    session.views["layers"] = LayersView{.selected = 1};
    EXPECT_EQ(selectedLayer(session), 1u);
    session.views["layers"] = LayersView{.selected = 7};
    EXPECT_EQ(selectedLayer(session), 0u);
    EXPECT_EQ(functionOfLayer(session, source->info(), 1)->function, "b's own");
    EXPECT_EQ(functionOfLayer(session, source->info(), 1)->channel, *source->info().findChannel("T"));
    EXPECT_FALSE(functionOfLayer(session, source->info(), 2));
}

class LibraryHands : public Hands {};

TEST_F(LibraryHands, AClickAppliesAPictureAndIsOneEdit) {
    TransferView library;
    library.library = true;
    show(library, {900, 700});
    const auto at = pictures();
    const volume::DatasetInfo& info = workbench.source()->info();
    const auto to = functionOfLayer(session(), info, 0);
    ASSERT_TRUE(to);
    std::vector<vis::TransferRecipe> listed;
    for (const bool scan : {false, true}) // computed fields first, since the cell is one
        for (const vis::TransferRecipe& recipe : vis::transferLibrary())
            if (recipe.scan == scan && vis::suits(recipe, info.channelRange(info.channel(to->channel))))
                listed.push_back(recipe);
    ASSERT_EQ(at.size(), listed.size()) << "a picture of each, drawn at once without a window";
    const Session before = session();
    const std::size_t steps = this->steps();
    click(within(at[2], 0.5, 0.5));
    EXPECT_EQ(this->steps(), steps + 1);
    const auto values = readDistribution(*workbench.source(), to->channel, info.nearestTime(before.time));
    EXPECT_EQ(session().transfer[to->function], vis::madeFrom(listed[2], values, info.channel(to->channel).unit));
    undo();
    frame();
    EXPECT_EQ(session().transfer, before.transfer);
}

/// The page in a window of its own, with a folder for the user's functions.
class LibraryPageTest : public ViewsTest {
protected:
    void SetUp() override {
        ViewsTest::SetUp();
        show(fuelCell(volume::LatticeKind::CC));
        fs::create_directories(folder);
    }
    void TearDown() override { fs::remove_all(folder); }
    /// One frame; `idle`: nothing else is to be drawn.
    void drawPage(bool idle = true, float width = 600) {
        frame([&] {
            ViewContext context{session, source, renderer, jobs, caches};
            context.headless = headless;
            context.stateFolder = folder;
            context.idle = idle;
            ImGui::SetNextWindowPos({0, 0});
            ImGui::SetNextWindowSize({width, 1000});
            ImGui::Begin("page", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
            drawLibraryPage(context, page, "T", *source->info().findChannel("T"));
            ImGui::End();
            waiting = context.answers.postponed;
            said = context.answers.messages;
        });
        jobs.wait();
        jobs.collect();
    }
    std::size_t pictures() const {
        std::size_t found = 0;
        const ImDrawData& data = *ImGui::GetDrawData();
        for (int l = 0; l < data.CmdListsCount; ++l)
            for (const ImDrawCmd& command : data.CmdLists[l]->CmdBuffer)
                found += command.TextureId != ImGui::GetIO().Fonts->TexID ? command.ElemCount / 6 : 0;
        return found;
    }

    const std::string folder = (fs::path(testing::TempDir()) / ("library_" + std::to_string(::getpid()))).string();
    LibraryPage page;
    bool waiting = false;
    std::vector<std::string> said;
};

TEST_F(LibraryPageTest, PicturesWaitUntilNothingElseIsDrawn) {
    headless = false;
    for (int i = 0; i < 4; ++i) drawPage(false);
    EXPECT_EQ(pictures(), 0u);
    EXPECT_TRUE(waiting);
    std::size_t most = 0;
    for (int i = 0; i < 2000 && waiting; ++i) {
        const std::size_t before = pictures();
        drawPage();
        most = std::max(most, pictures() - before);
    }
    EXPECT_FALSE(waiting);
    EXPECT_LE(most, 1u) << "one at a time";
    drawPage(false); // shows the last one
    const std::size_t all = pictures();
    EXPECT_GE(all, 12u);
    drawPage(false);
    EXPECT_EQ(pictures(), all) << "kept";
}

TEST_F(LibraryPageTest, OnesOwnAreShownAndSaidWhenBroken) {
    for (int i = 0; i < 3; ++i) drawPage();
    const std::size_t shipped = pictures();
    session.transfer["T"].opacity = {{0, 0}, {0.7f, 0.1f}, {1, 1}};
    const vis::ValueDistribution values = readDistribution(*source, *source->info().findChannel("T"), 0);
    saveOwnFunction(folder, vis::recipeOf("mine", session.transfer["T"], values));
    page.loaded = false;
    for (int i = 0; i < 3; ++i) drawPage();
    EXPECT_EQ(pictures(), shipped + 1);
    std::ofstream(folder + "/transfer-functions.json") << "{";
    page.loaded = false;
    drawPage();
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("transfer-functions.json"), std::string::npos);
    drawPage();
    EXPECT_TRUE(said.empty()) << "once";
}

TEST_F(LibraryPageTest, PicturesWaitWhileTheHandMoves) {
    headless = false;
    drawPage();
    for (int i = 0; i < 2000 && pictures() == 0; ++i) drawPage();
    ASSERT_GT(pictures(), 0u) << "it rests";
    drawPage();
    mouse = {100, 100};
    drawPage();
    const std::size_t made = pictures();
    for (int i = 0; i < 30; ++i) {
        mouse.x += 5;
        drawPage();
    }
    EXPECT_TRUE(waiting);
    EXPECT_LE(pictures(), made + 1) << "what was made before it moved";
    for (int i = 0; i < 2000 && pictures() <= made + 1; ++i) drawPage();
    EXPECT_GT(pictures(), made + 1);
}

TEST_F(LibraryPageTest, TwoPicturesStandBesideEachOtherWhereTheyShowSomething) {
    const auto columns = [&](float width) {
        for (int i = 0; i < 3; ++i) drawPage(true, width);
        std::set<int> lefts;
        const ImDrawData& data = *ImGui::GetDrawData();
        for (int l = 0; l < data.CmdListsCount; ++l)
            for (const ImDrawCmd& command : data.CmdLists[l]->CmdBuffer) {
                if (command.TextureId == ImGui::GetIO().Fonts->TexID) continue;
                const auto first = data.CmdLists[l]->IdxBuffer[int(command.IdxOffset)];
                lefts.insert(int(data.CmdLists[l]->VtxBuffer[int(command.VtxOffset) + int(first)].pos.x));
            }
        return lefts.size();
    };
    const float em = fonts.text->FontSize;
    EXPECT_EQ(columns(12 * em), 2u);
    EXPECT_EQ(columns(7 * em), 1u) << "else one that can be seen";
}

} // namespace
} // namespace tessera::app
