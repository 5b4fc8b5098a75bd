// Tables of points as programs write them: COMSOL, CFD-Post, STAR-CCM+, Fluent, ParaView, OpenFOAM, spreadsheets.
#include "tests/import/foreign_files.h"

#include <cmath>

namespace tessera::volume {
namespace {

class TableCases : public ForeignFiles {
protected:
    static std::string given(const std::string& name) { return TESSERA_SOURCE_DIR "/tests/import/cases/" + name; }
    static const Parameter* find(const Dataset& dataset, const std::string& name) {
        const auto at = std::ranges::find(dataset.info.parameters, name, &Parameter::name);
        return at == dataset.info.parameters.end() ? nullptr : &*at;
    }
    static Field field(const Dataset& dataset, const std::string& name, int time = 0, int component = 0) {
        const Parameter* parameter = find(dataset, name);
        if (parameter == nullptr) throw std::runtime_error("no parameter " + name);
        return dataset.read(int(parameter - dataset.info.parameters.data()), component, time);
    }
    static std::string unit(const Dataset& dataset, const std::string& name) {
        const Parameter* parameter = find(dataset, name);
        return parameter != nullptr ? parameter->unit : "missing";
    }
    static std::vector<std::string> notes(const std::string& path) { return previewFiles({path}, {}).notes; }
    static int absent(const Field& field) {
        int count = 0;
        for (std::size_t i = 0; i < field.count(); ++i) count += field.present(i) ? 0 : 1;
        return count;
    }
    static std::string names(const Dataset& dataset) {
        std::string all;
        for (const Parameter& parameter : dataset.info.parameters) all += (all.empty() ? "" : "|") + parameter.name;
        return all;
    }
};

/// The grid of the cases: 8 x 6 x 4 points, 1 x 0.5 x 0.2 apart.
void expectGrid(const Dataset& dataset, glm::dvec3 spacing, const std::string& unit) {
    EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(8, 6, 4));
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(dataset.info.lattice.spacing[axis], spacing[axis], 1e-9);
        EXPECT_NEAR(dataset.info.lattice.origin[axis], 0, 1e-12);
    }
    EXPECT_EQ(dataset.info.lengthUnit, unit);
}

TEST_F(TableCases, ComsolTimesAreTheAxis) {
    const Dataset dataset = openFiles({given("tables/comsol_times.txt")}, {});
    expectGrid(dataset, {1, 0.5, 0.2}, "mm");
    EXPECT_EQ(names(dataset), "T|tcs.c_wO2");
    EXPECT_EQ(unit(dataset, "T"), "K");
    EXPECT_EQ(unit(dataset, "tcs.c_wO2"), "mol/m^3");
    EXPECT_EQ(dataset.info.times, (std::vector<double>{0, 0.5, 1}));
    for (const int time : {2, 0, 1}) {
        EXPECT_FLOAT_EQ(float(field(dataset, "T", time).value(3)), float(346 + 5 * time));
        EXPECT_FLOAT_EQ(float(field(dataset, "tcs.c_wO2", time).value(0)), float(8.4 - 2.1 * time));
    }
}

TEST_F(TableCases, ComsolDescriptionsHaveCommas) {
    const Dataset dataset = openFiles({given("tables/comsol_descr.txt")}, {});
    expectGrid(dataset, {1, 0.5, 0.2}, "mm");
    EXPECT_EQ(names(dataset), "Temperature|Molar concentration, O2");
    EXPECT_EQ(unit(dataset, "Molar concentration, O2"), "mol/m^3");
    EXPECT_FLOAT_EQ(float(field(dataset, "Molar concentration, O2").value(1)), 8.0f);
}

