// Binary Tecplot that is cut, damaged or of a kind that is not read: one line that names the place.
#include "tests/import/tecplot_file.h"

#include <cmath>

namespace tessera::volume {
namespace {

using namespace tecplot;
using TecplotDamage = ForeignFiles;

TEST_F(TecplotDamage, CutsNameTheirPlace) {
    File file{112, false, {"X", "Y", "Z", "T"}, {}};
    file.zones = {ordered("air", with(places(), {over(linear)})),
                  ordered("fuel", with(places(1, 0.75), {over(linear)}))};
    const std::string all = file.bytes(), header = file.header();
    const auto of = [&](const std::string& bytes) { return failure(write("cut.plt", bytes)); };
    EXPECT_THAT(of(all.substr(0, 30)), testing::HasSubstr("cut.plt"));
    EXPECT_THAT(of(all.substr(0, 30)), testing::HasSubstr("ends within its header: truncated at byte 30"));
    EXPECT_THAT(of(header.substr(0, header.size() - 30)), testing::HasSubstr("the header of zone 2 \"fuel\""));
    EXPECT_THAT(of(header), testing::HasSubstr("ends within zone 1 \"air\""));
    EXPECT_THAT(of(all.substr(0, all.size() - 1)),
                testing::HasSubstr("ends within the values of T of zone 2 \"fuel\""));
    EXPECT_THAT(of(all + "x"), testing::HasSubstr("1 bytes more"));
    std::string other = all;
    other.replace(header.size(), 4, file.single(42));
    EXPECT_THAT(of(other),
                testing::HasSubstr("where zone 1 \"air\" belongs, at byte " + std::to_string(header.size())));
    ImportOptions options;
    options.gridSize = {7, 3, 5};
    const std::string path = write("cut.plt", all);
    expectCutsAreTold(path, path, options, 100);
}

/// Counts beyond what the file can hold are told before anything is allocated for them.
TEST_F(TecplotDamage, HostileCounts) {
    constexpr int kMost = 2147483647;
    const auto of = [&](const File& file) { return failure(write("bad.plt", file.bytes())); };
    File file{112, false, {"X", "Y", "Z", "T"}, {ordered("", with(places(), {over(linear)}))}};
    const File good = file;
    file.zones[0].size = {kMost, 1, 1};
    EXPECT_THAT(of(file), testing::HasSubstr("ends within the values of X"));
    file.zones[0].size = {kMost, kMost, kMost};
    EXPECT_THAT(of(file), testing::HasSubstr("too many points"));
    file.zones[0].size = {4, -3, 5};
    EXPECT_THAT(of(file), testing::HasSubstr("bad number of points"));
    Zone mesh = elements("", with(places(), {over(linear)}), false);
    file.zones = {mesh};
    file.zones[0].cells = kMost;
    EXPECT_THAT(of(file), testing::HasSubstr("ends within the cells"));
    file.zones[0] = mesh;
    file.zones[0].corners[5] = 60;
    EXPECT_THAT(of(file), testing::HasSubstr("bad corner"));
    file.zones[0].corners[5] = -1;
    EXPECT_THAT(of(file), testing::HasSubstr("bad corner"));
    file.zones[0] = mesh; // nothing is stored that would tell the number of points
    for (Variable& variable : file.zones[0].variables) variable = passive();
    file.zones[0].points = kMost;
    EXPECT_THAT(of(file), testing::HasSubstr("no variables X and Y"));
    file.zones = {mesh, mesh};
    file.zones[0].strand = file.zones[1].strand = 0;
    file.zones[1].time = 1; // at one time it is, at the other not
    file.zones[0].points = kMost;
    for (Variable& variable : file.zones[0].variables) variable = passive();
    EXPECT_THAT(of(file), testing::HasSubstr("no variables X and Y"));
    file = good;
    file.zones.push_back(file.zones[0]);
    file.zones[1].variables[3] = sharedWith(2);
    EXPECT_THAT(of(file), testing::HasSubstr("does not exist"));
    file.zones[1].variables[3] = sharedWith(1); // with itself
    EXPECT_THAT(of(file), testing::HasSubstr("does not exist"));
    file.zones[1].variables[3] = sharedWith(0);
    file.zones[1].size = {5, 3, 4};
    EXPECT_THAT(of(file), testing::HasSubstr("another size"));
    file.zones = {mesh, elements("", with(places(), {over(linear)}), true)};
    file.zones[1].cornersFrom = 0;
    EXPECT_THAT(of(file), testing::HasSubstr("cells of another kind"));
    file = good;
    file.zones[0].variables[0].values[3] = std::nan("");
    EXPECT_THAT(of(file), testing::HasSubstr("not a number"));
    file = good;
    file.zones[0].strand = 0;
    file.zones[0].time = std::nan("");
    EXPECT_THAT(of(file), testing::HasSubstr("bad time"));
}

TEST_F(TecplotDamage, WhatIsNotReadSaysSo) {
    const auto of = [&](const File& file) { return failure(write("a.plt", file.bytes())); };
    File file{107, false, {"X", "Y", "Z", "T"}, {ordered("", with(places(), {over(linear)}))}};
    EXPECT_THAT(of(file), testing::HasSubstr("version 107, which is not read"));
    EXPECT_THAT(failure(write("a.plt", "#!TDV75 " + bytesOf(1))), testing::HasSubstr("version 75"));
    EXPECT_THAT(failure(write("a.plt", "#!TDV112" + bytesOf(7))), testing::HasSubstr("damaged"));
    file.version = 112;
    file.type = 2;
    EXPECT_THAT(of(file), testing::HasSubstr("without its grid"));
    file.type = 1;
    for (const char* kind : {"FELINESEG", "FEPOLYGON", "FEPOLYHEDRON"}) {
        file.zones[0].type = kind == std::string("FELINESEG") ? 1 : kind == std::string("FEPOLYGON") ? 6 : 7;
        EXPECT_THAT(of(file), testing::HasSubstr(std::string(kind) + ", which is not read: write it as FEBRICK"));
    }
    file.zones[0] = elements("", with(places(), {over(linear)}), false);
    file.zones[0].type = 3; // its quadrilaterals are surfaces
    file.zones[0].cells *= 2;
    EXPECT_THAT(of(file), testing::HasSubstr("surfaces"));
    file.zones[0] = ordered("", with(places(), {over(linear, 6)}));
    EXPECT_THAT(of(file), testing::HasSubstr("one bit"));
    file.version = 102;
    file.zones[0] = elements("", with(places(), {over(linear)}), false);
    EXPECT_THAT(of(file), testing::HasSubstr("version 102 with cells"));
    file = {112, false, {"X", "Y", "Z", "T"}, {}};
    EXPECT_THAT(of(file), testing::HasSubstr("no zone"));
    EXPECT_THAT(failure(write("a.szplt", "#!SZPLT")), testing::HasSubstr("write it as binary Tecplot (.plt)"));
    EXPECT_THAT(failure(write("a.plt", "#!SZPLT")), testing::HasSubstr("write it as binary Tecplot (.plt)"));
}

} // namespace
} // namespace tessera::volume
