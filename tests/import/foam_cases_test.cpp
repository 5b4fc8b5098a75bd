#include "tests/import/opened_case.h"

#include <cmath>

/// Cases of OpenFOAM as its programs write them: times, regions, processors, binary files, and fields that state their
/// values otherwise.
namespace tessera::volume {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class FoamCases : public Cases {};

/// Samples of a grid of 4 x 3 x 2 cells that are not those of the case cells_*.
std::size_t wrongCells(const OpenedCase& opened, int time) {
    const double at = opened.info().times[std::size_t(time)];
    const auto near = [](double value, double wanted) { return std::abs(value - wanted) < 1e-4; };
    std::size_t wrong = 0;
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 4; ++i) {
                const glm::ivec3 n(i, j, k);
                const bool right = near(opened.at("T", n, time), 300 + 1000 * at + i + 10 * j + 100 * k) &&
                                   near(opened.at("U", n, time, 0), i + at) && opened.at("U", n, time, 1) == j &&
                                   opened.at("U", n, time, 2) == k && opened.at("R.xx", n, time) == 1 &&
                                   opened.at("R.xz", n, time) == 3 && opened.at("R.zz", n, time) == 6 &&
                                   opened.at("source", n, time) == 2 * i &&
                                   near(opened.at("pointDisplacement", n, time, 0), i + 0.5) &&
                                   near(opened.at("pointDisplacement", n, time, 2), k + 0.5);
                wrong += right ? 0 : 1;
            }
    return wrong;
}

TEST_F(FoamCases, EachTimeHasItsOwnValues) {
    const OpenedCase opened = openCase("foam/times/c.foam");
    EXPECT_THAT(opened.info().times, ElementsAre(0, 1, 2));
    EXPECT_EQ(opened.info().timeUnit, "s");
    EXPECT_EQ(opened.info().lengthUnit, "m");
    EXPECT_EQ(opened.about("T").unit, "K");
    for (const int time : {2, 0, 1, 2, 1, 0}) EXPECT_EQ(opened.mean("T", time), 300 + 10 * time) << time;
}

TEST_F(FoamCases, AFieldMayBeginLater) {
    const OpenedCase opened = openCase("foam/late_field/c.foam");
    EXPECT_THAT(opened.info().times, ElementsAre(0, 1, 2));
    EXPECT_EQ(opened.present("T", 0), 16u);
    EXPECT_EQ(opened.present("O2", 0), 0u);
    EXPECT_EQ(opened.present("O2", 1), 16u);
    EXPECT_EQ(opened.mean("T", 0), 300);
}

TEST_F(FoamCases, RegionsAreRead) {
    ImportOptions options;
    options.gridSize = {20, 6, 98};
    const OpenedCase opened = openCase("foam/thin_membrane/fc.foam", options);
    EXPECT_NEAR(opened.mean("O2", 0), 0.21, 1e-6);
    EXPECT_NEAR(opened.mean("O2", 1), 0.17, 1e-6);
    EXPECT_NEAR(opened.mean("O2", 2), 0.13, 1e-6);
    EXPECT_EQ(opened.present("lambda", 0), 240u);
    EXPECT_NEAR(opened.mean("lambda", 1), 7, 1e-5);
    EXPECT_EQ(opened.about("p").unit, "Pa");
    EXPECT_EQ(opened.about("region").labels.size(), 3u);
}

// Layers as they are: the membrane of two cells, 50 um of 2.45 mm, has two samples as thick as its cells.
TEST_F(FoamCases, AThinRegionKeepsItsCellsAndItsVolume) {
    const OpenedCase opened = openCase("foam/thin_membrane/fc.foam");
    EXPECT_EQ(opened.info().lattice.size, glm::ivec3(20, 6, 20));
    EXPECT_EQ(opened.present("lambda", 0), 240u);
    EXPECT_EQ(opened.present("region", 0), 2400u);
    EXPECT_FALSE(opened.isNoted("volume than its cells have"));
    EXPECT_TRUE(opened.isNoted("one sample for each cell"));

    ImportOptions coarse; // 18 slices of 136 um
    coarse.gridSize = {20, 6, 18};
    const OpenedCase other = openCase("foam/thin_membrane/fc.foam", coarse);
    EXPECT_TRUE(other.isNoted("region electrolyte is sampled with") ||
                other.isNoted("region electrolyte has no sample"));
}

