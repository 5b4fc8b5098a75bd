#include "volume/import/find_parts.h"

#include "tests/volume/fields.h"
#include "volume/base/error.h"
#include "volume/import/import.h"
#include "volume/synthetic/fuel_cell.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>

namespace tessera::volume {
namespace {

using test::ccLattice;
using test::sampled;

/// One parameter, and the label `region` behind it.
template <class Value, class Region>
Dataset labelled(const Lattice& lattice, const Value& value, const Region& region) {
    Dataset dataset = test::datasetOf({sampled<float>(lattice, value), sampled<std::uint8_t>(lattice, region)});
    dataset.info.parameters[1].name = "region";
    dataset.info.parameters[1].categorical = true;
    return dataset;
}

int halves(glm::dvec3 p) {
    return p.y < 6 ? 1 : 3;
}

TEST(FindParts, AJumpSplitsAndASlopeDoesNot) {
    const Lattice lattice = ccLattice({12, 13, 14}, {1, 1, 4});
    const auto found = [&](const auto& value) {
        Dataset dataset = labelled(lattice, value, halves);
        findParts(dataset, {});
        return dataset.info.parameters[0].parts;
    };
    const Parts two{"region", {{1}, {3}}};
    EXPECT_EQ(found([](glm::dvec3 p) { return p.y < 6 ? 1 : 2; }), two);
    EXPECT_EQ(found([](glm::dvec3 p) { return 0.1 * p.y + 0.2 * p.z + (p.y < 6 ? 0 : 7); }), two);
    EXPECT_EQ(found([](glm::dvec3 p) { return 3 * p.y - p.z; }), Parts{}) << "a plane goes on";
    // Heat goes on into a plate that conducts ten times better.
    EXPECT_EQ(found([](glm::dvec3 p) { return 300 + (p.y < 5.5 ? 2 * (p.y - 5.5) : 0.2 * (p.y - 5.5)) + 0.1 * p.z; }),
              Parts{});
    // A jump over half of the border is one, whatever the other half does.
    EXPECT_EQ(found([](glm::dvec3 p) { return p.y < 6 || p.z < 28 ? 1 : 2; }), two);
    EXPECT_EQ(found([](glm::dvec3 p) { return p.y < 6 ? 1 : 1.0005 + (p.x > 5 && p.x < 7 && p.y > 10 ? 1 : 0); }),
              Parts{})
        << "less than a five-hundredth of the range";
}

/// A thick layer of one cell on thin cells: its sample is far away, and only the other side has a slope.
TEST(FindParts, SlopesAreByTrueDistances) {
    const auto z = std::make_shared<const AxisMap>(AxisMap::Of::Cells, std::vector<double>{0, 1, 2, 3, 4, 5, 105});
    const Lattice lattice = withAxes(ccLattice({4, 4, 1}), {{nullptr, nullptr, z}});
    const auto found = [&](double jump) {
        Dataset dataset = labelled(
            lattice, [&](glm::dvec3 p) { return p.z + (p.z > 5 ? jump : 0); },
            [](glm::dvec3 p) { return p.z > 5 ? 3 : 1; });
        findParts(dataset, {});
        return dataset.info.parameters[0].parts;
    };
    EXPECT_EQ(found(0), Parts{}) << "a line goes on";
    EXPECT_EQ(found(1000), (Parts{"region", {{1}, {3}}}));
}

TEST(FindParts, AJumpAtAnyOfTheTimesLookedAt) {
    const Lattice lattice = ccLattice({8, 13, 8});
    std::vector<Field> fields;
    for (int t = 0; t < 5; ++t)
        fields.push_back(sampled<float>(lattice, [&](glm::dvec3 p) { return p.y < 6 ? 1.0 : 1.0 + t; }));
    for (int t = 0; t < 5; ++t) fields.push_back(sampled<std::uint8_t>(lattice, halves));
    Dataset dataset = test::datasetOf(std::move(fields), 5);
    dataset.info.parameters[1].name = "region";
    dataset.info.parameters[1].categorical = true;
    const auto notes = findParts(dataset, {});
    EXPECT_EQ(dataset.info.parameters[0].parts, (Parts{"region", {{1}, {3}}}));
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes[0].substr(0, notes[0].find(" (")), "p0: 2 parts by region: 1 | 3, found from the data");
    dataset.info.parameters[0].parts = {};
    EXPECT_TRUE(findParts(dataset, {parsePartsRule("p0=joined")}).empty()) << "stated";
    EXPECT_TRUE(findParts(dataset, {}, {"region"}).empty()) << "not wanted";
}

TEST(FindParts, RegionsThatMeetNowhereShareAPart) {
    // Layers of 1 2 3 4; a membrane of absent samples, three or eight thick, in the middle.
    for (const int gap : {3, 8}) {
        const Lattice lattice = ccLattice({6, 30, 6});
        const auto region = [&](glm::dvec3 p) {
            return p.y < 6 ? 1 : p.y < 10 ? 2 : p.y < 10 + gap ? 0 : p.y < 23 ? 3 : 4;
        };
        Dataset dataset = labelled(
            lattice, [&](glm::dvec3 p) { return 10.0 * region(p); }, region);
        dataset.read = [read = dataset.read, region](int parameter, int component, int time) {
            Field field = read(parameter, component, time);
            if (parameter == 0) test::removeWhere(field, [&](glm::dvec3 p) { return region(p) == 0; });
            return field;
        };
        findParts(dataset, {});
        const Parts wanted{"region", {{1, 3}, {2, 4}}};
        EXPECT_EQ(dataset.info.parameters[0].parts, wanted) << gap;
        // Three regions in a row that all meet need as many parts as the kernels tell apart.
        const auto bands = [](glm::dvec3 p) { return p.y < 10 ? 1 : p.y < 12 ? 2 : 3; };
        Dataset row = labelled(
            lattice, [&](glm::dvec3 p) { return 10.0 * bands(p); }, bands);
        findParts(row, {});
        EXPECT_EQ(row.info.parameters[0].parts, (Parts{"region", {{1, 3}, {2}}}));
    }
}

TEST(FindParts, RulesSayThePartsOrWhatIsWrongWithThem) {
    DatasetInfo info;
    info.parameters.resize(3);
    info.parameters[0].name = "p";
    info.parameters[1].name = "T";
    info.parameters[2].name = "region";
    info.parameters[2].categorical = true;
    info.parameters[2].labels = {{0, "plate"}, {1, "air"}, {3, "fuel"}};
    setParts(info, {parsePartsRule("*=region:0,1|3"), parsePartsRule("p=region:air|fuel"), parsePartsRule("T=joined")});
    EXPECT_EQ(info.parameters[0].parts, (Parts{"region", {{1}, {3}}}));
    EXPECT_EQ(info.parameters[1].parts, Parts{});
    EXPECT_EQ(partsText(info.parameters[0]), "2 parts by region: 1 | 3");
    EXPECT_EQ(partsText(info.parameters[1]), "");
    setParts(info, {parsePartsRule("p=region:0,1,3")});
    EXPECT_EQ(info.parameters[0].parts, Parts{}) << "one part is none";
    for (const char* bad : {"p", "=region:1|3", "p=", "p=region", "p=region:1|", "p=region:1,,3", "p=:1|3"})
        EXPECT_THROW(parsePartsRule(bad), Error) << bad;
    for (const char* bad : {"q=region:1|3", "p=zone:1|3", "p=T:1|3", "p=region:1|2", "p=region:1|1", "p=region:1|water",
                            "region=region:1|3"})
        EXPECT_THROW(setParts(info, {parsePartsRule(bad)}), Error) << bad;
    try {
        setParts(info, {parsePartsRule("p=T:1|3")});
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "--parts p=...: \"T\" is not a label");
    }
}

