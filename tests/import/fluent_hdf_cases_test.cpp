#include "tests/import/foreign_files.h"

namespace tessera::volume {
namespace {

std::string fluentCase(const std::string& name) {
    return std::string(TESSERA_SOURCE_DIR) + "/tests/import/cases/fluent_hdf/" + name;
}

const Parameter* named(const Dataset& dataset, const std::string& name) {
    const auto at = std::ranges::find(dataset.info.parameters, name, &Parameter::name);
    return at == dataset.info.parameters.end() ? nullptr : &*at;
}

Field fieldOf(const Dataset& dataset, const std::string& name, int component, int time) {
    return dataset.read(int(named(dataset, name) - dataset.info.parameters.data()), component, time);
}

class FluentHdfCases : public ForeignFiles {};

TEST_F(FluentHdfCases, ZonesNamesAndUnits) {
    for (const char* name : {"box.cas.h5", "box.dat.h5"}) { // the data find their case
        const Dataset dataset = openFiles({fluentCase(name)}, {});
        const Lattice& lattice = dataset.info.lattice;
        ASSERT_EQ(lattice.size, glm::ivec3(4, 2, 2));
        EXPECT_EQ(dataset.info.lengthUnit, "m");
        ASSERT_NE(named(dataset, "T"), nullptr);
        EXPECT_EQ(named(dataset, "T")->unit, "K");
        EXPECT_EQ(named(dataset, "p")->unit, "Pa");
        ASSERT_EQ(named(dataset, "U")->components, 3);
        EXPECT_EQ(named(dataset, "SV_T_M1"), nullptr);
        ASSERT_NE(named(dataset, "h2"), nullptr);
        EXPECT_EQ(named(dataset, "region")->labels[1].name, "solid");
        EXPECT_EQ(fieldOf(dataset, "T", 0, 0).value(lattice.index({0, 1, 1})), 300.5);
        EXPECT_EQ(fieldOf(dataset, "T", 0, 0).value(lattice.index({3, 1, 1})), 303.5);
        EXPECT_EQ(fieldOf(dataset, "U", 1, 0).value(lattice.index({1, 1, 0})), 1.5);
        EXPECT_FALSE(fieldOf(dataset, "p", 0, 0).present(lattice.index({2, 0, 0}))); // of the solid
        EXPECT_TRUE(fieldOf(dataset, "p", 0, 0).present(lattice.index({1, 0, 0})));
    }
}

TEST_F(FluentHdfCases, ASeriesOfDataSharesItsCase) {
    const Dataset dataset = openFiles({fluentCase("run.cas.h5")}, {});
    EXPECT_EQ(dataset.info.times, (std::vector<double>{0.02, 0.1, 1}));
    EXPECT_EQ(dataset.info.timeUnit, "s");
    const std::size_t place = dataset.info.lattice.index({3, 0, 0});
    EXPECT_EQ(fieldOf(dataset, "T", 0, 2).value(place), 403.5);
    EXPECT_EQ(fieldOf(dataset, "T", 0, 0).value(place), 305.5);
    EXPECT_FALSE(fieldOf(dataset, "p", 0, 0).present(place)); // not yet
    EXPECT_EQ(fieldOf(dataset, "p", 0, 1).value(place), 303.5);
}

TEST_F(FluentHdfCases, AllKindsOfCells) {
    ImportOptions fine;
    fine.gridSize = {40, 20, 40};
    const Dataset dataset = openFiles({fluentCase("kinds.cas.h5")}, fine);
    const Field field = fieldOf(dataset, "T", 0, 0);
    std::size_t present = 0;
    for (std::size_t i = 0; i < field.count(); ++i) present += field.present(i) ? 1 : 0;
    // Two cubes of 1 m3, a pyramid of 1/3, a tetrahedron of 1/6 and one of 1/6 of faces, in a box of 4 m3.
    EXPECT_NEAR(double(present) / double(field.count()), (2 + 1.0 / 3 + 1.0 / 6 + 1.0 / 6) / 4, 0.01);
    const Dataset flat = openFiles({fluentCase("flat.cas.h5")}, {});
    EXPECT_EQ(flat.info.lattice.size, glm::ivec3(3, 2, 1));
    EXPECT_EQ(fieldOf(flat, "U", 1, 0).value(flat.info.lattice.index({2, 1, 0})), 10);
}

TEST_F(FluentHdfCases, WhatIsMissingIsTold) {
    const std::string mesh = write("a.cas.h5", read(fluentCase("box.cas.h5")));
    EXPECT_THAT(failure(mesh), testing::HasSubstr("its file a.dat.h5 is not beside it"));
    const std::string data = write("b.dat.h5", read(fluentCase("box.dat.h5")));
    EXPECT_THAT(failure(data), testing::HasSubstr("its case b.cas.h5 is not beside it"));
    write("a.dat.h5", read(fluentCase("box.dat.h5")));
    expectCutsAreTold(mesh, mesh);
    expectCutsAreTold(mesh, (folder_ / "a.dat.h5").string());
}

} // namespace
} // namespace tessera::volume