TEST_F(FoamCases, FormsOfCellsAreTheSame) {
    for (const char* name : {"cells_binary", "cells_decomposed", "cells_collated"}) {
        const OpenedCase opened = openCase("foam/" + std::string(name));
        const DatasetInfo& info = opened.info();
        EXPECT_THAT(info.times, ElementsAre(0, 1e-5, 0.5)) << name;
        EXPECT_EQ(info.lattice.size, glm::ivec3(4, 3, 2)) << name;
        EXPECT_EQ(info.lattice.origin, glm::dvec3(0.5)) << name;
        for (const int time : {2, 0, 1}) EXPECT_EQ(wrongCells(opened, time), 0u) << name << " at " << time;
        EXPECT_EQ(opened.about("R.xy").unit, "m2/s2");
        EXPECT_EQ(opened.about("source").unit, "kg/(m3 s)");
        EXPECT_EQ(opened.about("pointDisplacement").unit, "m");
        EXPECT_EQ(opened.isNoted("3 processors"), std::string(name) != "cells_binary");
    }
}

TEST_F(FoamCases, ProcessorsMayHaveMoreTimes) {
    const OpenedCase opened = openCase("foam/decomposed/c.foam");
    EXPECT_THAT(opened.info().times, ElementsAre(0, 1));
    EXPECT_EQ(opened.mean("T", 1), 310);
    EXPECT_EQ(opened.present("T", 1), 16u);
    EXPECT_EQ(opened.about("T").unit, "K");
}

TEST_F(FoamCases, PackedFilesStateTheirUnits) {
    const OpenedCase opened = openCase("foam/gz/c.foam");
    EXPECT_EQ(opened.about("T").unit, "K");
    EXPECT_EQ(opened.mean("T", 0), 300);
    EXPECT_EQ(opened.mean("T", 1), 310);
}

TEST_F(FoamCases, IncludedFilesDoNotDisturb) {
    for (const char* name : {"foam/include_etc/c.foam", "foam/include_file/c.foam"}) {
        const OpenedCase opened = openCase(name);
        EXPECT_THAT(opened.info().times, ElementsAre(0, 1)) << name;
        EXPECT_EQ(opened.mean("T", 0), 300) << name;
        EXPECT_EQ(opened.mean("T", 1), 310) << name;
    }
}

TEST_F(FoamCases, AreNamedByTheirControlDictToo) {
    EXPECT_EQ(openCase("foam/times/system/controlDict").mean("T", 2), 320);
    EXPECT_EQ(openCase("foam/times").mean("T", 1), 310);
}

/// Cases written here: two cubes side by side, [0, 2] x [0, 1] x [0, 1].
class FoamTexts : public ForeignFiles {
protected:
    static std::string head(const std::string& kind, const std::string& more = "format ascii;") {
        return "FoamFile\n{\n    version 2.0;\n    " + more + "\n    class " + kind + ";\n    object x;\n}\n";
    }
    static std::string points(double end) {
        std::string out = head("vectorField") + "12\n(\n";
        for (int k = 0; k < 2; ++k)
            for (int j = 0; j < 2; ++j)
                for (int i = 0; i < 3; ++i)
                    out += "(" + std::to_string(i == 2 ? end : i) + " " + std::to_string(j) + " " + std::to_string(k) +
                           ")\n";
        return out + ")\n";
    }
    static std::string list(const std::string& kind, const std::string& values) { return head(kind) + values + "\n"; }
    void writeMesh(const std::string& folder) const {
        write(folder + "/points", points(2));
        write(folder + "/faces", list("faceList", "11(4(1 4 10 7) 4(0 6 9 3) 4(2 5 11 8) 4(0 1 7 6) 4(1 2 8 7) "
                                                  "4(3 9 10 4) 4(4 10 11 5) 4(0 3 4 1) 4(1 4 5 2) 4(6 7 10 9) "
                                                  "4(7 8 11 10))"));
        write(folder + "/owner", list("labelList", "11(0 0 1 0 1 0 1 0 1 0 1)"));
        write(folder + "/neighbour", list("labelList", "1{1}"));
        write(folder + "/boundary", list("polyBoundaryMesh", "1(walls { type wall; nFaces 10; startFace 1; })"));
    }
    void SetUp() override {
        ForeignFiles::SetUp();
        if (!IsSkipped()) writeMesh("c/constant/polyMesh");
    }
    static std::string scalars(const std::string& values, const std::string& before = "",
                               const std::string& dimensions = "[0 0 0 1 0 0 0]") {
        return head("volScalarField") + before + "dimensions " + dimensions + ";\ninternalField " + values +
               ";\nboundaryField { walls { type zeroGradient; } }\n";
    }
    OpenedCase open() const { return openCases({(folder_ / "c").string()}); }
};