TEST_F(TableCases, ComsolComplexValuesAreTwoParameters) {
    const Dataset dataset = openFiles({given("tables/comsol_complex.txt")}, {});
    EXPECT_EQ(names(dataset), "V.real|V.imag");
    EXPECT_EQ(unit(dataset, "V.imag"), "V");
    EXPECT_FLOAT_EQ(float(field(dataset, "V.real").value(2)), 345e-4f);
    EXPECT_FLOAT_EQ(float(field(dataset, "V.imag").value(2)), 101315.0f);
    ASSERT_EQ(dataset.info.quantities.size(), 1u);
    EXPECT_EQ(dataset.info.quantities[0].name, "freq");
    EXPECT_EQ(dataset.info.quantities[0].values, std::vector<double>{1000});
}

TEST_F(TableCases, ComsolGridForm) {
    const Dataset dataset = openFiles({given("tables/comsol_grid.txt")}, {});
    expectGrid(dataset, {1, 0.5, 0.2}, "mm");
    const Field t = field(dataset, "T");
    for (int x = 0; x < 8; ++x) EXPECT_EQ(t.value(dataset.info.lattice.index({x, 4, 2})), 343 + x);
    EXPECT_EQ(unit(dataset, "T"), "K");
    std::string text = read(given("tables/comsol_grid.txt"));
    text.resize(text.find_last_not_of(" \n") + 1);
    text.resize(text.find_last_of(" \n") + 1); // a number of one digit: cuts within the last one are not seen
    const std::string path = write("grid.txt", text + "7\n");
    expectCutsAreTold(path, path, {}, 30);
}

TEST_F(TableCases, ComsolGridOfSeveralTimesAndHoles) {
    const Dataset dataset =
        openFiles({write("g.txt", "% Model:              a.mph\n% Dimension:          2\n% Nodes:  6\n"
                                  "% Length unit:        \xB5m\n% Grid\n0 1 2\n5 4\n"
                                  "% Data (T (K) @ t=0.1)\n1 2 3\n4 NaN 6\n"
                                  "% Data (T (K) @ t=0.3)\n11 12 13\n14 NaN 16\n"
                                  "% Data (c (mol/m^3) @ t=0.3)\n7 7 7\n8 8 9")},
                  {});
    EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(3, 2, 1));
    EXPECT_EQ(dataset.info.lattice.origin.y, 4);
    EXPECT_EQ(dataset.info.lengthUnit, "\u00b5m");
    EXPECT_EQ(dataset.info.times, (std::vector<double>{0.1, 0.3}));
    const Field t = field(dataset, "T", 1);
    EXPECT_EQ(t.value(0), 14); // y = 4
    EXPECT_EQ(t.value(5), 13);
    EXPECT_FALSE(t.present(1));
    EXPECT_EQ(absent(t), 1);
    EXPECT_EQ(absent(field(dataset, "c", 0)), 6) << "not computed at that time";
    EXPECT_EQ(field(dataset, "c", 1).value(2), 9);
}

TEST_F(TableCases, ComsolSectionsAreAMesh) {
    const std::string text = "% Model: a.mph\n% Dimension: 3\n% Nodes: 8\n% Elements: 5\n% Length unit: mm\n"
                             "% Coordinates\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n"
                             "% Elements (tetrahedra)\n1 2 3 5\n2 4 3 8\n2 5 6 8\n3 5 8 7\n2 3 5 8\n"
                             "% Data (T (K))\n0\n1\n0\n1\n0\n1\n0\n1\n";
    ImportOptions options;
    options.gridSize = {5, 3, 3};
    const Dataset dataset = openFiles({write("s.txt", text)}, options);
    const Field t = field(dataset, "T");
    for (std::size_t i = 0; i < t.count(); ++i) EXPECT_NEAR(t.value(i), double(i % 5) / 4, 1e-6);
    EXPECT_EQ(dataset.info.lengthUnit, "mm");
    EXPECT_THAT(failure(write("s.txt", text.substr(0, text.size() - 4))), testing::HasSubstr("truncated"));
    std::string bad = text;
    bad.replace(bad.find("1 2 3 5"), 7, "1 2 3 9");
    EXPECT_THAT(failure(write("s.txt", bad)), testing::HasSubstr("point 9 of 8"));
}

