#include "app/queries/derivative_query.h"
#include "app/views/curves/curves_data.h"
#include "app/views/transfer/transfer_pages.h"
#include "tests/app/drawn_text.h"
#include "tests/app/views_fixture.h"
#include "tests/app/workbench_fixture.h"

#include <filesystem>
#include <gmock/gmock.h>
#include <set>
#include <unistd.h>

/// What views write into their plots and what their buttons and drags do, read back from what a frame drew.
namespace tessera::app {
namespace {

using testing::Contains;

class WrittenViews : public ViewsTest {
protected:
    template <class View>
    void settle(const char* pane, View& view, void (*function)(ViewContext&, const std::string&, View&),
                ImVec2 size = {720, 560}) {
        for (int i = 0; i < 3 || (busy && i < 200); ++i) {
            jobs.wait();
            frame([&] { draw(pane, view, function, size); });
        }
    }
};

TEST_F(WrittenViews, CurvesLieAtTheirValuesAndBreakWhereThereIsNone) {
    volume::Dataset cell =
        volume::makeModel("fuel-cell", {{"nx", 7}, {"ny", 9}, {"nz", 21}, {"times", 4}, {"even", 1}});
    cell.info.quantities = {{"voltage", "V", {0.7, std::nan(""), 0.6, 0.4}}};
    show(volume::makeMemorySource(std::move(cell), {}));
    session.time = source->info().times[3];
    curvesView.x = "time";
    curvesView.y = {"voltage"};
    settle("curves", curvesView, drawCurvesView);
    const std::vector<std::string> words = drawnWords();
    for (const char* tick : {"0.40", "0.50", "0.60", "0.70"}) EXPECT_THAT(words, Contains(tick));
    EXPECT_THAT(words, Contains(testing::HasSubstr("voltage [V]  0.4")));
    // Dots from the highest to the lowest, as far apart as their values; none for the second state.
    std::vector<double> heights;
    const glm::vec3 color = plotInk(0, darkTheme());
    std::vector<ImVec2> ink = drawnIn(toColor({color.r, color.g, color.b}));
    ASSERT_FALSE(ink.empty());
    for (const ImVec2& corner : ink) ASSERT_TRUE(std::isfinite(corner.x) && std::isfinite(corner.y));
    std::ranges::sort(ink, {}, &ImVec2::x);
    const float radius = em() * 0.3f, left = ink.front().x, right = ink.back().x;
    const auto heightAround = [&](float x) {
        double sum = 0, count = 0;
        for (const ImVec2& corner : ink)
            if (std::abs(corner.x - x) < radius) sum += double(corner.y), ++count;
        return count > 0 ? sum / count : std::nan("");
    };
    const std::vector<double>& times = source->info().times;
    const auto place = [&](std::size_t t) {
        const float inner = em() * 0.18f; // the outer dots reach so far beyond their middles
        const double share = (times[t] - times[0]) / (times[3] - times[0]);
        return float(double(left + inner) + share * double(right - left - 2 * inner));
    };
    const double first = heightAround(place(0)), third = heightAround(place(2)), last = heightAround(place(3));
    EXPECT_TRUE(std::isnan(heightAround(place(1))));
    EXPECT_NEAR((third - first) / (last - first), 1.0 / 3, 0.03);
}

TEST_F(WrittenViews, TheMapOfBoundariesHasRoomForItsTitlesAndEmphasisOnBothSides) {
    show(fuelCell(volume::LatticeKind::CC));
    const volume::DatasetInfo& info = source->info();
    const int index = *info.findChannel("T");
    BoundaryPage page;
    const auto result = std::make_shared<DerivativeResult>();
    result->curves.thickness = 3;
    result->curves.range = info.channelRange(info.channel(index));
    result->curves.distance.assign(16, 0.5);
    result->curves.first.assign(16, 1);
    for (int i = 0; i < 2; ++i)
        frame([&] {
            ViewContext context{session, source, renderer, jobs, caches};
            ImGui::SetNextWindowPos({0, 0});
            ImGui::SetNextWindowSize({900, 500});
            ImGui::Begin("boundary", nullptr, ImGuiWindowFlags_NoDecoration);
            drawBoundaryPage(context, page, session.transfer["T"], info, index, result);
            ImGui::End();
        });
    const std::vector<DrawnText> texts = drawnTexts();
    std::multiset<std::string> words;
    for (const DrawnText& text : texts) {
        EXPECT_GE(text.min.x, 0) << text.text;
        EXPECT_LE(text.max.y, 500) << text.text;
        words.insert(text.text);
    }
    for (const char* title : {"distance p [cells]", "opacity b", "distance from the boundary [cells]", "T [K]"})
        EXPECT_EQ(words.count(title), 1u) << title;
    std::size_t below = 0; // up the left plot and along the right one
    for (const std::string& word : words)
        if (word.starts_with("-")) {
            ++below;
            EXPECT_EQ(words.count(word), words.count(word.substr(1))) << word;
        }
    EXPECT_GE(below, 2u);
}

TEST_F(WrittenViews, ALensIsTurnedInsideOutInItsRow) {
    show(fuelCell(volume::LatticeKind::CC));
    layersView.task = SceneTask::Lenses;
    session.lenses.resize(1);
    session.lenses[0].name = "lens";
    settle("layers", layersView, drawLayersView);
    const std::string sign = fonts.icons ? icons::kInvert.glyph : icons::kInvert.word;
    const auto click = [&](ImVec2 at) {
        mouse = at;
        for (const bool down : {false, true, false}) {
            ImGui::GetIO().MouseDown[0] = down;
            frame([&] { draw("layers", layersView, drawLayersView, {720, 560}); });
        }
    };
    for (const bool inverted : {true, false}) {
        const std::vector<DrawnText> texts = drawnTexts();
        const auto button = std::ranges::find(texts, sign, &DrawnText::text);
        ASSERT_NE(button, texts.end());
        click(button->middle());
        EXPECT_EQ(session.lenses[0].inverted, inverted);
    }
}

TEST_F(WrittenViews, ADragOverSectionsTakesTheCursorToTheirPlanes) {
    show(fuelCell(volume::LatticeKind::CC));
    profileView.over = ProfileOver::Sections;
    profileView.sections.across = SectionAcross::Z;
    settle("profile", profileView, drawProfileView);
    const auto drawFrame = [&] { frame([&] { draw("profile", profileView, drawProfileView, {720, 560}); }); };
    mouse = {300, 300};
    drawFrame();
    ImGui::GetIO().MouseDown[0] = true;
    drawFrame();
    std::vector<double> places;
    for (float x = 20; x < 720; x += 10) {
        mouse.x = x;
        drawFrame();
        places.push_back(session.cursor.z);
    }
    ImGui::GetIO().MouseDown[0] = false;
    const volume::Lattice& lattice = source->info().lattice; // of cells: planes go through their middles
    EXPECT_TRUE(std::is_sorted(places.begin(), places.end()));
    EXPECT_GT(std::set<double>(places.begin(), places.end()).size(), 30u);
    EXPECT_NEAR(places.front(), lattice.position(glm::ivec3(0)).z, 1e-9);
    EXPECT_NEAR(places.back(), lattice.position(lattice.size - 1).z, 1e-9);
}

class WrittenDown : public DrawnWorkbench {
protected:
    WrittenDown() : DrawnWorkbench({.stateFolder = folder(), .autosaveInterval = std::chrono::milliseconds(1)}) {}
    void TearDown() override { std::filesystem::remove_all(folder()); }
    static std::string folder() {
        const auto path = std::filesystem::path(testing::TempDir()) / ("written_" + std::to_string(::getpid()));
        std::filesystem::create_directories(path);
        return path.string();
    }
    static std::filesystem::path kept() {
        return std::filesystem::path(folder()) / ("autosave-" + std::to_string(::getpid()) + ".tessera.json");
    }
};

TEST_F(WrittenDown, EditsAreKeptOnceAndAgainWhenThereAreOthers) {
    workbench.install(smallData(12));
    settle();
    ASSERT_FALSE(std::filesystem::exists(kept()));
    for (const char* edit : {"first", "second"}) {
        addBrush(edit);
        settle();
        EXPECT_TRUE(std::filesystem::exists(kept())) << edit;
        std::filesystem::remove(kept());
        std::this_thread::sleep_for(std::chrono::milliseconds(3));
        settle();
        EXPECT_FALSE(std::filesystem::exists(kept())) << "nothing has changed since";
    }
}

TEST_F(WrittenDown, NamesOfRegionsThatComeWithTheDataAreShownAtOnce) {
    OpenRequest request;
    request.data.emplace();
    request.data->model = "fuel-cell";
    request.data->settings = {{"nx", 7}, {"ny", 9}, {"nz", 21}, {"times", 2}};
    request.data->import.labels = {"region:1=somewhere"};
    Opened opened = open(request);
    const auto source = opened.source;
    workbench.install(std::move(opened));
    settle();
    EXPECT_EQ(workbench.session().data.import.labels.size(), 1u);
    EXPECT_EQ(workbench.source(), source) << "not opened again";
}

} // namespace
} // namespace tessera::app
