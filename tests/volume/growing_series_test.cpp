#include "volume/import/growing_series.h"

#include "volume/base/error.h"
#include "volume/import/import.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace tessera::volume {
namespace {

namespace fs = std::filesystem;

/// Raw files of 4x4x4 samples of T and a label: T is 0 in region 0 at the first time, and nowhere later.
class GrowingSeriesTest : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("tessera_growing_" + std::to_string(getpid()));
        fs::create_directories(folder_);
        for (const int number : {8, 9, 10}) write("run_" + std::to_string(number), number);
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string at(const std::string& name) const { return (folder_ / name).string(); }
    void write(const std::string& name, int number, const std::string& more = "", const char* array = "T") const {
        std::ofstream out(folder_ / (name + ".raw"), std::ios::binary);
        for (const bool label : {false, true})
            for (int i = 0; i < 64; ++i) {
                const bool upper = i >= 32;
                const float value = label ? float(upper) : upper || number > 8 ? float(number + i) : 0;
                out.write(reinterpret_cast<const char*>(&value), sizeof value);
            }
        std::ofstream(folder_ / (name + ".json"))
            << R"({"dims": [4, 4, 4], "dtype": "float32", "components": [{"name": ")" << array
            << R"("}, {"name": "region"}])" << more << "}";
    }
    static std::size_t present(const Dataset& data) {
        const Field field = data.read(0, 0, 0);
        std::size_t count = 0;
        for (std::size_t i = 0; i < field.count(); ++i) count += field.present(i) ? 1 : 0;
        return count;
    }
    fs::path folder_;
};

TEST_F(GrowingSeriesTest, EachFileIsATimeAsInTheWholeSeries) {
    const Dataset whole = openFiles({at("run_*.raw")}, {});
    const GrowingSeries series = growingSeries(at("run_8.raw"), {});
    EXPECT_EQ(series.info.name, whole.info.name);
    for (const int number : {8, 9, 10}) {
        const Dataset one = openOfSeries(series, at("run_" + std::to_string(number) + ".raw"));
        EXPECT_THAT(one.info.times, testing::ElementsAre(number));
        EXPECT_EQ(one.info.timeName, whole.info.timeName);
        EXPECT_EQ(one.info.timeUnit, whole.info.timeUnit);
        EXPECT_TRUE(std::ranges::equal(one.read(0, 0, 0).as<float>(), whole.read(0, 0, number - 8).as<float>()));
    }
    EXPECT_EQ(openFiles({at("run_9.raw")}, {}).info.times, std::vector<double>{0}) << "not of a series";
}

TEST_F(GrowingSeriesTest, TheFirstFileDecidesWhatIsAbsent) {
    const GrowingSeries series = growingSeries(at("run_8.raw"), {});
    EXPECT_THAT(series.options.absent, testing::ElementsAre("T=region:0"));
    EXPECT_EQ(present(openOfSeries(series, at("run_8.raw"))), 32u);
    EXPECT_EQ(present(openOfSeries(series, at("run_9.raw"))), 32u);
    EXPECT_EQ(present(openFiles({at("run_9.raw")}, {})), 64u) << "by itself it shows nothing absent";
    ImportOptions stated;
    stated.absent = {"T=none"};
    EXPECT_EQ(present(openOfSeries(growingSeries(at("run_8.raw"), stated), at("run_9.raw"))), 64u);
}

TEST_F(GrowingSeriesTest, TheFirstFileDecidesTheParts) {
    write("run_11", 0); // a jump between the regions, present on both sides
    std::ofstream out(folder_ / "run_11.raw", std::ios::binary);
    for (const bool label : {false, true})
        for (int i = 0; i < 64; ++i) {
            const float value = label ? float(i >= 32) : i >= 32 ? 1000.f + float(i) : float(i + 1);
            out.write(reinterpret_cast<const char*>(&value), sizeof value);
        }
    out.close();
    const GrowingSeries series = growingSeries(at("run_11.raw"), {});
    EXPECT_THAT(series.options.parts, testing::ElementsAre("T=region:0|1"));
    EXPECT_EQ(openOfSeries(series, at("run_9.raw")).info.parameters[0].parts.count(), 2u);
    EXPECT_EQ(openFiles({at("run_9.raw")}, {}).info.parameters[0].parts.count(), 1u);
    ImportOptions stated;
    stated.parts = {"T=joined"};
    EXPECT_EQ(growingSeries(at("run_11.raw"), stated).options.parts, stated.parts);
}

TEST_F(GrowingSeriesTest, TimesInTheFilesCount) {
    write("own_1", 9, R"(, "times": [0.5])");
    write("own_2", 9, R"(, "times": [2.5])");
    write("own_3", 9, R"(, "times": [0.5])");
    const GrowingSeries series = growingSeries(at("own_1.raw"), {});
    EXPECT_THAT(openOfSeries(series, at("own_1.raw")).info.times, testing::ElementsAre(0.5));
    EXPECT_THAT(openOfSeries(series, at("own_2.raw")).info.times, testing::ElementsAre(2.5));
    EXPECT_THROW(openOfSeries(series, at("own_3.raw")), Error) << "the same time";
}

TEST_F(GrowingSeriesTest, WhatDoesNotFitIsAnError) {
    const GrowingSeries series = growingSeries(at("run_8.raw"), {});
    write("run_11", 11, "", "p");
    EXPECT_THROW(openOfSeries(series, at("run_11.raw")), Error) << "another array";
    ImportOptions plain;
    plain.autoAbsent = false;
    try {
        openOfSeries(growingSeries(at("run_8.raw"), plain), at("run_11.raw"));
        ADD_FAILURE() << "took another array";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("run_11.raw: holds other arrays than "));
    }
    fs::resize_file(folder_ / "run_9.raw", 100);
    EXPECT_THROW(openOfSeries(series, at("run_9.raw")), Error) << "cut";
    EXPECT_THROW(openOfSeries(series, at("run_12.raw")), Error) << "none";
    ImportOptions options;
    options.times = {1, 2};
    EXPECT_THROW(growingSeries(at("run_8.raw"), options), Error);
    options = {};
    options.overTime = at("run_8.json");
    EXPECT_THROW(growingSeries(at("run_8.raw"), options), Error);
}

TEST_F(GrowingSeriesTest, LaterTimesOfAFile) {
    Dataset data = openFiles({at("run_*.raw")}, {});
    data.info.quantities = {{"U", "V", {3, 4, 5}}};
    const Dataset later = timesAfter(data, 8.5, "run");
    EXPECT_THAT(later.info.times, testing::ElementsAre(9, 10));
    EXPECT_THAT(later.info.quantities[0].values, testing::ElementsAre(4, 5));
    EXPECT_EQ(later.read(0, 0, 1).value(40), data.read(0, 0, 2).value(40));
    EXPECT_EQ(timesAfter(data, 7, "run").info.times.size(), 3u);
    EXPECT_THROW(timesAfter(data, 10, "run"), Error);
}

} // namespace
} // namespace tessera::volume