TEST_F(TableCases, ComsolParametersThatVaryAreAxisOrNames) {
    const std::string head = "% Model: a.mph\n% Dimension: 2\n";
    const Dataset swept =
        openFiles({write("a.txt", head + "% x                       y                        V (V) @ 1: "
                                         "U0=0.9[V], T0=300 V (V) @ 2: U0=0.6[V], T0=310\n"
                                         "0 0 1 2\n1 0 3 4\n0 1 5 6\n1 1 7 8\n")},
                  {});
    EXPECT_EQ(swept.info.timeName, "U0");
    EXPECT_EQ(swept.info.timeUnit, "V");
    EXPECT_EQ(swept.info.times, (std::vector<double>{0.6, 0.9}));
    EXPECT_EQ(field(swept, "V", 0).value(3), 8);
    EXPECT_EQ(field(swept, "V", 1).value(3), 7);
    ASSERT_EQ(swept.info.quantities.size(), 1u);
    EXPECT_EQ(swept.info.quantities[0].values, (std::vector<double>{310, 300}));
    const Dataset both =
        openFiles({write("b.txt", head + "% x  y  T (K) @ t=0, p=1  T (K) @ t=1, p=1  T (K) @ t=0, p=2  "
                                         "T (K) @ t=1, p=2\n"
                                         "0 0 1 2 3 4\n1 0 1 2 3 4\n0 1 1 2 3 4\n1 1 1 2 3 4\n")},
                  {});
    EXPECT_EQ(names(both), "T, p=1|T, p=2");
    EXPECT_EQ(both.info.times, (std::vector<double>{0, 1}));
    EXPECT_EQ(field(both, "T, p=2", 1).value(0), 4);
}

TEST_F(TableCases, SectionsOfCfdPost) {
    const Dataset dataset = openFiles({given("tables/cfdpost.csv")}, {});
    expectGrid(dataset, {1e-3, 5e-4, 2e-4}, "m");
    EXPECT_EQ(names(dataset), "Temperature|Pressure|O2.Mass Fraction|U");
    EXPECT_EQ(unit(dataset, "U"), "m s^-1");
    EXPECT_EQ(find(dataset, "U")->components, 3);
    EXPECT_FLOAT_EQ(float(field(dataset, "Temperature").value(8)), 343.0f);
    EXPECT_FLOAT_EQ(float(field(dataset, "Temperature").value(7)), 350.0f);
    EXPECT_THAT(notes(given("tables/cfdpost.csv")),
                testing::IsSupersetOf({"U formed from Velocity u, Velocity v, Velocity w",
                                       "column Node Number is left out: it counts the rows"}));
    const Dataset holes =
        openFiles({write("n.csv", "[Name]\nair\n\n[Data]\nX [ m ], Y [ m ], T [ K ]\n0,0,1\n1,0,null\n"
                                  "0,1,3\n1,1,4\n\n[Faces]\n0, 1, 3, 2\n")},
                  {});
    EXPECT_EQ(absent(field(holes, "T")), 1);
    EXPECT_FALSE(field(holes, "T").present(1));
}

TEST_F(TableCases, ZonesThatShareABorder) {
    const Dataset dataset = openFiles({given("tables/two_zones.csv")}, {});
    EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(4, 3, 5));
    EXPECT_EQ(names(dataset), "Temperature|region");
    const Field t = field(dataset, "Temperature"), region = field(dataset, "region");
    EXPECT_EQ(absent(t), 0);
    EXPECT_EQ(t.value(dataset.info.lattice.index({2, 1, 1})), 302);
    EXPECT_EQ(t.value(dataset.info.lattice.index({2, 1, 3})), 352);
    EXPECT_NE(region.value(0), region.value(region.count() - 1));
    std::string joined = "x,y,T\n";
    for (int i = 0; i < 4; ++i)
        for (const int y : {0, 1})
            joined += std::to_string(i) + "," + std::to_string(y) + "," + std::to_string(i) + "\n";
    for (const int y : {0, 1}) joined += "2," + std::to_string(y) + ",2\n";
    const std::string path = write("j.csv", joined);
    const Dataset equal = openFiles({path}, {});
    EXPECT_EQ(names(equal), "T");
    EXPECT_EQ(equal.info.lattice.size, glm::ivec3(4, 2, 1));
    EXPECT_THAT(notes(path), testing::Contains(testing::HasSubstr("2 rows repeat a position with the same values")));
}

