#include "app/values/table.h"

#include "app/pages/table_page.h"
#include "app/queries/readout.h"
#include "app/ui/ticks.h"
#include "app/values/table_json.h"
#include "app/views/compare/compare_questions.h"
#include "app/views/compare/compare_table.h"
#include "app/views/statistics/region_data.h"
#include "tests/app/table_text.h"
#include "tests/volume/cell_data.h"

#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>

/// Tables as values: what one column becomes on pages, in files and on terminals.
namespace tessera::app {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

const double kNone = std::nan("");

/// Two gases in two regions, with a column that no other table has.
Table gases() {
    Table table{.columns = {}, .names = 2, .notes = {"by hand"}};
    table.columns = {
        {.name = "parameter", .head = "Parameter", .texts = {"O2", "O2", "H2"}},
        {.name = "region", .head = "Region", .texts = {"air", "fuel, wet", "fuel, wet"}},
        {.name = "smell", .head = "Smell", .unit = "mol/m3", .numbers = {0.5, kNone, 12345678.5}},
        {.name = "samples", .head = "Samples", .kind = NumberKind::Count, .numbers = {1234567890123, 2, 3}},
        {.name = "total", .kind = NumberKind::Flag, .shown = false, .numbers = {0, 1, 0}},
    };
    return table;
}

TEST(Table, EachOfItsColumnsIsInEveryFile) {
    const Table table = gases();
    EXPECT_EQ(csvOf(table), "# by hand\n"
                            "parameter,region,smell [mol/m3],samples,total\n"
                            "O2,air,0.5,1234567890123,no\n"
                            "O2,\"fuel, wet\",,2,yes\n"
                            "H2,\"fuel, wet\",12345678.5,3,no\n");
    EXPECT_EQ(csvOf(table, false), csvOf(table).substr(csvOf(table).find("O2")));
    const Json json = jsonOf(table);
    ASSERT_EQ(json.size(), 3u);
    EXPECT_EQ(
        json[0],
        Json({{"parameter", "O2"}, {"region", "air"}, {"smell", 0.5}, {"samples", 1234567890123.0}, {"total", false}}));
    EXPECT_TRUE(json[1]["smell"].is_null());
    EXPECT_EQ(json[1]["total"], true);
    EXPECT_EQ(unitsOf(table), Json({{"smell", "mol/m3"}}));
    EXPECT_EQ(textOf(table), "Parameter  Region     Smell [mol/m\u00b3]            Samples\n"
                             "O2         air                   0.5  1 234 567 890 123\n"
                             "O2         fuel, wet               -                  2\n"
                             "H2         fuel, wet       1.23457e7                  3\n");
    const std::string svg = svgOf(tablePage(table, {}));
    for (const char* text : {">Smell<", ">[mol/m\u00b3]<", ">0.5<", ">1 234 567 890 123<", ">by hand<"})
        EXPECT_THAT(svg, HasSubstr(text));
    EXPECT_THAT(svg, testing::Not(HasSubstr("total")));
}

TEST(Table, NumbersAreShownByTheirKind) {
    const auto shown = [](NumberKind kind, double value, const std::string& unit = "", double resolution = 0) {
        return cellOf({.name = "x", .unit = unit, .kind = kind, .numbers = {value}, .resolutions = {resolution}}, 0);
    };
    EXPECT_EQ(shown(NumberKind::Plain, 435.1234), "435.123");
    EXPECT_EQ(shown(NumberKind::Plain, 435.1234, "K", 0.01), "435.12");
    EXPECT_EQ(shown(NumberKind::Share, 0.583), "58 %");
    EXPECT_EQ(shown(NumberKind::Change, 0.25), "+25.0000 %");
    EXPECT_EQ(shown(NumberKind::Volume, 2.68e-10, "m3"), formatVolume(2.68e-10, "m"));
    EXPECT_EQ(shown(NumberKind::Bytes, 545260), "545 kB");
    EXPECT_EQ(shown(NumberKind::Bound, 0.01234), "0.013") << "a bound is rounded up";
    EXPECT_EQ(shown(NumberKind::Bound, 0), "0");
    EXPECT_EQ(shown(NumberKind::Flag, 1), "yes");
    for (const NumberKind kind : {NumberKind::Plain, NumberKind::Count, NumberKind::Share, NumberKind::Volume})
        EXPECT_EQ(shown(kind, kNone), "-");
}

TEST(Table, WordsStandInPlaceOfNumbersForPeopleAlone) {
    Table table{.columns = {{.name = "PSNR", .unit = "dB", .numbers = {std::numeric_limits<double>::infinity(), 40}}}};
    table.columns[0].words[0] = "equal";
    EXPECT_THAT(cellsOf(table), ElementsAre(ElementsAre("equal"), ElementsAre("40")));
    EXPECT_EQ(csvOf(table), "PSNR [dB]\ninf\n40\n");
    EXPECT_TRUE(jsonOf(table)[0]["PSNR"].is_null());
}

TEST(Table, RepeatedNamesAreShownOnce) {
    EXPECT_THAT(cellsOf(gases(), true)[1], ElementsAre("", "fuel, wet", "-", "2"));
    EXPECT_THAT(cellsOf(gases(), true)[2], ElementsAre("H2", "fuel, wet", "1.23457e7", "3"));
    EXPECT_EQ(cellsOf(gases())[1][0], "O2");
}

TEST(Table, TheTimeIsInFilesAlone) {
    Table table = gases();
    addTime(table, "operating point", "A", 0.25);
    EXPECT_TRUE(csvOf(table).starts_with("# by hand\noperating point [A],parameter,"));
    EXPECT_THAT(csvOf(table), HasSubstr("\n0.25,H2,"));
    EXPECT_EQ(textOf(table), textOf(gases()));
}

/// The words of a page with the box of each.
struct Word {
    std::string text;
    double left = 0, right = 0, base = 0, size = 0;
};
std::vector<Word> wordsOf(const VectorPage& page) {
    std::vector<Word> words;
    for (const shapes::Mark& mark : page.marks)
        if (const auto* text = std::get_if<shapes::Words>(&mark.shape)) {
            const double width = textWidth(text->text) * text->size, left = text->at.x - text->anchor * width;
            words.push_back({text->text, left, left + width, text->at.y, text->size});
        }
    return words;
}

constexpr double kPointsPerMm = 72 / 25.4;

// Half a number is a wrong one, and so are two in each other.
TEST(TablePage, EveryCellIsThereAndCoversNoOther) {
    Table table{
        .columns = {}, .names = 2, .notes = {"a note that is longer than a column of a journal is wide, by far"}};
    table.columns = {{.name = "region", .texts = {"cathode channel", "border", ""}},
                     {.name = "surface", .texts = {"border to where it is absent", "x from below", "total"}}};
    for (int c = 0; c < 9; ++c)
        table.columns.push_back(
            {.name = "a long head " + std::to_string(c), .unit = "mol/s", .numbers = {10000.5 + c, -1.25e-12, kNone}});
    for (const double width : {0.0, 85.0, 174.0})
        for (const double points : {9.0, 14.0})
            for (const bool dark : {false, true}) {
                SCOPED_TRACE(std::to_string(width) + " mm, " + std::to_string(points) + " points");
                const VectorPage page =
                    tablePage(table, {.size = {width * kPointsPerMm, 100}, .text = points, .dark = dark});
                const std::vector<Word> words = wordsOf(page);
                if (width > 0) {
                    EXPECT_DOUBLE_EQ(page.size.x, width * kPointsPerMm);
                }
                std::map<std::string, int> count;
                for (const Word& word : words) {
                    ++count[word.text];
                    EXPECT_EQ(word.size, points);
                    EXPECT_GE(word.left, 0) << word.text;
                    EXPECT_LE(word.right, page.size.x + 1e-6) << word.text;
                    EXPECT_LT(word.base, page.size.y) << word.text;
                    for (const Word& other : words) {
                        const bool beside = &other == &word || std::abs(other.base - word.base) >= points * 0.8 ||
                                            other.left >= word.right || other.right <= word.left;
                        EXPECT_TRUE(beside) << word.text << " and " << other.text;
                    }
                }
                for (int c = 0; c < 9; ++c) EXPECT_EQ(count[formatNumber(10000.5 + c)], 1) << c;
                EXPECT_EQ(count["-1.25e-12"], 9);
                EXPECT_EQ(count["-"], 9);
            }
}

TEST(TablePage, IsSmallerOnlyWhereANameAndANumberHaveNoRoom) {
    Table table{.columns = {{.name = "region", .texts = {"Donaudampfschifffahrtsgesellschaft"}},
                            {.name = "mean", .numbers = {1.25}}}};
    const VectorPage page = tablePage(table, {.size = {100, 0}, .text = 14});
    for (const Word& word : wordsOf(page)) {
        EXPECT_LT(word.size, 14);
        EXPECT_LE(word.right, 100);
    }
}

TEST(TablePage, GoesOnBelowWithTheNames) {
    Table table{.columns = {{.name = "region", .texts = {"air"}}}};
    for (int c = 0; c < 6; ++c) table.columns.push_back({.name = "column" + std::to_string(c), .numbers = {1.0}});
    const auto names = [&](double width) {
        return std::ranges::count(wordsOf(tablePage(table, {.size = {width, 0}})), "air", &Word::text);
    };
    EXPECT_EQ(names(0), 1);
    EXPECT_EQ(names(400), 1);
    EXPECT_EQ(names(150), 3);
    EXPECT_GT(tablePage(table, {.size = {150, 0}}).size.y, 2.5 * tablePage(table, {.size = {400, 0}}).size.y);
}

// One word for one column, and one head for it, in whatever table it is.
TEST(Table, ColumnsAreCalledTheSameEverywhere) {
    const auto source = volume::test::cellSource(volume::test::cellData(
        volume::test::ccLattice({4, 4, 4}), volume::test::boxOf(volume::test::ccLattice({4, 4, 4}))));
    BalanceTable balance;
    balance.errors = true;
    CompareRow compared;
    compared.data.emplace();
    const std::vector<Table> tables{regionTable({}, {"m3"}, true), regionTable({}, {"m3"}, false, false),
                                    tableOf(balance), compareTable({compared}), readoutTable(source->info(), {})};
    const std::map<std::string, std::string> kHeads = {{"parameter", "Parameter"},
                                                       {"unit", ""},
                                                       {"region", "Region"},
                                                       {"samples", "Samples"},
                                                       {"shareOfAll", "Of all"},
                                                       {"shareOfExisting", "Of its own"},
                                                       {"volume", "Volume"},
                                                       {"mean", "Mean"},
                                                       {"deviation", "Std. deviation"},
                                                       {"min", "Minimum"},
                                                       {"max", "Maximum"},
                                                       {"surface", "Surface"},
                                                       {"total", ""},
                                                       {"in", "In"},
                                                       {"out", "Out"},
                                                       {"net", "Out - in"},
                                                       {"relative", "Of in"},
                                                       {"flow", "Volume flow"},
                                                       {"area", "Area"},
                                                       {"inside", "Inside"},
                                                       {"flowError", "Flow \u00b1"},
                                                       {"insideError", "Inside \u00b1"},
                                                       {"variant", "Variant"},
                                                       {"differs", "Changes"},
                                                       {"reference", ""},
                                                       {"ms per picture", "ms"},
                                                       {"texture bytes", "Texture"},
                                                       {"stored bytes", "File"},
                                                       {"maximum (of 255)", "Max."},
                                                       {"RMSE (of 255)", "RMSE"},
                                                       {"PSNR", "PSNR"},
                                                       {"SSIM", "SSIM"},
                                                       {"differing", "Differing"},
                                                       {"largest error of a sample", ""},
                                                       {"RMSE of samples", ""},
                                                       {"failure", ""},
                                                       {"interpolated", "Value"},
                                                       {"nearest", "Nearest"},
                                                       {"error", "Within \u00b1"}};
    for (const Table& table : tables)
        for (const TableColumn& column : table.columns) {
            ASSERT_TRUE(kHeads.contains(column.name)) << column.name << ": is there another word for it?";
            EXPECT_EQ(column.head, kHeads.at(column.name)) << column.name;
        }
}

} // namespace
} // namespace tessera::app
