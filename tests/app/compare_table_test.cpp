#include "app/views/compare/compare_table.h"
#include "tests/app/fed_imgui.h"

#include <limits>

namespace tessera::app {
namespace {

std::vector<CompareRow> rowsOfThree() {
    CompareRow first, second, third;
    first.name = "as computed", first.changes = "packed none", first.reference = true;
    first.milliseconds = 166, first.samples = 41184, first.bytes = 283000;
    second.name = "lossless", second.changes = "unchanged", second.measured = true;
    second.milliseconds = 8.94, second.samples = 41184, second.bytes = 283000, second.storedBytes = 545260;
    second.psnr = std::numeric_limits<double>::infinity(), second.ssim = 1;
    third.name = "5 %, wavelet 4,2", third.changes = "lossless false, max error 0.05, wavelet 4,2";
    third.measured = true, third.storedBytes = 10485.76;
    third.maximum = 12, third.rmse = 1.234, third.psnr = 38.26, third.ssim = 0.98765;
    return {first, second, third};
}

std::vector<std::string> titlesOf(const std::vector<CompareColumn>& columns) {
    std::vector<std::string> titles;
    for (const CompareColumn& column : columns) titles.push_back(column.title);
    return titles;
}

using Titles = std::vector<std::string>;

TEST(CompareTable, HasTheNumbersThatThereAre) {
    CompareView view;
    const auto columns = compareColumns(view, rowsOfThree());
    EXPECT_EQ(titlesOf(columns), (Titles{"ms", "Samples", "Texture", "File", "Max.", "RMSE", "PSNR [dB]", "SSIM"}));
    const auto cells = [&](std::size_t column) { return columns[column].cells; };
    EXPECT_EQ(cells(0), (Titles{"166", "8.9", "-"}));
    EXPECT_EQ(cells(3), (Titles{"-", "545 kB", "10.5 kB"})) << "a small file is not of 0.01 MB";
    EXPECT_EQ(cells(4), (Titles{"", "0", "12"}));
    EXPECT_EQ(cells(5), (Titles{"reference", "0.00", "1.23"}));
    EXPECT_EQ(cells(6), (Titles{"", "equal", "38.3"}));
    EXPECT_EQ(cells(7), (Titles{"", "1.0000", "0.9877"}));
    view.shows = "slices"; // other panes have no errors of pictures
    EXPECT_EQ(titlesOf(compareColumns(view, rowsOfThree())), (Titles{"File"}));
}

TEST(CompareTable, WhereNotAllFitTheErrorsAndTheSizeOfTheFileStay) {
    const auto columns = compareColumns({}, rowsOfThree());
    const std::vector<float> widths(columns.size(), 10);
    const auto fitting = [&](float room) { return titlesOf(columnsThatFit(columns, widths, room)); };
    EXPECT_EQ(fitting(80), titlesOf(columns));
    EXPECT_EQ(fitting(30), (Titles{"File", "RMSE", "PSNR [dB]"}));
    EXPECT_EQ(fitting(45), (Titles{"File", "RMSE", "PSNR [dB]", "SSIM"}));
    EXPECT_EQ(fitting(3), (Titles{"RMSE"})) << "one at least";
}

/// The table in windows of several widths: nothing in it is cut off.
class DrawnCompareTable : public FedImGui {
protected:
    DrawnCompareTable() : FedImGui({1400, 300}) {}
    /// All texts of the table in a window of this many em.
    std::string drawn(float ems, bool figure) {
        const auto body = [&] {
            ImGui::SetNextWindowPos({0, 0});
            ImGui::SetNextWindowSize({ImGui::GetFontSize() * ems, 290});
            ImGui::Begin("narrow", nullptr, ImGuiWindowFlags_NoDecoration);
            drawCompareTable(view, rowsOfThree(), figure);
            ImGui::End();
        };
        for (int i = 0; i < 3; ++i) feed(body);
        return said(body);
    }
    CompareView view;
};

TEST_F(DrawnCompareTable, LeavesOutWhatChangesBeforeNumbers) {
    const std::string wide = drawn(90, false);
    EXPECT_NE(wide.find("Changes"), std::string::npos);
    EXPECT_NE(wide.find("packed none"), std::string::npos);
    const std::string narrow = drawn(50, false);
    EXPECT_EQ(narrow.find("Changes"), std::string::npos);
    for (const char* title : {"Variant", "ms", "Samples", "SSIM", "0.9877"})
        EXPECT_NE(narrow.find(title), std::string::npos) << title;
    const std::string paper = drawn(30, true); // 85 mm in points of 8
    for (const char* title : {"Variant", "5 %, wavelet 4,2", "RMSE", "PSNR [dB]", "38.3", "10.5 kB"})
        EXPECT_NE(paper.find(title), std::string::npos) << title << " in " << paper;
    for (const char* title : {"Texture", "ms|", "Changes"})
        EXPECT_EQ(paper.find(title), std::string::npos) << title << " in " << paper;
}

} // namespace
} // namespace tessera::app
