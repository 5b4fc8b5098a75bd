#include "volume/field/labels.h"

#include "tests/volume/fields.h"
#include "volume/base/error.h"
#include "volume/export/export.h"
#include "volume/import/import.h"
#include "volume/sources/labelled_source.h"
#include "volume/sources/memory_source.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace tessera::volume {
namespace {

namespace fs = std::filesystem;

TEST(ImportLabels, RulesAreReadAndWritten) {
    const LabelRule rule = parseLabelRule("region: 3=solid, 0=cathode side ,1=anode#E07b39,-2=#0072b2");
    EXPECT_EQ(rule.parameter, "region");
    EXPECT_EQ(
        rule.labels,
        (std::vector<Label>{{-2, "", "#0072b2"}, {0, "cathode side", ""}, {1, "anode", "#E07b39"}, {3, "solid", ""}}));
    EXPECT_EQ(toText(rule), "region:-2=#0072b2,0=cathode side,1=anode#E07b39,3=solid");
    EXPECT_EQ(parseLabelRule(toText(rule)), rule);
    EXPECT_EQ(labelOf(4, "gas #12"), (Label{4, "gas #12", ""}));
    EXPECT_EQ(labelText(labelOf(4, "gas#123456")), "gas#123456");
    for (const char* wrong : {"", "region", ":0=a", "region:", "region:0", "region:a=b", "region:1.5=b", "region:0=",
                              "region:0=a,0=b", "region:0=a,", "region:0=a#12", "region:0=a#gggggg", "region:=a"})
        EXPECT_THROW(parseLabelRule(wrong), Error) << wrong;
}

/// Three times two samples: label, temperature, and an index that is no label by its name.
std::string writeCell(const fs::path& folder) {
    fs::create_directories(folder);
    std::ofstream(folder / "cell.json") << R"({"dims":[6,1,1],"dtype":"float32","file":"cell.raw","components":[
        {"name":"zone","labels":{"1":"air#0072b2"},"categorical":true},{"name":"T"},{"name":"domain"}]})";
    std::ofstream raw(folder / "cell.raw", std::ios::binary);
    for (const std::vector<float>& values :
         {std::vector<float>{1, 1, 2, 2, 7, 7}, {300.5f, 301, 302, 303, 304, 305}, {0, 0, 0, 4, 4, 4}})
        raw.write(reinterpret_cast<const char*>(values.data()), std::streamsize(values.size() * sizeof(float)));
    return (folder / "cell.json").string();
}

TEST(ImportLabels, NameTheValuesOfTheData) {
    const fs::path folder = fs::temp_directory_path() / ("tessera_labels_" + std::to_string(getpid()));
    const std::string path = writeCell(folder);
    ImportOptions options;
    options.labels = {"zone:2=fuel,7=plate#123456", "domain:4=gas"};
    Dataset data = openFiles({path}, options);
    const Parameter& zone = data.info.parameters[0];
    EXPECT_TRUE(zone.categorical);
    EXPECT_EQ(zone.labels, (std::vector<Label>{{1, "air", "#0072b2"}, {2, "fuel", ""}, {7, "plate", "#123456"}}));
    EXPECT_TRUE(data.info.parameters[2].categorical); // stated to be one
    EXPECT_EQ(data.info.parameters[2].labels, (std::vector<Label>{{0, "domain 0", ""}, {4, "gas", ""}}));
    EXPECT_FALSE(openFiles({path}, {}).info.parameters[2].categorical);
    // Names count in other rules.
    options.absent = {"T=zone:fuel"};
    const Field field = openFiles({path}, options).read(1, 0, 0);
    EXPECT_TRUE(field.present(1));
    EXPECT_FALSE(field.present(2));
    for (const char* wrong : {"T:300=cold", "nothing:1=a"}) {
        options.labels = {wrong};
        EXPECT_THROW(openFiles({path}, options), Error) << wrong;
    }
    // Exported and read back: names and colours stay.
    ImportOptions stated;
    stated.labels = {"zone:1=air,2=fuel#d55e00,7=plate"};
    data = openFiles({path}, stated);
    const std::string out = (folder / "back.raw").string();
    exportDataset(data, {}, out);
    EXPECT_EQ(openFiles({(folder / "back.json").string()}, {}).info.parameters[0].labels,
              data.info.parameters[0].labels);
    fs::remove_all(folder);
}

TEST(ImportLabels, AreLaidOverASource) {
    Field label = test::sampled<std::uint8_t>(test::ccLattice({3, 3, 3}), [](glm::dvec3 p) { return p.x; });
    Dataset data = test::datasetOf({label});
    data.info.parameters[0].categorical = true;
    data.info.parameters[0].labels = {{0, "old", "#111111"}};
    const auto source = makeMemorySource(data, {LatticeKind::CC, 32, std::size_t(1) << 20});
    EXPECT_EQ(withLabelNames(source, {}), source);
    const auto named = withLabelNames(source, {"p0:0=new,2=third"});
    EXPECT_EQ(named->info().parameters[0].labels, (std::vector<Label>{{0, "new", "#111111"}, {2, "third", ""}}));
    EXPECT_EQ(named->read({0, 0, 0, {0, 0, 0}}).values, source->read({0, 0, 0, {0, 0, 0}}).values);
    EXPECT_THROW(withLabelNames(source, {"p1:0=a"}), Error);
}

} // namespace
} // namespace tessera::volume
