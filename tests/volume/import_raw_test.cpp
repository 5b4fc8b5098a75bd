#include "volume/base/error.h"
#include "volume/import/files/raw.h"
#include "volume/import/import.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <unistd.h>

namespace tessera::volume {
namespace {

namespace fs = std::filesystem;

std::string testData() {
    const char* named = std::getenv("TESSERA_DATA");
    return named != nullptr ? named : TESSERA_TEST_DATA;
}

class ImportRaw : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("tessera_raw_" + std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string write(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return (folder_ / name).string();
    }
    /// The one line an import of this file fails with, "" if it does not fail.
    static std::string failure(const std::string& path, const ImportOptions& options = {}) {
        try {
            openFiles({path}, options);
            return "";
        } catch (const Error& error) {
            return error.what();
        }
    }
    fs::path folder_;
};

template <class T> std::string bytesOf(const std::vector<T>& values, bool big) {
    std::string bytes;
    for (const T value : values) {
        char one[sizeof(T)];
        std::memcpy(one, &value, sizeof(T));
        if (big) std::reverse(one, one + sizeof(T));
        bytes.append(one, sizeof(T));
    }
    return bytes;
}

template <class T> void roundTrip(const fs::path& folder, const std::string& word, bool big) {
    std::mt19937 random(7);
    for (const glm::ivec3 size : {glm::ivec3(1, 1, 1), glm::ivec3(3, 2, 17), glm::ivec3(17, 1, 2)}) {
        const std::size_t count = std::size_t(size.x * size.y * size.z);
        constexpr std::size_t kComponents = 2, kTimes = 3;
        std::vector<T> values(count * kComponents * kTimes);
        for (T& value : values) value = static_cast<T>(int(random() % 251) - (std::is_signed_v<T> ? 125 : 0));
        const std::string raw = (folder / "a.raw").string();
        std::ofstream(raw, std::ios::binary) << bytesOf(values, big);
        std::ofstream(folder / "a.json") << "{\"dims\":[" << size.x << "," << size.y << "," << size.z
                                         << "],\"dtype\":\"" << word << "\",\"byte_order\":\""
                                         << (big ? "big" : "little")
                                         << "\",\"components\":[{\"name\":\"T\",\"unit\":\"K\"},{\"name\":\"p\","
                                            "\"unit\":\"Pa\"}],\"times\":[0.5,1,4]}";
        const Dataset dataset = openFiles({raw}, {});
        ASSERT_EQ(dataset.info.lattice.size, size);
        ASSERT_EQ(dataset.info.times, (std::vector<double>{0.5, 1, 4}));
        for (std::size_t t = 0; t < kTimes; ++t)
            for (std::size_t c = 0; c < kComponents; ++c) {
                const Field field = dataset.read(int(c), 0, int(t));
                EXPECT_EQ(field.mask, nullptr);
                for (std::size_t i = 0; i < count; ++i)
                    ASSERT_EQ(field.value(i), double(values[(t * kComponents + c) * count + i])) << word << i;
            }
    }
}

TEST_F(ImportRaw, EveryTypeInBothByteOrders) {
    for (const bool big : {false, true}) {
        roundTrip<std::uint8_t>(folder_, "uint8", big);
        roundTrip<std::int8_t>(folder_, "int8", big);
        roundTrip<std::uint16_t>(folder_, "u16", big);
        roundTrip<std::int16_t>(folder_, "int16", big);
        roundTrip<std::int32_t>(folder_, "int32", big);
        roundTrip<float>(folder_, "float32", big);
        roundTrip<double>(folder_, "float64", big);
    }
}

TEST_F(ImportRaw, SidecarSaysEverything) {
    write("cell.raw", bytesOf<float>({1, 2, 3, 4, -9, 6}, false) + std::string("\1\2", 2));
    const std::string sidecar = write("cell.json", R"({"dims":[2,1,1],"dtype":"float32","spacing":[0.5,2,3],
        "origin":[1,2,3],"length_unit":"mm","missing_value":-9,"provenance":"made here",
        "components":[{"name":"U.x","unit":"m/s"},{"name":"U.y","unit":"m/s"},{"name":"U.z","unit":"m/s"},
        {"name":"region","dtype":"uint8","categorical":true,"labels":{"1":"air","2":"fuel"}}]})");
    const Dataset dataset = openFiles({sidecar}, {});
    ASSERT_EQ(dataset.info.parameters.size(), 2u);
    const Parameter& velocity = dataset.info.parameters[0];
    EXPECT_EQ(velocity.name, "U");
    EXPECT_EQ(velocity.components, 3);
    EXPECT_EQ(velocity.unit, "m/s");
    EXPECT_TRUE(dataset.info.parameters[1].categorical);
    EXPECT_EQ(dataset.info.parameters[1].labels, (std::vector<Label>{{1, "air"}, {2, "fuel"}}));
    EXPECT_EQ(dataset.info.lattice.spacing, glm::dvec3(0.5, 2, 3));
    EXPECT_EQ(dataset.info.lattice.origin, glm::dvec3(1, 2, 3));
    EXPECT_EQ(dataset.info.lengthUnit, "mm");
    EXPECT_EQ(dataset.info.provenance, "made here");
    const Field z = dataset.read(0, 2, 0);
    EXPECT_FALSE(z.present(0));
    EXPECT_TRUE(z.present(1));
    EXPECT_EQ(dataset.read(1, 0, 0).value(1), 2);
}

TEST_F(ImportRaw, WhatIsNotFiniteIsAbsentAndWhatIsNotStatedHasNoUnit) {
    const float infinite = std::numeric_limits<float>::infinity();
    write("a.raw", bytesOf<float>({1, infinite, -infinite, std::nanf("")}, false));
    const Dataset dataset = openFiles({write("a.json", R"({"dims":[4,1,1],"dtype":"float32"})")}, {});
    EXPECT_EQ(dataset.info.lengthUnit, "");
    EXPECT_EQ(dataset.info.timeUnit, "");
    const Field field = dataset.read(0, 0, 0);
    EXPECT_TRUE(field.present(0));
    for (std::size_t i = 1; i < 4; ++i) EXPECT_FALSE(field.present(i));
    write("a.raw", "1234");
    write("a.json", R"({"dims":[4,1,1],"dtype":"uint8","missing_value":0})");
    EXPECT_EQ(openFiles({(folder_ / "a.raw").string()}, {}).read(0, 0, 0).mask, nullptr) << "there is none";
}

TEST_F(ImportRaw, RawOptionTakesThePlaceOfASidecar) {
    ImportOptions options;
    options.raw = "dims=2x1x2,type=i16,spacing=1x1e-3x2.5,origin=-1x0x1,components=1,times=2,big-endian,skip=3";
    const std::string path = write("a.bin", "abc" + bytesOf<std::int16_t>({1, -2, 3, 4, 5, 6, 7, -800}, true));
    const Dataset dataset = openFiles({path}, options);
    EXPECT_EQ(dataset.info.lattice.spacing, glm::dvec3(1, 1e-3, 2.5));
    EXPECT_EQ(dataset.info.lattice.origin, glm::dvec3(-1, 0, 1));
    EXPECT_EQ(dataset.read(0, 0, 1).value(3), -800);
    for (const char* bad : {"", "dims=2x1,type=u8", "dims=2x1x1", "dims=2x1x1,type=u9", "dims=0x1x1,type=u8",
                            "dims=2x1x1,type=u8,what=1", "dims=1x1x1,type=u8,components=0", "dims=axbxc,type=u8",
                            "dims=1x1x1,type=u8,spacing=0x1x1", "dims=1x1x1,type=u8,times=99999999999"})
        EXPECT_THROW(parseRawOption(bad), Error) << bad;
}

TEST_F(ImportRaw, TheRawOptionNamesASidecar) {
    ImportOptions options;
    options.raw = write("form.json", R"({"dims":[2,1,1],"dtype":"uint8","components":[{"name":"T","unit":"K"}]})");
    const Dataset dataset = openFiles({write("b.bin", "\x07\x09")}, options);
    EXPECT_EQ(dataset.info.parameters.at(0).name, "T");
    EXPECT_EQ(dataset.info.parameters.at(0).unit, "K");
    EXPECT_EQ(dataset.read(0, 0, 0).value(1), 9);
    EXPECT_THROW(statedForm((folder_ / "none.json").string()), Error);
}

TEST_F(ImportRaw, BadInputGivesOneLine) {
    write("a.raw", "12345678");
    const std::string path = (folder_ / "a.raw").string();
    EXPECT_THAT(failure(path), testing::HasSubstr("has no sidecar"));
    EXPECT_THAT(failure((folder_ / "missing.raw").string()), testing::HasSubstr("no such file"));
    const auto with = [&](const std::string& json) {
        write("a.json", json);
        const std::string line = failure(path);
        EXPECT_EQ(line.find('\n'), std::string::npos);
        return line;
    };
    EXPECT_EQ(with(R"({"dims":[2,2,2],"dtype":"uint8"})"), "");
    EXPECT_THAT(with("{"), testing::HasSubstr("is not JSON"));
    EXPECT_THAT(with("[1]"), testing::HasSubstr("a.raw: has no sidecar (a.json is a list of 1, without dims)"));
    EXPECT_THAT(with(R"({"name":"a","license":1,"by":2,"of":3,"at":4})"),
                testing::HasSubstr("(a.json is an object with at, by, license, name and 1 more, without dims)"));
    EXPECT_THAT(failure((folder_ / "a.json").string()),
                testing::EndsWith("a.json: is neither a session nor the sidecar of a raw file, which has dims, but an "
                                  "object with at, by, license, name and 1 more"));
    EXPECT_THAT(with(R"({"dims":[2,2,2],"dtype":"complex"})"), testing::HasSubstr("unknown type \"complex\""));
    EXPECT_THAT(with(R"({"dims":[2,2,2]})"), testing::HasSubstr("dtype"));
    EXPECT_THAT(with(R"({"dims":[2,2,3],"dtype":"uint8"})"),
                testing::HasSubstr("has 8 bytes, but its layout needs 12 (2 x 2 x 3 samples, 1 component, 1 time)"));
    EXPECT_THAT(with(R"({"dims":[2,2,1],"dtype":"uint8"})"), testing::HasSubstr("has 8 bytes, but its layout needs 4"));
    EXPECT_THAT(with(R"({"dims":[2,2,-2],"dtype":"uint8"})"), testing::HasSubstr("dims[2]: is -2, must be 1.."));
    EXPECT_THAT(with(R"({"dims":[2,2.5,1],"dtype":"uint8"})"), testing::HasSubstr("dims[1]: is 2.5, must be a whole"));
    EXPECT_THAT(with(R"({"dims":"2x2","dtype":"uint8"})"), testing::HasSubstr("dims: is \"2x2\", must be one to"));
    EXPECT_THAT(with(R"({"dims":[1000000,1000000,1000000],"dtype":"uint8"})"), testing::HasSubstr("10^15"));
    EXPECT_THAT(with(R"({"dims":[1e300,2,2],"dtype":"uint8"})"), testing::HasSubstr("dims"));
    EXPECT_THAT(with(R"({"dims":[2,2,2],"dtype":"uint8","spacing":[0,1,1]})"),
                testing::HasSubstr("spacing[0]: is 0.0, must"));
    EXPECT_THAT(with(R"({"dims":[2,2,1],"dtype":"uint8","times":[1,1]})"),
                testing::HasSubstr("times[1]: is 1.0, must be above 1.0"));
    EXPECT_THAT(with(R"({"dims":[2,2,1],"dtype":"uint8","components":[{"name":"a"},{"name":"a"}]})"),
                testing::HasSubstr("present twice"));
    EXPECT_THAT(with(R"({"dims":[2,2,2],"dtype":"uint8","components":[]})"), testing::HasSubstr("no component"));
    EXPECT_THAT(with(R"({"dims":[2,2,2],"dtype":"uint8","byte_order":"pdp"})"), testing::HasSubstr("byte_order"));
}

TEST_F(ImportRaw, MistakesAreNamedByFileAndPlace) {
    const std::string path = write("a.raw", "12345678");
    const auto with = [&](const std::string& json) {
        write("a.json", json);
        return failure(path);
    };
    const std::string file = (folder_ / "a.json").string() + ": ";
    EXPECT_EQ(with(R"({"dims":[2,2,2],"dtype":"complex"})"), file + "dtype: unknown type \"complex\"");
    EXPECT_THAT(with(R"({"dims":[2,0,2],"dtype":"uint8"})"), testing::StartsWith(file + "dims[1]: is 0, must be 1.."));
    EXPECT_EQ(with(R"({"dims":[2,2,2],"dtype":"uint8","spacing":[1,-1,1]})"),
              file + "spacing[1]: is -1.0, must be a number above 0");
}

TEST_F(ImportRaw, AnEmptyFileIsCalledEmpty) {
    const std::string path = write("a.raw", "");
    EXPECT_THAT(failure(path), testing::EndsWith("a.raw: is empty"));
    write("a.json", R"({"dims":[2,2,1],"dtype":"uint8"})");
    EXPECT_THAT(failure(path), testing::EndsWith("a.raw: is empty"));
}

TEST_F(ImportRaw, ANameThatFitsTheSizeTellsTheForm) {
    const auto told = [&](const std::string& name, std::size_t bytes) {
        return rawOptionOfName(write(name, std::string(bytes, 'x')));
    };
    EXPECT_EQ(told("plain_2x3x4_uint8.raw", 24), "dims=2x3x4,type=uint8");
    EXPECT_EQ(told("Plain-2X3X4.Float32.raw", 96), "dims=2x3x4,type=float32");
    EXPECT_EQ(told("gfs_2x3x4_c5_t2_int16.raw", 480), "dims=2x3x4,type=int16,components=5,times=2");
    EXPECT_EQ(told("scan_t2_2x3x4_u8.raw", 24), "dims=2x3x4,type=u8") << "t2 is no number of times here";
    EXPECT_EQ(told("plain_2x3x4_uint8.raw", 25), "");
    EXPECT_EQ(told("plain_2x3x4.raw", 24), "");
    EXPECT_EQ(told("uint8.raw", 24), "");
    EXPECT_EQ(told("plain_2xx4_uint8.raw", 24), "");
    EXPECT_EQ(told("plain_0x3x4_uint8.raw", 0), "");
    EXPECT_EQ(told("plain_99999999999x3x4_uint8.raw", 24), "");
    EXPECT_EQ(rawOptionOfName((folder_ / "missing_2x3x4_uint8.raw").string()), "");
    ImportOptions options;
    options.raw = told("good_2x3x4_uint8.raw", 24);
    EXPECT_EQ(openFiles({(folder_ / "good_2x3x4_uint8.raw").string()}, options).info.lattice.size, glm::ivec3(2, 3, 4));
}

TEST_F(ImportRaw, FileThatShrinksAfterOpeningIsAnError) {
    const std::string path = write("a.raw", std::string(16, 'x'));
    write("a.json", R"({"dims":[2,2,2],"dtype":"uint8","times":[0,1]})");
    const Dataset dataset = openFiles({path}, {});
    fs::resize_file(path, 12);
    EXPECT_NO_THROW(dataset.read(0, 0, 0));
    EXPECT_THROW(dataset.read(0, 0, 1), Error);
}

TEST_F(ImportRaw, PreviewReadsNoSample) {
    const std::string path = write("a.raw", std::string(16, 'x'));
    write("a.json", R"({"dims":[2,2,2],"dtype":"uint8","times":[0,1]})");
    fs::permissions(path, fs::perms::none);
    const ImportPreview preview = previewFiles({path}, {});
    EXPECT_EQ(preview.format, "raw");
    EXPECT_EQ(preview.bytes, 16);
    EXPECT_EQ(preview.info.times.size(), 2u);
    EXPECT_TRUE(preview.info.parameters[0].ranges.empty());
    fs::permissions(path, fs::perms::owner_all);
}

TEST_F(ImportRaw, NamesUnitsTimesAndChoice) {
    const std::string path = write("a.raw", "12345678");
    write("a.json", R"({"dims":[2,1,1],"dtype":"uint8","times":[0,1],"components":[{"name":"a"},{"name":"b"}]})");
    ImportOptions options;
    options.rename = {{"a", "O2"}};
    options.units = {{"O2", "mol/m3"}};
    options.times = {5, 6};
    options.lengthUnit = "um";
    options.parameters = {"b", "O2"};
    const Dataset dataset = openFiles({path}, options);
    ASSERT_EQ(dataset.info.parameters.size(), 2u);
    EXPECT_EQ(dataset.info.parameters[1].name, "O2");
    EXPECT_EQ(dataset.info.parameters[1].unit, "mol/m3");
    EXPECT_EQ(dataset.info.times, (std::vector<double>{5, 6}));
    EXPECT_EQ(dataset.info.lengthUnit, "um");
    EXPECT_EQ(dataset.read(1, 0, 1).value(0), '5');
    options.rename = {{"a", "b"}};
    EXPECT_THAT(failure(path, options), testing::HasSubstr("two parameters"));
    options.rename = {{"c", "b"}};
    EXPECT_THAT(failure(path, options), testing::HasSubstr("no array \"c\""));
    options.rename.clear();
    options.times = {5};
    EXPECT_THAT(failure(path, options), testing::HasSubstr("--times"));
}

TEST_F(ImportRaw, SeveralFilesAreParametersOrTimes) {
    for (const char* name : {"O2", "H2", "run_10", "run_2"}) {
        write(std::string(name) + ".raw", std::string(8, name[0]));
        write(std::string(name) + ".json", R"({"dims":[2,2,2],"dtype":"uint8"})");
    }
    const std::string base = folder_.string() + "/";
    const Dataset gases = openFiles({base + "O2.raw", base + "H2.json"}, {});
    ASSERT_EQ(gases.info.parameters.size(), 2u);
    EXPECT_EQ(gases.info.parameters[0].name, "O2");
    EXPECT_EQ(gases.read(1, 0, 0).value(0), 'H');
    const Dataset runs = openFiles({base + "run_*.raw"}, {});
    EXPECT_EQ(runs.info.times, (std::vector<double>{2, 10}));
    EXPECT_EQ(runs.info.timeName, "step");
    EXPECT_EQ(runs.info.timeUnit, "");
    write("small.raw", "1");
    write("small.json", R"({"dims":[1,1,1],"dtype":"uint8"})");
    write("moved.raw", "12345678");
    write("moved.json", R"({"dims":[2,2,2],"dtype":"uint8","origin":[1,0,0]})");
    const auto failureWith = [&](const std::string& other) {
        try {
            openFiles({base + "O2.raw", base + other}, {});
            return std::string();
        } catch (const Error& error) {
            return std::string(error.what());
        }
    };
    const std::string grid = " does not lie on the grid of " + base + "O2.raw ",
                      why = "; files that are opened together make one data set";
    EXPECT_EQ(failureWith("small.raw"), base + "small.raw:" + grid + "(1 x 1 x 1 samples against 2 x 2 x 2)" + why);
    EXPECT_EQ(failureWith("moved.raw"),
              base + "moved.raw:" + grid + "(as many samples, but another place or spacing)" + why);
}

TEST_F(ImportRaw, FramesOfASeriesHaveOneType) {
    const auto seriesOf = [&](const std::string& name, std::vector<std::pair<std::string, std::string>> typesAndBytes) {
        std::vector<std::string> paths;
        for (const auto& [sidecar, bytes] : typesAndBytes) {
            const std::string stem = name + "_" + std::to_string(paths.size());
            write(stem + ".json", R"({"dims":[3,1,1],"missing_value":7,)" + sidecar + "}");
            paths.push_back(write(stem + ".raw", bytes));
        }
        return openFiles(paths, {});
    };
    const std::string bytes = bytesOf<std::uint8_t>({7, 250, 1}, false);
    const Dataset mixed = seriesOf("mixed", {{R"("dtype":"uint8")", bytes},
                                             {R"("dtype":"float32")", bytesOf<float>({0.5, 7, -2}, false)},
                                             {R"("dtype":"int16","components":[{"name":"value","scale":0.5}])",
                                              bytesOf<std::int16_t>({-3, 7, 300}, false)}});
    const Dataset whole = seriesOf("whole", {{R"("dtype":"uint8","components":[{"name":"value","scale":0.5}])", bytes},
                                             {R"("dtype":"uint16")", bytesOf<std::uint16_t>({65535, 7, 0}, false)},
                                             {R"("dtype":"int16")", bytesOf<std::int16_t>({-32768, 7, 1}, false)}});
    EXPECT_EQ(mixed.info.parameters[0].type, ScalarType::F32);
    EXPECT_EQ(whole.info.parameters[0].type, ScalarType::I32);
    const auto expectFrame = [](const Dataset& data, int time, const std::vector<double>& values, std::size_t absent) {
        const Field field = data.read(0, 0, time);
        EXPECT_EQ(field.type, data.info.parameters[0].type) << time;
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_EQ(field.present(i), i != absent) << time << " " << i;
            if (i != absent) {
                EXPECT_EQ(field.value(i), values[i]) << time << " " << i;
            }
        }
    };
    expectFrame(mixed, 0, {0, 250, 1}, 0);
    expectFrame(mixed, 1, {0.5, 0, -2}, 1);
    expectFrame(mixed, 2, {-1.5, 0, 150}, 1);
    expectFrame(whole, 0, {0, 125, 0.5}, 0);
    expectFrame(whole, 1, {65535, 0, 0}, 1);
    expectFrame(whole, 2, {-32768, 0, 1}, 1);
}