TEST(FindParts, TheBuiltInCellSaysWhatItsSamplesShow) {
    Dataset cell = makeFuelCell({{"times", 4}});
    const std::vector<Parameter> stated = cell.info.parameters;
    for (Parameter& parameter : cell.info.parameters) parameter.parts = {};
    findParts(cell, {});
    for (std::size_t p = 0; p < stated.size(); ++p)
        if (stated[p].name != "T") { // between plate and gas it changes within a cell, on this grid a jump
            EXPECT_EQ(cell.info.parameters[p].parts, stated[p].parts) << stated[p].name;
        }
    EXPECT_EQ(partsText(stated[2]), "2 parts by region: 1,2,6 | 4,5,7");
}

// Both grids of the fuel cell: gases and pressure jump across the membrane, the temperature does not.
TEST(FindParts, OfTheFuelCell) {
    const char* stated = std::getenv("TESSERA_DATA");
    const std::filesystem::path data = stated != nullptr ? stated : TESSERA_TEST_DATA;
    for (const char* name : {"small", "large"}) {
        const std::string file = (data / "fuel-cell" / "grid" / name).string() + ".pvd";
        if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
        const ImportPreview preview = previewFiles({file}, {});
        for (const Parameter& parameter : preview.info.parameters) {
            const bool jumps = parameter.name == "p" || parameter.name == "H2O";
            EXPECT_EQ(parameter.parts, jumps ? (Parts{"region", {{1}, {3}}}) : Parts{})
                << name << " " << parameter.name;
        }
        ImportOptions options;
        options.parameters = {"p"};
        EXPECT_EQ(previewFiles({file}, options).info.parameters.size(), 2u) << "p comes with the label of its parts";
        options.parts = {"p=joined"};
        EXPECT_EQ(previewFiles({file}, options).info.parameters.size(), 1u);
    }
}

} // namespace
} // namespace tessera::volume