TEST_F(FoamTexts, ValuesMayBeNamed) {
    write("c/0/include/first", "Tin 350;\nflow (1 2 3);\nnested { Tin 1; }\n");
    write("c/0/T", scalars("uniform $Tin", "#include \"include/first\"\n"));
    write("c/0/p", scalars("uniform ${:half}", "half 0.5; other $half;\n", "[kg m^-1 s^-2]"));
    write("c/0/U", head("volVectorField") +
                       "#include \"include/first\"\ndimensions [0 1 -1 0 0];\ninternalField uniform "
                       "$flow;\nboundaryField { #includeEtc \"caseDicts/setConstraintTypes\" }\n");
    write("c/0/q", scalars("uniform 4") + "\n#remove \"inlet.*\"\n");
    const OpenedCase opened = open();
    EXPECT_EQ(opened.mean("q"), 4);
    EXPECT_EQ(opened.mean("T"), 350);
    EXPECT_EQ(opened.mean("p"), 0.5);
    EXPECT_EQ(opened.about("p").unit, "Pa");
    EXPECT_EQ(opened.mean("U", 0, 2), 3);
    EXPECT_EQ(opened.about("U").unit, "m/s");
}

TEST_F(FoamTexts, AFieldThatCannotBeReadSpoilsItselfAlone) {
    write("c/0/T", scalars("nonuniform #codeStream\n{\n    code\n    #{\n        os << 1; // }\n    #};\n}"));
    write("c/0/k", scalars("uniform #calc \"1 + 2\"", "", "[0 2 -2 0 0 0 0]"));
    write("c/0/p", scalars("uniform $unheard"));
    write("c/0/q", scalars("nonuniform List<scalar> 3(1 2 3)"));
    write("c/0/fine", scalars("nonuniform List<scalar> 2(7 9)"));
    write("c/0/phi", head("surfaceScalarField") + "dimensions [0 3 -1 0 0 0 0];\ninternalField uniform 0;\n");
    write("c/0/include/part", "no header");
    write("c/0/lagrangian/cloud/positions", "no header either");
    write("c/1/T", scalars("uniform 310"));
    write("c/1/fine", scalars("uniform 8"));
    const OpenedCase opened = open();
    EXPECT_THAT(opened.info().times, ElementsAre(0, 1));
    EXPECT_EQ(opened.info().parameters.size(), 2u);
    EXPECT_EQ(opened.present("T", 0), 0u);
    EXPECT_EQ(opened.mean("T", 1), 310);
    EXPECT_EQ(opened.at("fine", {0, 0, 0}), 7);
    EXPECT_EQ(opened.at("fine", {opened.info().lattice.size.x - 1, 0, 0}), 9);
    EXPECT_TRUE(opened.isNoted("at time 0 these are left out: T (its values are given by #codeStream), k (its values "
                               "are given by #calc), p ($unheard is not known), q (it has 3 values, not 2)"));
    EXPECT_TRUE(opened.isNoted("on faces: phi"));
    EXPECT_TRUE(opened.isNoted("lagrangian"));
}

TEST_F(FoamTexts, AMovingMeshIsSampledInTheBoxOfAllTimes) {
    for (const int time : {0, 1, 2})
        write("c/" + std::to_string(time) + "/T", scalars("nonuniform List<scalar> 2(1 2)"));
    write("c/1/polyMesh/points", points(4));
    write("c/2/polyMesh/points", points(3));
    const OpenedCase opened = open();
    const Box& box = opened.info().bounds;
    EXPECT_EQ(box.lo, glm::dvec3(0));
    EXPECT_EQ(box.hi, glm::dvec3(4, 1, 1));
    const double all = double(opened.info().lattice.count());
    EXPECT_EQ(double(opened.present("T", 0)), all / 2);
    EXPECT_EQ(double(opened.present("T", 1)), all);
    EXPECT_EQ(double(opened.present("T", 2)), all * 3 / 4);
}

