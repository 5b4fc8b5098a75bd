#include "app/session/import_memory.h"

#include "volume/error.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace tessera::app {
namespace {

namespace fs = std::filesystem;

class ImportMemoryFile : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("tessera_memory_" + std::to_string(getpid()));
        path_ = (folder_ / "deep" / "units.json").string();
    }
    void TearDown() override { fs::remove_all(folder_); }
    fs::path folder_;
    std::string path_;
};

TEST_F(ImportMemoryFile, WhatIsStatedOnceIsKnownTheNextTime) {
    EXPECT_EQ(loadImportMemory(path_), ImportMemory{});
    volume::ImportOptions stated;
    stated.units = {{"O2", "mol/m3"}, {"T", "K"}};
    stated.absent = {"O2=region:0,3"};
    stated.parts = {"T=region:1|3"};
    stated.labels = {"region:1=cathode#0072b2"};
    stated.rename = {{"O2.air", "O2"}};
    ImportMemory memory;
    EXPECT_TRUE(remember(memory, stated, "cell"));
    EXPECT_FALSE(remember(memory, stated, "cell"));
    saveImportMemory(memory, path_);
    EXPECT_EQ(loadImportMemory(path_), memory);

    volume::DatasetInfo info;
    info.name = "cell";
    for (const char* name : {"O2.air", "T", "region"}) {
        volume::Parameter parameter;
        parameter.name = name;
        info.parameters.push_back(parameter);
    }
    volume::ImportOptions now;
    now.units = {{"T", "degC"}};
    const volume::ImportOptions all = withMemory(now, memory, info);
    EXPECT_EQ(all.units.at("O2"), "mol/m3");
    EXPECT_EQ(all.units.at("T"), "degC");
    EXPECT_EQ(all.absent, stated.absent);
    EXPECT_EQ(all.parts, stated.parts);
    EXPECT_EQ(all.labels, stated.labels);
    volume::ImportOptions renamed; // the newest rule of a label counts
    renamed.labels = {"region:1=air,3=fuel"};
    EXPECT_TRUE(remember(memory, renamed, "cell"));
    EXPECT_EQ(memory.labels.at("cell"), renamed.labels);
    EXPECT_EQ(all.rename, stated.rename);
    volume::DatasetInfo other = info;
    other.name = "other";
    EXPECT_TRUE(withMemory(now, memory, other).absent.empty());
    other = info;
    other.parameters.erase(other.parameters.begin()); // no oxygen: neither the name nor the rule fits
    EXPECT_TRUE(withMemory(now, memory, other).absent.empty());
    EXPECT_TRUE(withMemory(now, memory, other).rename.empty());
    now.parts = {"T=joined"};
    EXPECT_EQ(withMemory(now, memory, info).parts, now.parts) << "what is stated now counts";
    now.absent = {"O2=0"};
    EXPECT_EQ(withMemory(now, memory, info).absent, now.absent);
    EXPECT_TRUE(remember(memory, now, "cell"));
    EXPECT_EQ(memory.absent.at("cell"), now.absent);
}

TEST_F(ImportMemoryFile, NamesTakenBackAreForgotten) {
    rememberLabels({"region:1=air", "zone:2=hot"}, {}, "cell", path_);
    rememberLabels({"region:1=air"}, {}, "other", path_);
    EXPECT_EQ(loadImportMemory(path_).labels.at("cell"), (std::vector<std::string>{"region:1=air", "zone:2=hot"}));
    rememberLabels({"zone:2=cold"}, {"region:1=air", "zone:2=hot"}, "cell", path_);
    EXPECT_EQ(loadImportMemory(path_).labels.at("cell"), std::vector<std::string>{"zone:2=cold"});
    rememberLabels({}, {"zone:2=cold"}, "cell", path_);
    EXPECT_FALSE(loadImportMemory(path_).labels.contains("cell"));
    EXPECT_TRUE(loadImportMemory(path_).labels.contains("other"));
}

TEST_F(ImportMemoryFile, DamagedFileIsAnErrorWithItsPlace) {
    fs::create_directories(fs::path(path_).parent_path());
    for (const char* text : {"", "[]", "{\"units\": 3}", "{\"units\": {\"T\": 1}}", "{\"absent\": {\"a\": [\"x\"]}}",
                             "{\"absent\": {\"a\": 1}}", "{\"rename\": {\"a\": 1}}"}) {
        std::ofstream(path_) << text;
        EXPECT_THROW(loadImportMemory(path_), Error) << text;
    }
}

} // namespace
} // namespace tessera::app