TEST(ScalarTypes, ACommonTypeHoldsTheNumbersOfBoth) {
    const ScalarType all[] = {ScalarType::U8, ScalarType::I16, ScalarType::U16, ScalarType::I32, ScalarType::F32};
    for (const ScalarType a : all)
        for (const ScalarType b : all) {
            const ScalarType both = commonType(a, b);
            EXPECT_EQ(both, commonType(b, a));
            EXPECT_EQ(both == ScalarType::F32, a == ScalarType::F32 || b == ScalarType::F32);
            if (both == ScalarType::F32) continue;
            dispatch(both, [&]<class Both>(Both) {
                for (const ScalarType one : {a, b})
                    dispatch(one, [&]<class One>(One) {
                        EXPECT_LE(double(std::numeric_limits<Both>::lowest()),
                                  double(std::numeric_limits<One>::lowest()));
                        EXPECT_GE(double(std::numeric_limits<Both>::max()), double(std::numeric_limits<One>::max()));
                    });
            });
        }
    EXPECT_EQ(commonType(ScalarType::U8, ScalarType::I16), ScalarType::I16);
    EXPECT_EQ(commonType(ScalarType::U8, ScalarType::U16), ScalarType::U16);
}

TEST_F(ImportRaw, ScanIgnoresAbsentSamples) {
    const float nan = std::nanf("");
    const std::string path = write("a.raw", bytesOf<float>({nan, 2, 3, -1, 0, 4, 0, 0, 0, 3, 0, 0}, false));
    write("a.json", R"({"dims":[3,1,1],"dtype":"float32","components":[{"name":"T"},{"name":"U.x"},{"name":"U.y"},
        {"name":"U.z"}]})");
    ImportOptions options;
    options.absent = {"U=0"};
    Dataset dataset = openFiles({path}, options);
    scanRanges(dataset);
    EXPECT_EQ(dataset.info.parameters[0].ranges, (std::vector<Range>{{2, 3}}));
    const auto& ranges = dataset.info.parameters[1].ranges;
    ASSERT_EQ(ranges.size(), 4u);
    EXPECT_EQ(ranges[0], (Range{-1, 4})); // the sample in the middle is (0, 0, 0): absent
    EXPECT_EQ(ranges[3], (Range{std::sqrt(10.0), 4}));
    std::stop_source stop;
    stop.request_stop();
    dataset.info.parameters[0].ranges.clear(); // what is known is not scanned again
    EXPECT_THROW(scanRanges(dataset, Progress{{}, stop.get_token()}), Cancelled);
}

TEST(ImportRawData, RealVolumesHaveTheRangesTheirSidecarsState) {
    const std::string folder = testData() + "/volumes/";
    if (!fs::exists(folder)) GTEST_SKIP() << "no test data at " << folder;
    Dataset lobster = openFiles({folder + "lobster_301x324x56_uint8.raw"}, {});
    EXPECT_EQ(lobster.info.lattice.size, glm::ivec3(301, 324, 56));
    EXPECT_EQ(lobster.info.lattice.spacing, glm::dvec3(1, 1, 1.4));
    Dataset colpex = openFiles({folder + "colpex_theta_p_61x61x10_c2_t6_float32.json"}, {});
    scanRanges(colpex);
    ASSERT_EQ(colpex.info.parameters.size(), 2u);
    EXPECT_EQ(colpex.info.times.size(), 6u);
    EXPECT_EQ(colpex.info.parameters[0].ranges[0], (Range{279.7489013671875, 288.8997497558594}));
    EXPECT_EQ(colpex.info.parameters[1].ranges[0], (Range{92734.640625, 102464.609375}));
    EXPECT_EQ(colpex.info.parameters[0].unit, "K");
}

} // namespace
} // namespace tessera::volume