TEST_F(FoamTexts, NumbersOfAnySizeAndOrder) {
    for (const bool big : {false, true})
        for (const bool wide : {false, true}) {
            const std::string form = std::string("format binary; arch \"") + (big ? "MSB" : "LSB") +
                                     (wide ? ";label=64" : ";label=32") + (wide ? ";scalar=32\";" : ";scalar=64\";");
            const auto labels = [&](const std::vector<std::int32_t>& values) {
                std::string out = std::to_string(values.size()) + "\n(";
                for (const std::int32_t value : values)
                    out += wide ? bytesOf(std::int64_t(value), big) : bytesOf(value, big);
                return out + ")";
            };
            const auto numbers = [&](const std::vector<double>& values, std::size_t each) {
                std::string out = std::to_string(values.size() / each) + "\n(";
                for (const double value : values) out += wide ? bytesOf(float(value), big) : bytesOf(value, big);
                return out + ")";
            };
            std::vector<double> places;
            for (int p = 0; p < 12; ++p) places.insert(places.end(), {double(p % 3), double(p / 3 % 2), double(p / 6)});
            const std::string mesh = "c/constant/polyMesh/";
            write(mesh + "points", head("vectorField", form) + numbers(places, 3));
            write(mesh + "owner", head("labelList", form) + labels({0, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1}));
            write("c/0/T", head("volScalarField", form) +
                               "dimensions [0 0 0 1 0 0 0];\ninternalField nonuniform "
                               "List<scalar> " +
                               numbers({300.5, 400.25}, 1) + ";\nboundaryField {}\n");
            const OpenedCase opened = open();
            EXPECT_EQ(opened.info().bounds.hi, glm::dvec3(2, 1, 1)) << form;
            EXPECT_EQ(opened.at("T", {0, 0, 0}), 300.5) << form;
        }
}

TEST_F(FoamTexts, PolyhedraAreDivided) {
    // The left cube's outer face is two: a cell of seven faces, whose four faces beside it have five points.
    const std::string mesh = "c/constant/polyMesh/";
    std::string more = points(2);
    more.replace(more.find("12\n("), 4, "14\n(");
    more.insert(more.rfind(')'), "(0 0.5 0)\n(0 0.5 1)\n");
    write(mesh + "points", more);
    write(mesh + "faces", list("faceList", "12(4(1 4 10 7) 4(0 6 13 12) 4(12 13 9 3) 4(2 5 11 8) 4(0 1 7 6) 4(1 2 8 7) "
                                           "4(3 9 10 4) 4(4 10 11 5) 5(0 12 3 4 1) 4(1 4 5 2) 5(6 7 10 9 13) "
                                           "4(7 8 11 10))"));
    write(mesh + "owner", list("labelList", "12(0 0 0 1 0 1 0 1 0 1 0 1)"));
    write("c/0/T", scalars("nonuniform List<scalar> 2(5 6)"));
    ImportOptions options;
    options.gridSize = {8, 8, 8};
    const OpenedCase opened = openCases({(folder_ / "c").string()}, options);
    EXPECT_EQ(opened.present("T"), 512u);
    EXPECT_TRUE(opened.isNoted("1 of 2 cells are other polyhedra"));
    // The slope from one cell to the other goes on to the walls.
    EXPECT_GE(opened.at("T", {0, 3, 3}), 4);
    EXPECT_LE(opened.at("T", {0, 3, 3}), 5);
    EXPECT_GT(opened.at("T", {7, 3, 3}), 6);
    EXPECT_LT(opened.at("T", {7, 3, 3}), 7);
}

TEST_F(FoamTexts, ZonesAreALabel) {
    write("c/constant/polyMesh/cellZones", list("regIOobject", "1\n(\nporous { type cellZone; cellLabels List<label> "
                                                               "1(1); }\n)"));
    write("c/0.orig/T", scalars("uniform 5"));
    const OpenedCase opened = open();
    EXPECT_EQ(opened.at("zone", {0, 0, 0}), 0);
    EXPECT_EQ(opened.at("zone", {opened.info().lattice.size.x - 1, 0, 0}), 1);
    EXPECT_EQ(opened.about("zone").labels.back().name, "porous");
    EXPECT_TRUE(opened.isNoted("0.orig is shown as time 0"));
}

TEST_F(FoamTexts, WhatTheTimesCount) {
    write("c/system/fvSchemes", head("dictionary") + "ddtSchemes { default steadyState; }\n");
    write("c/100/T", scalars("uniform 5"));
    write("c/99/T", scalars("uniform 4"));
    const OpenedCase opened = open();
    EXPECT_THAT(opened.info().times, ElementsAre(99, 100));
    EXPECT_EQ(opened.info().timeUnit, "");
    EXPECT_EQ(opened.info().timeName, "iteration");
}

TEST_F(FoamTexts, WhatIsMissingIsSaid) {
    const std::string path = (folder_ / "c").string();
    EXPECT_THAT(failure(path), HasSubstr("has a mesh and no values"));
    write("c/0/T", scalars("uniform #calc \"1\""));
    EXPECT_THAT(failure(path), HasSubstr("no field that can be read: T (its values are given by #calc)"));
    fs::remove_all(folder_ / "c/constant");
    write("c/system/controlDict", head("dictionary"));
    write("c/system/blockMeshDict", head("dictionary"));
    EXPECT_THAT(failure(path), HasSubstr("has no mesh: there is no constant/polyMesh/points (run blockMesh first)"));
}

} // namespace
} // namespace tessera::volume