TEST_F(TableCases, WordsAreLabels) {
    const Dataset dataset = openFiles({given("tables/words.csv")}, {});
    ASSERT_NE(find(dataset, "region"), nullptr);
    EXPECT_TRUE(find(dataset, "region")->categorical);
    EXPECT_EQ(find(dataset, "region")->labels, (std::vector<Label>{{1, "anode"}, {2, "cathode"}}));
    EXPECT_EQ(field(dataset, "region").value(1), 1);
    EXPECT_EQ(field(dataset, "region").value(2), 2);
    EXPECT_EQ(field(dataset, "T").value(3), 4);
}

TEST_F(TableCases, ALastLineNeedsNoEnd) {
    const Dataset dataset = openFiles({given("tables/noeol.csv")}, {});
    EXPECT_EQ(field(dataset, "T").value(3), 4);
    EXPECT_THAT(failure(write("a.csv", "x,y,T\n0,0,1\n1,0,2\n0,1,3\n1,1,")), testing::HasSubstr("truncated"));
    EXPECT_THAT(failure(write("a.csv", "x,y,T\n0,0,1\n1,0,2\n0,1,3\n1,1")), testing::HasSubstr("truncated"));
}

TEST_F(TableCases, HeadingsOfPrograms) {
    struct Case {
        const char *name, *text, *names, *unit, *lengthUnit;
    };
    const std::string four = "0,0,1,5,6,7\n1,0,2,5,6,7\n0,1,3,5,6,7\n1,1,4,5,6,7\n";
    std::string blanks = four, semicolons = four;
    std::ranges::replace(blanks, ',', ' ');
    std::ranges::replace(semicolons, ',', ';');
    for (const auto& [name, text, parameters, lengthUnit] : std::vector<std::array<std::string, 4>>{
             {"star.csv",
              "\"X (m)\",\"Y (m)\",\"Temperature (K)\",\"Velocity[i] (m/s)\",\"Velocity[j] (m/s)\",\"Velocity[k] "
              "(m/s)\"\n" +
                  four,
              "Temperature|U", "m"},
             {"star2.csv",
              "\"Position[X] (mm)\",\"Position[Y] (mm)\",\"Temperature (K)\",\"A[i]\",\"A[j]\",\"A[k]\"\n" + four,
              "Temperature|A", "mm"},
             {"fluent", "x-coordinate,    y-coordinate, temperature, x-velocity, y-velocity, z-velocity\n" + four,
              "temperature|U", ""},
             {"export.dat", "x-coordinate y-coordinate temperature x-velocity y-velocity z-velocity\n" + blanks,
              "temperature|U", ""},
             {"paraview.csv", "Points:0,Points:1,T,U:0,U:1,U:2\n" + four, "T|U", ""},
             {"paraview2.csv", "\"Points_0\",\"Points_1\",T,\"U_0\",\"U_1\",\"U_2\"\n" + four, "T|U", ""},
             {"plane_T_U.xy", "# T U  POINT_DATA 4\n# x  y  T  U_x  U_y  U_z\n" + blanks, "T|U", ""},
             {"excel.csv", "sep=;\r\nx [cm];y [cm];T;a;b;c\r\n" + semicolons, "T|a|b|c", "cm"},
             {"units.csv", "x,y,T,a,b,c\nmm,mm,K,-,1,Pa\n" + four, "T|a|b|c", "mm"},
             {"bom.csv", "\xEF\xBB\xBFx,y,T,a,b,c\n" + four, "T|a|b|c", ""}}) {
        SCOPED_TRACE(name);
        const Dataset dataset = openFiles({write(name, text)}, {});
        EXPECT_EQ(names(dataset), parameters);
        EXPECT_EQ(dataset.info.lattice.size, glm::ivec3(2, 2, 1));
        EXPECT_EQ(dataset.info.lengthUnit, lengthUnit);
        for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(dataset.read(0, 0, 0).value(i), double(i + 1));
        const bool vector = dataset.info.parameters.size() == 2;
        EXPECT_EQ(dataset.read(vector ? 1 : 3, vector ? 2 : 0, 0).value(3), 7);
    }
    EXPECT_EQ(unit(openFiles({(folder_ / "units.csv").string()}, {}), "T"), "K");
    EXPECT_EQ(unit(openFiles({(folder_ / "star.csv").string()}, {}), "U"), "m/s");
}

