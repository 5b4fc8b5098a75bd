#include "app/views/figure.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace tessera::app {
namespace {

TEST(Figure, HoldsLinesBarsCellsAndTexts) {
    FigurePanel panel;
    panel.title = "O2 < 1 & \"hot\"";
    panel.x = {"z [mm]", {0, 10}};
    panel.y = {"T [K]", {300, 400}};
    panel.series = {{"T", {{0, 300}, {5, std::nan("")}, {10, 400}}, {1, 0, 0}},
                    {"n", {{1, 320}, {3, 350}}, {0, 0, 1}, true}};
    panel.image = {2, 1, {10, 20, 30, 255, 0, 0, 0, 0}};
    const std::string svg = figureSvg({panel, panel}, 2);
    EXPECT_TRUE(svg.starts_with("<svg "));
    EXPECT_NE(svg.find("O2 &lt; 1 &amp; &quot;hot&quot;"), std::string::npos);
    EXPECT_NE(svg.find("T [K]"), std::string::npos);
    EXPECT_NE(svg.find("#0a141e"), std::string::npos) << "the cell that is not transparent";
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    // A gap parts the line in two: two moves, no line across.
    const std::size_t path = svg.find("<path d=\"");
    const std::string line = svg.substr(path, svg.find("fill", path) - path);
    EXPECT_EQ(std::count(line.begin(), line.end(), 'M'), 2);
    EXPECT_EQ(std::count(line.begin(), line.end(), 'L'), 0);
    EXPECT_NE(svg.find("width=\"600.00pt\""), std::string::npos) << "two panels side by side";
}

TEST(Figure, CsvFieldsAreQuotedWhereNeeded) {
    EXPECT_EQ(csvField("T [K]"), "T [K]");
    EXPECT_EQ(csvField("a,b \"c\""), "\"a,b \"\"c\"\"\"");
    EXPECT_EQ(csvNumber(std::nan("")), "");
    EXPECT_EQ(csvNumber(0.1), "0.1");
}

} // namespace
} // namespace tessera::app
