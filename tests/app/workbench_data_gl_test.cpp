#include "tests/app/workbench_fixture.h"

#include <filesystem>
#include <fstream>
#include <unistd.h>

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
        frame([](ImGuiIO& io) { io.KeysDown[key::kEnter] = true; });
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

// A parameter derived meanwhile is of the new data when they come.
TEST_F(WorkbenchData, WhatIsEditedWhileResamplingStays) {
    workbench.install(smallData());
    settle();
    const bool bcc = workbench.session().data.bcc;
    ASSERT_TRUE(run("Show on BCC lattice"));
    addBrush("meanwhile");
    workbench.session().data.derived = {{"twice", "", volume::ExpressionRecipe{"2*rho"}}};
    settle();
    EXPECT_NE(workbench.session().data.bcc, bcc);
    EXPECT_EQ(workbench.source()->grid().lattice.kind == volume::LatticeKind::BCC, !bcc);
    EXPECT_TRUE(workbench.source()->info().findChannel("twice").has_value());
    EXPECT_EQ(workbench.session().selection.brushes.size(), 1u);
    while (run("Undo")) settle();
    EXPECT_TRUE(workbench.session().selection.brushes.empty());
    EXPECT_FALSE(workbench.source()->info().findChannel("twice").has_value());
    EXPECT_NE(workbench.session().data.bcc, bcc);
}

// Taken back or cancelled, it comes when it is wanted again.
TEST_F(WorkbenchData, AParameterWhoseMakingWasCancelledComesWhenItIsWantedAgain) {
    workbench.install(smallData());
    settle();
    const auto known = [&] { return workbench.source()->info().findChannel("twice").has_value(); };
    workbench.session().data.derived = {{"twice", "", volume::ExpressionRecipe{"2*rho"}}};
    frame();
    ASSERT_TRUE(workbench.jobs().running("derive"));
    workbench.jobs().cancel("derive");
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

} // namespace
} // namespace tessera::app