TEST_F(TableCases, FieldsThatAreNoNumbers) {
    std::string text = "x;y;T [\xB0"
                       "C];p\n";
    for (int i = 0; i < 12; ++i)
        text += std::to_string(i % 4) + "," + "0;" + std::to_string(i / 4) + ";" +
                (i == 3   ? "n/a"
                 : i == 5 ? "#DIV/0!"
                          : "1,5") +
                ";" + (i == 7 ? "oops" : "1.25D+01") + "\n";
    const std::string path = write("a.csv", text);
    const Dataset dataset = openFiles({path}, {});
    EXPECT_EQ(unit(dataset, "T"), "\u00b0C");
    EXPECT_EQ(absent(field(dataset, "T")), 2);
    EXPECT_EQ(field(dataset, "T").value(0), 1.5);
    EXPECT_EQ(absent(field(dataset, "p")), 1);
    EXPECT_EQ(field(dataset, "p").value(0), 12.5);
    EXPECT_THAT(notes(path), testing::Contains(testing::HasSubstr("line 9, column p: \"oops\" is not a number")));
    const std::string mixed = write("b.csv", "x,y,T,s\n0,0,1,1\n1,0,2,a\n0,1,3,2\n1,1,4,b\n");
    EXPECT_EQ(names(openFiles({mixed}, {})), "T");
    EXPECT_THAT(notes(mixed),
                testing::Contains(testing::HasSubstr("column s: \"a\" is not a number: the column is left out")));
    std::string wide = "x,y";
    for (int i = 0; i < 1500; ++i) wide += ",c" + std::to_string(i);
    wide += "\n0,0";
    for (int i = 0; i < 1500; ++i) wide += ",1";
    EXPECT_THAT(failure(write("w.csv", wide)), testing::HasSubstr("more than 1000 are not read"));
}

TEST_F(TableCases, TimesInAColumnNeedNotHaveTheSameRows) {
    const Dataset dataset = openFiles(
        {write("t.csv", "time (s),x,y,T\n0,0,0,1\n0,1,0,2\n0,0,1,3\n0,1,1,4\n1,1,1,14\n1,0,0,11\n1,1,0,12\n")}, {});
    EXPECT_EQ(dataset.info.times, (std::vector<double>{0, 1}));
    EXPECT_EQ(dataset.info.timeUnit, "s");
    const Field late = field(dataset, "T", 1);
    EXPECT_EQ(absent(late), 1);
    EXPECT_EQ(late.value(3), 14);
    EXPECT_FALSE(late.present(2));
    EXPECT_EQ(field(dataset, "T", 0).value(2), 3);
}

TEST_F(TableCases, ArraysOfComsolsMeshesAreTimes) {
    const Dataset dataset = openFiles({given("vtk/comsol_times.vtu")}, {});
    EXPECT_EQ(names(dataset), "Temperature|Molar_concentration,_O2");
    EXPECT_EQ(dataset.info.times.size(), 3u);
    EXPECT_EQ(field(dataset, "Temperature", 0).value(1), 301);
    EXPECT_NE(field(dataset, "Temperature", 2).value(1), field(dataset, "Temperature", 0).value(1));
    EXPECT_EQ(field(dataset, "Temperature", 0).value(1), 301) << "asked again";
}

