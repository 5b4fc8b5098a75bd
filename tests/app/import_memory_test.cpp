#include "app/user_files/import_memory.h"

#include "volume/base/error.h"

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

/// Everything that options change in the file written below.
std::string effectOf(const std::string& path, const volume::ImportOptions& options) {
    const volume::Dataset data = volume::openFiles({path}, options);
    std::string out = "lengths in " + data.info.lengthUnit + "\n";
    for (std::size_t p = 0; p < data.info.parameters.size(); ++p) {
        const volume::Parameter& parameter = data.info.parameters[p];
        out += parameter.name + " [" + parameter.unit + "]";
        for (const volume::Label& label : parameter.labels)
            out += " " + std::to_string(label.value) + "=" + label.name + label.color;
        out += " parts " + parameter.parts.label;
        for (const std::vector<int>& part : parameter.parts.regions) {
            out += " |";
            for (const int value : part) out += " " + std::to_string(value);
        }
        out += " present ";
        const volume::Field field = data.read(int(p), 0, 0);
        for (std::size_t i = 0; i < field.count(); ++i) out += field.present(i) ? '1' : '0';
        out += "\n";
    }
    return out;
}

/// Statements of one kind about that file, which mean something else each.
struct Statements {
    const char* kind;
    volume::ImportOptions once, later;
};
std::vector<Statements> everyKindOfStatement() {
    std::vector<Statements> all(7);
    all[0].kind = "units", all[0].once.units = {{"T", "K"}}, all[0].later.units = {{"T", "degC"}};
    all[1].kind = "absent", all[1].once.absent = {"T=region:1"}, all[1].later.absent = {"T=3"};
    all[2].kind = "parts", all[2].once.parts = {"T=region:1|2"}, all[2].later.parts = {"T=region:1,2|3"};
    all[3].kind = "labels", all[3].once.labels = {"region:1=cathode"}, all[3].later.labels = {"region:1=anode#e07b39"};
    all[4].kind = "rename", all[4].once.rename = {{"oxy", "O2"}}, all[4].later.rename = {{"oxy", "oxygen"}};
    all[5].kind = "of a renamed parameter";
    all[5].once.rename = {{"oxy", "O2"}}, all[5].once.units = {{"O2", "mol/m3"}}, all[5].once.absent = {"O2=4"};
    all[5].later.rename = {{"oxy", "oxygen"}}, all[5].later.absent = {"oxygen=5"};
    all[6].kind = "lengths", all[6].once.lengthUnit = "cm", all[6].later.lengthUnit = "um";
    return all;
}

TEST_F(ImportMemoryFile, EveryKindIsRecalledForTheFileAndOverriddenByWhatIsStated) {
    fs::create_directories(folder_);
    const auto write = [&](const std::string& name) {
        std::string bytes;
        for (int array = 0; array < 3; ++array)
            for (int i = 0; i < 5 * 6 * 7; ++i) bytes += char(array == 0 ? 1 + i % 5 / 2 : array + i % 6);
        std::ofstream(folder_ / (name + ".raw"), std::ios::binary) << bytes;
        std::ofstream(folder_ / (name + ".json")) << R"({"dims": [5, 6, 7], "dtype": "uint8", "components": [
            {"name": "region", "categorical": true}, {"name": "T"}, {"name": "oxy"}]})";
        return (folder_ / (name + ".json")).string();
    };
    const std::string file = write("cell"), other = write("other");
    const std::string plain = effectOf(file, {});
    ASSERT_EQ(effectOf(other, {}), plain);
    const fs::path known = importMemoryPath();
    for (const Statements& statements : everyKindOfStatement()) {
        SCOPED_TRACE(statements.kind);
        fs::remove(known);
        const std::string once = effectOf(file, statements.once), later = effectOf(file, statements.later);
        ASSERT_NE(once, plain);
        ASSERT_NE(later, plain);
        ASSERT_NE(once, later);
        EXPECT_EQ(effectOf(file, recallOptions({file}, {})), plain) << "nothing is known yet";
        rememberStated(statements.once, volume::openFiles({file}, statements.once).info.name);
        EXPECT_EQ(effectOf(file, recallOptions({file}, {})), once) << "recalled";
        EXPECT_EQ(effectOf(file, recallOptions({file}, statements.later)), later) << "overridden";
        EXPECT_EQ(effectOf(file, recallOptions({file}, {})), once) << "once is not for ever";
        // Units go by the parameter alone, all else by the data too.
        volume::ImportOptions ofAll;
        ofAll.units = statements.once.units;
        EXPECT_EQ(effectOf(other, recallOptions({other}, {})), effectOf(other, ofAll));
        rememberStated(statements.later, volume::openFiles({file}, statements.later).info.name);
        EXPECT_EQ(effectOf(file, recallOptions({file}, {})), later) << "the newest counts";
        // One kind that is stated leaves what is known of the others.
        volume::ImportOptions more;
        more.lengthUnit = "mm";
        more.units = {{"region", "1"}};
        volume::ImportOptions both = statements.later;
        both.units.insert(more.units.begin(), more.units.end());
        both.lengthUnit = "mm";
        EXPECT_EQ(effectOf(file, recallOptions({file}, more)), effectOf(file, both));
        EXPECT_EQ(recallOptions({file}, more).lengthUnit, "mm");
    }
    fs::remove(known);
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

TEST_F(ImportMemoryFile, OfADamagedFileNothingIsRecalledAndThatIsSaid) {
    const fs::path known = importMemoryPath();
    fs::create_directories(known.parent_path());
    for (const char* const damage : {"", "{", R"({"units": 3})", R"({"absent": {"cell": ["no rule ="]}})"}) {
        std::ofstream(known) << damage;
        const volume::ImportOptions stated;
        std::vector<std::string> said;
        EXPECT_TRUE(recallOptions({"none.vti"}, stated, said) == stated);
        ASSERT_EQ(said.size(), 1u) << damage;
        EXPECT_EQ(said[0].find(known.string()), 0u) << said[0];
        volume::ImportOptions more;
        more.units = {{"T", "K"}};
        rememberStated(more, "cell");
        std::string after;
        std::getline(std::ifstream(known) >> std::ws, after, '\0');
        EXPECT_EQ(after, damage) << "it may still be mended by hand";
    }
    fs::remove(known);
}

} // namespace
} // namespace tessera::app
