#include "app/edits/compare.h"
#include "app/workbench/workbench_commands.h"
#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "tests/app/workbench_fixture.h"
#include "tests/resident_memory.h"
#include "volume/synthetic/models.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>
#include <unistd.h>
#include <vector>

namespace tessera::app {
namespace {

namespace fs = std::filesystem;

/// A folder of its own as the current one, with a raw file in it.
struct WorkbenchData : DrawnWorkbench {
    WorkbenchData() : DrawnWorkbench({.program = std::string(TESSERA_BINARY_DIR) + "/tessera"}) {}
    void SetUp() override {
        fs::create_directories(folder);
        fs::current_path(folder);
        std::ofstream file("ramp.raw", std::ios::binary);
        for (int i = 0; i < 8 * 9 * 10; ++i) file.put(static_cast<char>(i / 3));
    }
    void TearDown() override {
        fs::current_path(before);
        fs::remove_all(folder);
    }
    void showRamp() {
        OpenRequest request;
        request.paths = {(folder / "ramp.raw").string()};
        request.import.emplace();
        request.import->raw = "dims=8x9x10,type=u8";
        workbench.install(open(request));
        settle();
    }
    /// Answers the dialog of the command; the job has begun when it returns.
    void startPacking() {
        ASSERT_TRUE(run("Pack into an archive..."));
        for (int i = 0; i < 3; ++i) frame();
        frame([](ImGuiIO& io) { feedKey(io, key::kEnter, true); });
        ASSERT_TRUE(workbench.jobs().running("pack"));
    }
    std::string shownFile() const {
        const auto& files = workbench.session().data.files;
        return files.empty() ? "" : fs::path(files[0].absolutePath).filename().string();
    }