TEST_F(TableCases, ComponentsAreAVector) {
    const std::string path = given("vtk/components.vtu");
    const Dataset dataset = openFiles({path}, {});
    EXPECT_EQ(names(dataset), "U|temperature");
    EXPECT_EQ(find(dataset, "U")->components, 3);
    EXPECT_THAT(notes(path), testing::Contains("U formed from x_velocity, y_velocity, z_velocity"));
    ImportOptions options;
    options.parameters = {"x_velocity"};
    const Dataset scalar = openFiles({path}, options);
    ASSERT_EQ(names(scalar), "x_velocity");
    const Field whole = field(dataset, "U", 0, 0), alone = field(scalar, "x_velocity");
    for (std::size_t i = 0; i < whole.count(); ++i) EXPECT_EQ(whole.value(i), alone.value(i));
}

TEST_F(TableCases, OptionsThatFitNothingAreRefused) {
    const std::string path = write("a.csv", "x,y,T,p\n0,0,1,2\n1,0,2,2\n0,1,3,2\n1,1,4,2\n");
    const auto with = [&](const auto& state) {
        ImportOptions options;
        state(options);
        try {
            previewFiles({path}, options);
            return std::string();
        } catch (const Error& error) {
            return std::string(error.what());
        }
    };
    EXPECT_THAT(with([](ImportOptions& o) { o.units["Tmp"] = "K"; }), testing::HasSubstr("\"Tmp\" (there are T, p)"));
    EXPECT_EQ(with([](ImportOptions& o) { o.units["T"] = "of my own"; }), "");
    EXPECT_THAT(with([](ImportOptions& o) { o.lengthUnit = "foo"; }), testing::HasSubstr("not a unit of length"));
    for (const char* unit : {"mm", "um", "voxel", "Meter", "angstrom", "px"})
        EXPECT_EQ(with([&](ImportOptions& o) { o.lengthUnit = unit; }), "") << unit;
    EXPECT_THAT(with([](ImportOptions& o) { o.timeUnit = "K"; }), testing::HasSubstr("--time-name"));
    EXPECT_EQ(with([](ImportOptions& o) { o.timeUnit = "K", o.timeName = "state"; }), "");
    EXPECT_NE(with([](ImportOptions& o) { o.absent = {"Tmp=nan"}; }), "");
    EXPECT_NE(with([](ImportOptions& o) { o.absent = {"Tmp=none"}; }), "");
    EXPECT_NE(with([](ImportOptions& o) { o.parts = {"Tmp=joined"}; }), "");
    EXPECT_NE(with([](ImportOptions& o) { o.labels = {"Tmp:0=a"}; }), "");
    EXPECT_NE(with([](ImportOptions& o) { o.parameters = {"Tmp"}; }), "");
    ImportOptions unit;
    unit.units["Tmp"] = "K";
    EXPECT_NO_THROW(openFiles({path}, unit)) << "as sessions may";
}

TEST_F(TableCases, ColumnsThatComeAgainAreNumbered) {
    std::string text = "x,y,z,T,T,T.3,T,T\n";
    for (int row = 0; row < 8; ++row)
        text += std::to_string(row % 2) + "," + std::to_string(row / 2 % 2) + "," + std::to_string(row / 4) +
                ",1,2,3,4,5\n";
    const Dataset dataset = openFiles({write("again.csv", text)}, {});
    EXPECT_EQ(names(dataset), "T|T.2|T.3|T.4|T.5");
    EXPECT_EQ(field(dataset, "T.3").value(0), 3);
    EXPECT_EQ(field(dataset, "T.4").value(0), 4);
    EXPECT_EQ(field(dataset, "T.5").value(0), 5);
}

} // namespace
} // namespace tessera::volume
