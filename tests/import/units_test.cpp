// Units that files state, and those that only a name tells.
#include "tests/import/foreign_files.h"
#include "volume/export/export.h"

namespace tessera::volume {
namespace {

using Units = ForeignFiles;

struct Column {
    const char* name;
    double first, step;
};
/// A table of 2 x 2 x 2 points.
std::string table(const std::vector<Column>& columns) {
    std::string out = "x,y,z";
    for (const Column& column : columns) out += "," + std::string(column.name);
    out += "\n";
    for (int n = 0; n < 8; ++n) {
        out += std::to_string(n & 1) + "," + std::to_string(n >> 1 & 1) + "," + std::to_string(n >> 2);
        for (const Column& column : columns) out += "," + std::to_string(column.first + column.step * n);
        out += "\n";
    }
    return out;
}
std::string unitsOf(const Dataset& dataset) {
    std::string out;
    for (const Parameter& parameter : dataset.info.parameters)
        out += parameter.name + ":" + parameter.unit + (parameter.unitGuessed ? "?" : "") + " ";
    return out;
}

TEST_F(Units, OfUsualNamesAreGuessedAndSaySo) {
    const std::string path =
        write("a.csv", table({{"T", 350, 1}, {"p", 1e5, 10}, {"rho", 1, 0.1}, {"Velocity", -1, 1}, {"O2", 5, 1}}));
    EXPECT_EQ(unitsOf(openFiles({path}, {})), "T:K? p:Pa? rho:kg/m3? Velocity:m/s? O2: ");
    ImportOptions options;
    options.units["T"] = "degC";
    EXPECT_EQ(unitsOf(openFiles({path}, options)), "T:degC p:Pa? rho:kg/m3? Velocity:m/s? O2: ");
}

TEST_F(Units, AreNotGuessedAgainstTheValuesOrTheFile) {
    EXPECT_EQ(unitsOf(openFiles({write("a.csv", table({{"T", 60, 1}, {"p", 1, 0.1}, {"rho", -1, 1}}))}, {})),
              "T: p: rho: "); // degrees, bar, something else
    EXPECT_EQ(unitsOf(openFiles({write("b.csv", table({{"T [degC]", 350, 1}, {"p", 1e5, 10}}))}, {})), "T:degC p: ");
    EXPECT_EQ(unitsOf(openFiles({write("c.csv", table({{"Tair", 350, 1}, {"u'", 1, 1}}))}, {})), "Tair: u': ");
}

TEST_F(Units, GuessedOnesAreNotWrittenAsStated) {
    const Dataset dataset = openFiles({write("a.csv", table({{"T", 350, 1}}))}, {});
    const std::string path = (folder_ / "b.vti").string();
    exportDataset(dataset, {}, path);
    EXPECT_EQ(unitsOf(openFiles({path}, {})), "T:K? ");
}

TEST_F(Units, OfOpenFoamComeFromItsDimensions) {
    const std::string archive = testData("fuel-cell/openfoam-case.tar.xz");
    if (archive.empty()) GTEST_SKIP() << "no test data";
    ASSERT_EQ(std::system(("tar xJf '" + archive + "' -C '" + folder_.string() + "'").c_str()), 0);
    const DatasetInfo info = previewFiles({(folder_ / "cell").string()}, {}).info;
    const auto unit = [&](const char* name) {
        for (const Parameter& parameter : info.parameters)
            if (parameter.name == name) return parameter.unit + (parameter.unitGuessed ? "?" : "");
        return std::string("missing");
    };
    EXPECT_EQ(unit("T"), "K");
    EXPECT_EQ(unit("U.air"), "m/s");
    EXPECT_EQ(unit("O2.air"), ""); // a mass fraction
    EXPECT_EQ(unit("p_rgh"), "Pa");
    EXPECT_EQ(unit("diffSp.O2"), "m2/s");
}

} // namespace
} // namespace tessera::volume
