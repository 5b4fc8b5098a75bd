// Quantities over time: what files, lists and tables say of each time, and the name and unit of the axis.
#include "volume/field/quantities.h"

#include "volume/base/error.h"
#include "volume/export/export.h"
#include "volume/import/files/series.h"
#include "volume/import/foreign.h"
#include "volume/import/import.h"
#include "volume/import/over_time.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>
#include <unistd.h>

namespace tessera::volume {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Quantities : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("tessera_quantities_" + std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return (folder_ / name).string();
    }
    static std::string read(const fs::path& path) {
        std::ifstream in(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    fs::path folder_;
};

/// Path of optional data; "" when absent.
std::string testData(const std::string& name) {
    const char* named = std::getenv("TESSERA_DATA");
    const fs::path path = fs::path(named != nullptr ? named : TESSERA_TEST_DATA) / name;
    return fs::exists(path) ? path.string() : std::string();
}

std::string failure(const std::string& text) {
    try {
        parseTimeTable(text, "h.csv");
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

DatasetInfo withTimes(std::vector<double> times) {
    DatasetInfo info;
    info.times = std::move(times);
    info.timeUnit = "";
    return info;
}

const Quantity& named(const DatasetInfo& info, const std::string& name) {
    const auto found = findQuantity(info, name);
    if (!found) throw Error("no quantity over time " + name);
    return info.quantities[std::size_t(*found)];
}

TEST_F(Quantities, ATableIsReadWithItsUnits) {
    const TimeTable table =
        parseTimeTable("\xEF\xBB\xBF# made by hand\n\nvoltage [V]; Time (ms) ;\"i; mean [A/m^2]\"\r\n"
                       "0.5;20;-\r\n0.7;10;1.5e3\r\n;30;+2\r\n",
                       "h.csv");
    EXPECT_EQ(table.timeName, "Time");
    EXPECT_EQ(table.timeUnit, "ms");
    EXPECT_EQ(table.times, (std::vector<double>{10, 20, 30})); // sorted
    ASSERT_EQ(table.columns.size(), 2u);
    EXPECT_EQ(table.columns[0].name, "voltage");
    EXPECT_EQ(table.columns[0].unit, "V");
    EXPECT_EQ(table.columns[1].name, "i; mean");
    EXPECT_EQ(table.columns[1].unit, "A/m^2");
    EXPECT_EQ(table.columns[0].values[0], 0.7);
    EXPECT_TRUE(std::isnan(table.columns[0].values[2]));
    EXPECT_EQ(table.columns[1].values[0], 1500);
    EXPECT_TRUE(std::isnan(table.columns[1].values[1]));
    EXPECT_EQ(table.columns[1].values[2], 2);
    // Without a column of that name the first is the axis.
    EXPECT_EQ(parseTimeTable("operating point\tU [V]\n1\t0.9\n", "h.tsv").timeName, "operating point");
}

TEST_F(Quantities, ABadTableIsAnErrorWithFileAndLine) {
    EXPECT_THAT(failure("time,U\n1,2\n2,x7\n"),
                testing::AllOf(HasSubstr("h.csv"), HasSubstr("line 3"), HasSubstr("x7"), HasSubstr("is not a number")));
    EXPECT_THAT(failure("time,U\n\n1,2,3\n"), testing::AllOf(HasSubstr("line 3"), HasSubstr("3 values")));
    EXPECT_THAT(failure("time,U\n1,2\n3,4\n1,5\n"), testing::AllOf(HasSubstr("line 4"), HasSubstr("line 2")));
    EXPECT_THAT(failure("time,U\n,2\n"), testing::AllOf(HasSubstr("line 2"), HasSubstr("has no time")));
    EXPECT_THAT(failure("1,2\n3,4\n"), testing::AllOf(HasSubstr("line 1"), HasSubstr("name the columns")));
    EXPECT_THAT(failure("time,U,U [V]\n"), HasSubstr("two columns are named U"));
    EXPECT_THAT(failure("time\n1\n"), HasSubstr("names one column"));
    EXPECT_THAT(failure("time,U\n1,inf\n"), HasSubstr("is not a number"));
    EXPECT_THAT(failure("time,U\n"), HasSubstr("no row"));
    EXPECT_THAT(failure(""), HasSubstr("empty"));
    EXPECT_THROW(readTimeTable((folder_ / "none.csv").string()), Error);
}

TEST_F(Quantities, ATableIsInterpolatedAtTheTimesOfTheDataAndUnknownOutside) {
    DatasetInfo info = withTimes({0.005, 0.01, 0.0125, 0.02, 0.03});
    info.timeUnit = "s";
    addTable(info, parseTimeTable("t [ms],U [V]\n10,1\n20,3\n", "h.csv"));
    const std::vector<double>& values = named(info, "U").values;
    ASSERT_EQ(values.size(), 5u);
    EXPECT_TRUE(std::isnan(values[0]));
    EXPECT_EQ(values[1], 1);
    EXPECT_DOUBLE_EQ(values[2], 1.5);
    EXPECT_EQ(values[3], 3);
    EXPECT_TRUE(std::isnan(values[4]));
    EXPECT_EQ(info.timeUnit, "s");
    // A second table replaces the column of the same name and adds others.
    addTable(info, parseTimeTable("t,U [mV],j\n0,5,6\n1,5,6\n", "i.csv"));
    EXPECT_EQ(info.quantities.size(), 2u);
    EXPECT_EQ(named(info, "U").unit, "mV");
    EXPECT_THROW(addTable(info, parseTimeTable("t [V],x\n0,1\n", "h.csv")), Error);  // volts are no seconds
    EXPECT_THROW(addTable(info, parseTimeTable("t [s],x\n50,1\n", "h.csv")), Error); // no row at these times
}

TEST_F(Quantities, TheAxisFollowsTheTableWhereTheDataDoNotStateIt) {
    DatasetInfo info = withTimes({1, 2});
    info.timeName = "step";
    const TimeTable ofTime = parseTimeTable("time [s],U\n0,1\n10,2\n", "h.csv");
    EXPECT_THROW(addTable(info, ofTime), Error); // numbers of files are no seconds
    addTable(info, parseTimeTable("operating point,U\n1,0.9\n2,0.8\n", "h.csv"));
    EXPECT_EQ(info.timeName, "operating point");
    EXPECT_EQ(info.timeUnit, "");
    DatasetInfo seconds = withTimes({1, 2});
    addTable(seconds, ofTime);
    EXPECT_EQ(seconds.timeName, "time");
    EXPECT_EQ(seconds.timeUnit, "s");
}

TEST_F(Quantities, RowsAreMatchedByWhatTheDataAndTheTableShare) {
    // A column named as the axis of the data, in any order of its rows.
    DatasetInfo info = withTimes({0.6, 0.75, 0.85});
    info.timeName = "voltage";
    info.timeUnit = "V";
    addTable(info, parseTimeTable("case,Voltage [V],j [A/m2]\n1,0.85,10\n2,0.6,300\n3,0.75,100\n", "h.csv"));
    EXPECT_EQ(named(info, "j").values, (std::vector<double>{300, 100, 10}));
    EXPECT_EQ(named(info, "j").unit, "A/m2");
    EXPECT_EQ(named(info, "case").values, (std::vector<double>{2, 3, 1}));
    EXPECT_FALSE(findQuantity(info, "Voltage")) << "is the axis";
    EXPECT_EQ(info.timeName, "voltage");
    // A counter of both.
    info = withTimes({100, 200});
    info.timeName = "step";
    addTable(info, parseTimeTable("time [s],iteration,residual\n0.1,100,1e-3\n0.2,200,1e-4\n", "h.csv"));
    EXPECT_EQ(named(info, "residual").values, (std::vector<double>{1e-3, 1e-4}));
    EXPECT_EQ(named(info, "time").values, (std::vector<double>{0.1, 0.2}));
    EXPECT_EQ(named(info, "time").unit, "s");
    // A quantity over time of the data; one that is not known at a time tells nothing there.
    info = withTimes({1, 2, 3});
    info.timeName = "operating point";
    info.quantities = {{"current", "A", {5, std::numeric_limits<double>::quiet_NaN(), 9}}};
    addTable(info, parseTimeTable("t [h],current [A],T [K]\n0,5,350\n1,9,360\n", "h.csv"));
    EXPECT_EQ(named(info, "T").values[0], 350);
    EXPECT_TRUE(std::isnan(named(info, "T").values[1]));
    EXPECT_EQ(named(info, "T").values[2], 360);
    // In another unit it is not the same.
    EXPECT_THROW(addTable(info, parseTimeTable("t [h],current [mA],x\n70,5,350\n71,9,360\n", "h.csv")), Error);
}

TEST_F(Quantities, WhatNeitherHasIsNamed) {
    DatasetInfo info = withTimes({1, 2});
    info.timeName = "step";
    info.quantities = {{"voltage", "V", {0.85, 0.6}}};
    try {
        addTable(info, parseTimeTable("time [h],power [W]\n0,1\n1,2\n", "h.csv"));
        FAIL();
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("h.csv"), HasSubstr("the table has time [h], power [W]"),
                                                 HasSubstr("the data have step, voltage [V]")));
    }
}

TEST_F(Quantities, AreTakenToOtherTimesAndLonger) {
    const std::vector<double> times{0, 1, 3}, wanted{-1, 0, 2, 3};
    const std::vector<Quantity> at = atTimes({{"U", "V", {5, 7, 3}}}, times, wanted);
    EXPECT_TRUE(std::isnan(at[0].values[0]));
    EXPECT_EQ(std::vector<double>(at[0].values.begin() + 1, at[0].values.end()), (std::vector<double>{5, 5, 3}));
    const std::vector<Quantity> all = joined({{"U", "V", {1, 2}}}, 2, {{"j", "A", {8}}, {"U", "V", {3}}}, 1);
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[0].values, (std::vector<double>{1, 2, 3}));
    EXPECT_TRUE(std::isnan(all[1].values[0]) && std::isnan(all[1].values[1]));
    EXPECT_EQ(all[1].values[2], 8);
}

TEST_F(Quantities, ListsOfFilesStateNumbers) {
    const auto files = parsePvd("<Collection><DataSet timestep=\"1\" voltage='0.7' note=\"a=b 3\" part=\"0\" "
                                "file=\"a.vti\" j = \"1e3\" name=\"5\"/></Collection>",
                                "x.pvd");
    ASSERT_EQ(files.size(), 1u);
    EXPECT_EQ(files[0].numbers, (std::vector<std::pair<std::string, double>>{{"voltage", 0.7}, {"j", 1000}}));
    const auto series = parseSeries(R"({"files":[{"name":"a","time":2,"U":0.5,"note":"x"}]})", "x.series");
    EXPECT_EQ(series[0].numbers, (std::vector<std::pair<std::string, double>>{{"U", 0.5}}));
}

/// Two frames with quantities, one not known at the second time.
Dataset twoFrames() {
    Dataset dataset;
    dataset.info.lattice.size = {3, 2, 2};
    dataset.info.times = {0.25, 0.5};
    dataset.info.timeName = "operating point";
    dataset.info.timeUnit = "of 9";
    dataset.info.parameters = {{"T", "K", 1, ScalarType::F32, false, {}, {}}};
    dataset.info.quantities = {{"cell voltage", "V", {0.7, 0.1}},
                               {"j", "", {1e4, std::numeric_limits<double>::quiet_NaN()}}};
    dataset.read = [lattice = dataset.info.lattice](int, int, int time) {
        Field field = makeField(lattice, ScalarType::F32);
        std::ranges::fill(field.as<float>(), float(time));
        return field;
    };
    return dataset;
}

void expectThoseOfTwoFrames(const DatasetInfo& info) {
    const DatasetInfo wanted = twoFrames().info;
    EXPECT_EQ(info.timeName, wanted.timeName);
    EXPECT_EQ(info.timeUnit, wanted.timeUnit);
    ASSERT_EQ(info.quantities.size(), 2u);
    EXPECT_EQ(info.quantities[0], wanted.quantities[0]);
    EXPECT_EQ(info.quantities[1].name, "j");
    EXPECT_EQ(info.quantities[1].unit, "");
    EXPECT_EQ(info.quantities[1].values[0], 1e4);
    EXPECT_TRUE(std::isnan(info.quantities[1].values[1]));
}

TEST_F(Quantities, ComeBackThroughRaw) {
    const std::string path = (folder_ / "out.raw").string();
    exportDataset(twoFrames(), {}, path);
    expectThoseOfTwoFrames(openFiles({path}, {}).info);
    const std::string sidecar = read(folder_ / "out.json");
    write("out.json", std::regex_replace(sidecar, std::regex("\"cell voltage\""), "3"));
    EXPECT_THROW(openFiles({path}, {}), Error);
}

TEST_F(Quantities, ComeBackThroughVti) {
    if (findImporter().empty()) GTEST_SKIP() << "tessera-import was not built";
    exportDataset(twoFrames(), {}, (folder_ / "out.vti").string());
    expectThoseOfTwoFrames(openFiles({(folder_ / "out.pvd").string()}, {}).info);
    ImportOptions stated;
    stated.timeName = "point";
    stated.timeUnit = "1";
    stated.units["j"] = "A/m2";
    stated.overTime = write("more.csv", "point,pump [W]\n0,10\n1,20\n");
    const DatasetInfo info = previewFiles({(folder_ / "out.pvd").string()}, stated).info;
    EXPECT_EQ(info.timeName, "point");
    EXPECT_EQ(info.timeUnit, "1");
    EXPECT_EQ(named(info, "j").unit, "A/m2");
    EXPECT_EQ(named(info, "pump").values, (std::vector<double>{12.5, 15}));
}

/// What the head of a .vti of the shared fuel cell says of a field datum: its least value, as text.
double inHead(const std::string& head, const std::string& name) {
    std::smatch found;
    const std::regex wanted("Name=\"" + name + "\" NumberOfTuples=\"1\"[^>]*RangeMin=\"([^\" ]+)");
    return std::regex_search(head, found, wanted) ? std::stod(found[1]) : std::nan("");
}

TEST_F(Quantities, OfTheSharedFuelCellAreThoseOfItsFiles) {
    const std::string list = testData("fuel-cell/grid/small.pvd");
    if (list.empty() || findImporter().empty()) GTEST_SKIP() << "no fuel cell or no tessera-import";
    ImportOptions options;
    options.overTime = testData("fuel-cell/history.csv");
    const DatasetInfo info = openFiles({list}, options).info;
    EXPECT_EQ(info.times.size(), 26u);
    EXPECT_EQ(info.timeName, "time");
    EXPECT_EQ(info.timeUnit, "s");                  // of the table: the files state none
    std::map<long, std::pair<double, double>> rows; // by millisecond
    std::istringstream history(read(options.overTime));
    std::string line;
    std::getline(history, line);
    while (std::getline(history, line)) {
        double time = 0, voltage = 0, current = 0;
        ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", &time, &voltage, &current), 3);
        rows[std::lround(time * 1000)] = {voltage, current};
    }
    for (std::size_t t = 0; t < 26; ++t) {
        const long ms = std::lround(1000 * info.times[t]);
        char name[32];
        std::snprintf(name, sizeof name, "small_%04ld.vti", ms);
        const std::string head = read(fs::path(list).parent_path() / name).substr(0, 2000);
        EXPECT_NEAR(named(info, "current_density").values[t], inHead(head, "current_density"), 1e-3) << name;
        EXPECT_NEAR(named(info, "voltage").values[t], rows[ms].first, 1e-12) << name;
        EXPECT_NEAR(named(info, "mean current density").values[t], rows[ms].second, 1e-9) << name;
    }
    EXPECT_EQ(named(info, "voltage").unit, "V");
    EXPECT_EQ(named(info, "mean current density").unit, "A/m^2");
    EXPECT_EQ(openFiles({list}, {}).info.timeUnit, ""); // none is invented
}

TEST_F(Quantities, OfMeshesAreReadOfEveryFileOfASeries) {
    const std::string first = testData("fuel-cell/unstructured/air_100.vtu");
    if (first.empty() || findImporter().empty()) GTEST_SKIP() << "no fuel cell or no tessera-import";
    // The same two files with a number more in their field data.
    std::vector<std::string> paths;
    for (const auto& [name, voltage] : {std::pair("air_100.vtu", "0.55"), std::pair("air_260.vtu", "0.4")}) {
        std::string bytes = read(fs::path(first).parent_path() / name);
        const std::size_t at = bytes.find("</FieldData>");
        ASSERT_NE(at, std::string::npos);
        bytes.insert(at, std::string("<DataArray type=\"Float64\" Name=\"voltage\" NumberOfTuples=\"1\" "
                                     "format=\"ascii\">") +
                             voltage + "</DataArray>\n");
        paths.push_back(write(name, bytes));
    }
    ImportOptions options;
    options.gridSize = {4, 4, 8};
    const Dataset dataset = openFiles(paths, options);
    EXPECT_EQ(dataset.info.times, (std::vector<double>{0.1, 0.26}));
    EXPECT_EQ(named(dataset.info, "voltage").values, (std::vector<double>{0.55, 0.4}));
    const Field frame = dataset.read(0, 0, 1); // samples are read as before
    std::size_t present = 0;
    for (std::size_t i = 0; i < frame.count(); ++i) present += frame.present(i) ? 1 : 0;
    EXPECT_GT(present, frame.count() / 4);
}

} // namespace
} // namespace tessera::volume
