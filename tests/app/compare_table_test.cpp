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

using Titles = std::vector<std::string>;

/// The heads of the numbers that are shown.
Titles numbersOf(const Table& table) {
    Titles heads;
    for (const TableColumn* column : shownColumns(table))
        if (column->texts.empty()) heads.push_back(headOf(*column));
    return heads;
}

TEST(CompareTable, HasTheNumbersThatThereAre) {
    const Table table = compareTable(rowsOfThree());
    EXPECT_EQ(numbersOf(table), (Titles{"ms", "Samples", "Texture", "File", "Max.", "RMSE", "PSNR [dB]", "SSIM"}));
    const auto cells = [&](const char* head) {
        Titles out;
        for (const TableColumn* column : shownColumns(table))
            for (std::size_t row = 0; headOf(*column) == head && row < 3; ++row) out.push_back(cellOf(*column, row));
        return out;
    };
    EXPECT_EQ(cells("ms"), (Titles{"166", "8.9", "-"}));
    EXPECT_EQ(cells("File"), (Titles{"-", "545 kB", "10.5 kB"})) << "a small file is not of 0.01 MB";
    EXPECT_EQ(cells("Max."), (Titles{"", "0", "12"}));
    EXPECT_EQ(cells("RMSE"), (Titles{"reference", "0.00", "1.23"}));
    EXPECT_EQ(cells("PSNR [dB]"), (Titles{"", "equal", "38.3"}));
    EXPECT_EQ(cells("SSIM"), (Titles{"", "1.0000", "0.9877"}));
    EXPECT_EQ(numbersOf(compareTable(rowsOfThree(), false)), (Titles{"File"}))
        << "other panes have no errors of pictures";
}

TEST(CompareTable, WhereNotAllFitTheErrorsAndTheSizeOfTheFileStay) {
    const auto fitting = [&](float room) {
        Table table = compareTable(rowsOfThree());
        hideNumbersWithoutRoom(table, room, [](const TableColumn&) { return 10.0f; });
        return numbersOf(table);
    };
    EXPECT_EQ(fitting(80), numbersOf(compareTable(rowsOfThree())));
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