    fs::path before = fs::current_path();
    fs::path folder = fs::path(testing::TempDir()) / ("workbench_data_" + std::to_string(::getpid()));
};

TEST_F(WorkbenchData, WhatIsEditedWhilePackingStays) {
    showRamp();
    workbench.session().title = "before";
    settle();
    startPacking();
    addBrush("meanwhile");
    settle();
    EXPECT_EQ(shownFile(), "ramp.tsr");
    ASSERT_EQ(workbench.session().selection.brushes.size(), 1u);
    EXPECT_EQ(workbench.history().data(), workbench.session().data);
    ASSERT_TRUE(run("Undo"));
    settle();
    EXPECT_TRUE(workbench.session().selection.brushes.empty());
    EXPECT_EQ(workbench.session().title, "before");
    ASSERT_TRUE(run("Undo"));
    settle();
    EXPECT_NE(workbench.session().title, "before");
    EXPECT_EQ(shownFile(), "ramp.tsr") << "where the data lie is no edit";
    ASSERT_TRUE(run("Redo"));
    ASSERT_TRUE(run("Redo"));
    EXPECT_EQ(workbench.session().selection.brushes.back().name, "meanwhile");
}

TEST_F(WorkbenchData, WhatIsOpenedWhilePackingStays) {
    showRamp();
    startPacking();
    workbench.install(smallData());
    addBrush("of the other data");
    settle();
    EXPECT_TRUE(fs::exists("ramp.tsr"));
    EXPECT_EQ(workbench.session().data.model, "marschner-lobb");
    EXPECT_EQ(workbench.session().selection.brushes.size(), 1u);
    EXPECT_TRUE(workbench.source()->info().findChannel("rho").has_value());
}

constexpr const char* kOnGrid = "Draw on the grid of the file";
constexpr const char* kBodyCentred = "Draw on the body-centred lattice (70.7 % of the samples)";

// A parameter derived meanwhile is of the new data when they come.
TEST_F(WorkbenchData, WhatIsEditedWhileResamplingStays) {
    workbench.install(smallData());
    settle();
    ASSERT_EQ(workbench.session().data.lattice, PictureLattice::BodyCentred);
    ASSERT_EQ(workbench.source()->grid().lattice.kind, volume::LatticeKind::BCC);
    const auto numbers = workbench.numbers();
    EXPECT_EQ(numbers->grid().lattice.kind, volume::LatticeKind::CC);
    ASSERT_TRUE(run(kOnGrid));
    addBrush("meanwhile");
    workbench.session().data.derived = {{"twice", "", volume::ExpressionRecipe{"2*rho"}}};
    settle();
    EXPECT_EQ(workbench.session().data.lattice, PictureLattice::Grid);
    EXPECT_EQ(workbench.source()->grid().lattice.kind, volume::LatticeKind::CC);
    EXPECT_EQ(workbench.source(), workbench.numbers());
    EXPECT_TRUE(workbench.source()->info().findChannel("twice").has_value());
    EXPECT_EQ(workbench.session().selection.brushes.size(), 1u);
    while (run("Undo")) settle();
    EXPECT_TRUE(workbench.session().selection.brushes.empty());
    EXPECT_FALSE(workbench.source()->info().findChannel("twice").has_value());
    EXPECT_EQ(workbench.session().data.lattice, PictureLattice::BodyCentred);
    EXPECT_EQ(workbench.source()->grid().lattice.kind, volume::LatticeKind::BCC);
    EXPECT_EQ(workbench.numbers(), numbers) << "nothing is read or derived again for a lattice";
}

TEST_F(WorkbenchData, TheLatticeIsAStepOfTheHistory) {
    workbench.install(smallData());
    settle();
    const auto kind = [&] { return workbench.source()->grid().lattice.kind; };
    ASSERT_TRUE(run(kOnGrid));
    settle();
    ASSERT_EQ(workbench.history().steps().size(), 1u);
    EXPECT_EQ(workbench.history().steps().back().name, "data: lattice");
    EXPECT_EQ(kind(), volume::LatticeKind::CC);
    ASSERT_TRUE(run("Undo"));
    settle();
    EXPECT_EQ(kind(), volume::LatticeKind::BCC);
    ASSERT_TRUE(run("Redo"));
    settle();
    EXPECT_EQ(kind(), volume::LatticeKind::CC);
    ASSERT_TRUE(run(kBodyCentred));
    settle();
    EXPECT_EQ(kind(), volume::LatticeKind::BCC);
}

TEST_F(WorkbenchData, OneGridOfAnArchiveInSpaceAndTimeIsAStepOfTheHistory) {
    volume::Dataset cell =
        volume::makeModel("fuel-cell", {{"nx", 9}, {"ny", 11}, {"nz", 23}, {"times", 8}, {"even", 1}});
    codec::PackOptions options;
    options.lattice = codec::StoredLattice::D4;
    codec::pack(cell, options, (folder / "d4.tsr").string());
    OpenRequest request;
    request.paths = {(folder / "d4.tsr").string()};
    Opened opened = open(request);
    opened.document.session.time = cell.info.times[0]; // it opens where more varies
    opened.document.history.reset(opened.document.session);
    workbench.install(std::move(opened));
    settle();
    const auto info = [&]() -> const volume::DatasetInfo& { return workbench.source()->info(); };
    const std::vector<double> all = info().times;
    const std::vector<double> stored = codec::Archive((folder / "d4.tsr").string()).info().times;
    EXPECT_EQ(all, cell.info.times);
    ASSERT_EQ(info().lattice.kind, volume::LatticeKind::BCC);
    ASSERT_TRUE(run("Second grid of D4* or BCC alone, as stored"));
    settle();
    EXPECT_EQ(workbench.session().time, stored[1]);
    EXPECT_EQ(workbench.document().history().steps().size(), 1u) << "the time is no step of its own";
    ASSERT_TRUE(run("Undo"));
    settle();
    EXPECT_EQ(workbench.session().time, all[0]);
    ASSERT_TRUE(run("Redo"));
    settle();
    EXPECT_EQ(workbench.session().time, stored[1]);
    EXPECT_EQ(workbench.document().history().steps().size(), 1u);
    while (run("Undo")) settle();
    ASSERT_TRUE(run("First grid of D4* or BCC alone, as stored"));
    settle();
    EXPECT_EQ(info().lattice.kind, volume::LatticeKind::CC);
    EXPECT_EQ(info().times.size(), (stored.size() + 1) / 2);
    EXPECT_EQ(info().times[1], stored[2]);
    ASSERT_TRUE(run("Second grid of D4* or BCC alone, as stored"));
    settle();
    EXPECT_EQ(info().times[0], stored[1]);
    ASSERT_TRUE(run("Both grids of D4* or BCC"));
    settle();
    EXPECT_EQ(info().times, all);
    ASSERT_TRUE(run("First grid of D4* or BCC alone, as stored"));
    settle();
    ASSERT_EQ(info().lattice.kind, volume::LatticeKind::CC);
    while (run("Undo")) settle();
    EXPECT_EQ(workbench.session().data.grids, ShownGrids::Both);
    EXPECT_EQ(info().times, all);
    EXPECT_EQ(info().lattice.kind, volume::LatticeKind::BCC);
    // There is nothing to choose elsewhere.
    showRamp();
    EXPECT_FALSE(run("First grid of D4* or BCC alone, as stored"));
}

struct WorkbenchMemory : DrawnWorkbench {
    WorkbenchMemory() : DrawnWorkbench({.stateFolder = made()}) {}
    static std::string made() {
        const fs::path path = fs::path(testing::TempDir()) / ("workbench_memory_" + std::to_string(::getpid()));
        fs::create_directories(path);
        return path.string();
    }
    void TearDown() override { fs::remove_all(made()); }
    void openModel(const char* model) {
        OpenRequest request;
        request.data.emplace();
        request.data->model = model;
        request.data->settings = {{"nx", 12}, {"ny", 12}, {"nz", 12}};
        workbench.open(request);
        settle();
    }
};

TEST_F(WorkbenchMemory, TheLatticeChosenHoldsForDataOpenedLater) {
    openModel("marschner-lobb");
    EXPECT_EQ(workbench.source()->grid().lattice.kind, volume::LatticeKind::BCC);
    ASSERT_TRUE(run(kOnGrid));
    settle();
    EXPECT_EQ(rememberedChoice(made(), "lattice"), "grid");
    workbench.install(smallData(16)); // nothing to save
    settle();
    openModel("marschner-lobb");
    EXPECT_EQ(workbench.session().data.lattice, PictureLattice::Grid);
    EXPECT_EQ(workbench.source(), workbench.numbers());
    std::ofstream(made() + "/choices.json") << "{broken";
    EXPECT_EQ(rememberedChoice(made(), "lattice"), "");
}

// Taken back or cancelled, it comes when it is wanted again.
TEST_F(WorkbenchData, AParameterWhoseMakingWasCancelledComesWhenItIsWantedAgain) {
    workbench.install(smallData());
    settle();
    const auto known = [&] { return workbench.source()->info().findChannel("twice").has_value(); };
    workbench.session().data.derived = {{"twice", "", volume::ExpressionRecipe{"2*rho"}}};
    frame();
    ASSERT_TRUE(workbench.jobs().running("derive"));
    ASSERT_TRUE(run("Cancel jobs"));
    settle();
    EXPECT_FALSE(known());
    ASSERT_TRUE(run("Undo"));
    settle();
    ASSERT_TRUE(run("Redo"));
    frame();
    ASSERT_TRUE(workbench.jobs().running("derive"));
    ASSERT_TRUE(run("Undo"));
    settle();
    EXPECT_FALSE(known());
    ASSERT_TRUE(run("Redo"));
    settle();
    EXPECT_TRUE(known());
}

TEST_F(WorkbenchData, CancelJobsLeavesThoseThatAreNotListed) {
    workbench.install(smallData());
    settle();
    const auto untilStopped = [](const Progress& progress) -> Jobs::Finish {
        while (true) {
            progress.advance(0.5);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    };
    const auto start = [&](const char* key, bool quiet) { workbench.jobs().start(key, key, untilStopped, quiet); };
    start("unlisted", true);
    EXPECT_FALSE(run("Cancel jobs")) << "nothing that a user sees runs";
    start("one", false);
    start("other", false);
    EXPECT_TRUE(run("Cancel jobs"));
    for (const char* key : {"one", "other"}) EXPECT_FALSE(workbench.jobs().running(key)) << key;
    EXPECT_TRUE(workbench.jobs().running("unlisted"));
    workbench.jobs().cancel("unlisted");
    settle();
    EXPECT_TRUE(workbench.jobs().list().empty());
}

// Two clicks or a word in the palette: a parameter, its colours, and one step to take both back.
TEST_F(WorkbenchData, ADifferenceFromTheFirstTimeIsOneStep) {
    OpenRequest request;
    request.data.emplace();
    request.data->model = "marschner-lobb";
    request.data->settings = {{"nx", 12}, {"ny", 12}, {"nz", 12}, {"times", 3}};
    workbench.install(open(request));
    settle();
    const Session start = workbench.session();
    ASSERT_TRUE(run("Minus another time: first"));
    settle();
    ASSERT_TRUE(workbench.source()->info().findChannel("rho minus first"));
    EXPECT_TRUE(workbench.session().transfer.at("rho minus first").aboutZero);
    ASSERT_TRUE(run("Undo"));
    settle();
    EXPECT_TRUE(workbench.session() == start);
    EXPECT_FALSE(workbench.source()->info().findChannel("rho minus first"));
}

/// A file beside the one shown; each has one parameter, whatever its name.
struct ComparedFiles : WorkbenchData {
    void SetUp() override {
        WorkbenchData::SetUp();
        std::ofstream("other.raw", std::ios::binary) << std::string(8 * 9 * 10, '\x05');
        std::ofstream("other.json") << R"({"dims": [8, 9, 10], "dtype": "uint8"})";
        std::ofstream("ramp.json") << R"({"dims": [8, 9, 10], "dtype": "uint8"})";
        OpenRequest request;
        request.paths = {(folder / "ramp.raw").string()};
        request.import.emplace();
        request.import->rename = {{"value", "slope"}};
        workbench.install(open(request));
        settle();
        start = workbench.session();
    }
    void compare() {
        compareWithFiles(workbench, {(folder / "other.raw").string()});
        settle();
    }
    const CompareView* comparison() const {
        for (const auto& [pane, view] : workbench.session().views)
            if (const auto* compare = std::get_if<CompareView>(&view)) return compare;
        return nullptr;
    }
    bool knows(const std::string& name) const { return workbench.source()->info().findChannel(name).has_value(); }

    Session start;
};

TEST_F(ComparedFiles, StandSideBySideAtOnceWithTheirDifference) {
    compare();
    ASSERT_TRUE(knows("slope minus other"));
    const auto source = workbench.source();
    const auto samples = [&](const char* name) {
        return source->read({*source->info().findChannel(name), 0, 0, {0, 0, 0}}).values;
    };
    const std::vector<float> d = samples("slope minus other"), a = samples("slope");
    ASSERT_EQ(d.size(), a.size());
    for (std::size_t i = 0; i < d.size(); ++i) EXPECT_NEAR(d[i], a[i] - 5, 1e-3);
    const CompareView* view = comparison();
    ASSERT_TRUE(view);
    ASSERT_EQ(view->variants.size(), 3u);
    const auto shown = [&](std::size_t index) {
        const Session session = variantSession(workbench.session(), view->variants[index]);
        return std::get<vis::VolumeLayer>(session.layers.front().technique).channel;
    };
    EXPECT_EQ(shown(0), "slope");
    EXPECT_EQ(shown(1), "slope (other)");
    EXPECT_EQ(shown(2), "slope minus other");
    EXPECT_EQ(view->variants[0].name, "ramp.raw");
    EXPECT_EQ(view->variants[1].name, "other.raw");
    EXPECT_EQ(view->variants[2].name, "ramp.raw minus other.raw");
    EXPECT_EQ(workbench.panes().current(workbench.session()), "compare") << "it is in front";
    const DockNode& root = workbench.session().dock.root;
    EXPECT_EQ(stackWith(root, "compare"), stackWith(root, "volume"));
}

TEST_F(ComparedFiles, AreReadAsTheUserStatesThem) {
    volume::ImportOptions stated;
    stated.lengthUnit = "mm";
    compareWithFiles(workbench, {(folder / "other.raw").string()}, stated);
    settle();
    ASSERT_TRUE(workbench.session().data.other);
    EXPECT_EQ(workbench.session().data.other->import.lengthUnit, "mm");
    const auto& said = workbench.messages().list();
    EXPECT_EQ(std::ranges::count_if(said,
                                    [](const auto& message) {
                                        return message.text.find("other.raw is shown beside it, on the same grid, "
                                                                 "lengths of ramp taken in mm, as its file states no "
                                                                 "unit of length") != std::string::npos;
                                    }),
              1);
}

// With what was edited meanwhile; the files that are open are as they were.
TEST_F(ComparedFiles, AreOneStepBackAndForth) {
    compare();
    ASSERT_EQ(workbench.history().steps().size(), 1u);
    const Session both = workbench.session();
    EXPECT_TRUE(both.data.other);
    ASSERT_TRUE(run("Undo"));
    settle();
    EXPECT_TRUE(workbench.session() == start);
    EXPECT_FALSE(knows("slope (other)"));
    EXPECT_FALSE(knows("slope minus other"));
    ASSERT_TRUE(run("Redo"));
    settle();
    EXPECT_TRUE(workbench.session() == both);
    EXPECT_TRUE(knows("slope (other)"));
    EXPECT_TRUE(knows("slope minus other"));
}

TEST_F(ComparedFiles, GoAwayByTheSameCommand) {
    compare();
    ASSERT_TRUE(run("Compare with another file..."));
    settle();
    EXPECT_FALSE(workbench.session().data.other);
    EXPECT_TRUE(workbench.session().data.derived.empty());
    EXPECT_FALSE(knows("slope (other)"));
    EXPECT_FALSE(comparison());
}

// The step holds where the other file lies, which a saved session says in other words.
TEST_F(ComparedFiles, AreStillOneStepAfterTheSessionWasSaved) {
    compare();
    workbench.document().save((folder / "both.tessera.json").string());
    OpenRequest request;
    request.paths = {(folder / "both.tessera.json").string()};
    workbench.install(open(request));
    settle();
    ASSERT_EQ(workbench.history().steps().size(), 1u);
    ASSERT_TRUE(run("Undo"));
    settle();
    EXPECT_FALSE(knows("slope (other)"));
    ASSERT_TRUE(run("Redo"));
    settle();
    EXPECT_TRUE(knows("slope minus other"));
}

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)

TEST_F(WorkbenchData, WhatWorkLeftBehindIsGivenBackOnceNothingIsBusy) {
    // As data leave that are no longer shown: free memory below blocks in use.
    std::vector<std::unique_ptr<std::vector<char>>> blocks;
    for (int i = 0; i < 12'000; ++i) blocks.push_back(std::make_unique<std::vector<char>>(32'000, 'x'));
    for (std::size_t i = 0; i + 1 < blocks.size(); ++i) blocks[i].reset();
    const double held = tessera::test::residentMemory();
    workbench.install(smallData());
    settle();
    EXPECT_LT(tessera::test::residentMemory(), held - 200);
}

#endif

} // namespace
} // namespace tessera::app
