// Units that files state, and those that only a name tells.
#include "tests/import/foreign_files.h"
#include "volume/export/export.h"

namespace tessera::volume {
namespace {

using Units = ForeignFiles;

struct Column {
    const char* name;
    double first, step;
};
/// A table of 2 x 2 x 2 points.
std::string table(const std::vector<Column>& columns) {
    std::string out = "x,y,z";
    for (const Column& column : columns) out += "," + std::string(column.name);
    out += "\n";
    for (int n = 0; n < 8; ++n) {
        out += std::to_string(n & 1) + "," + std::to_string(n >> 1 & 1) + "," + std::to_string(n >> 2);
        for (const Column& column : columns) out += "," + std::to_string(column.first + column.step * n);
        out += "\n";
    }
    return out;
}
std::string unitsOf(const Dataset& dataset) {
    std::string out;
    for (const Parameter& parameter : dataset.info.parameters)
        out += parameter.name + ":" + parameter.unit + (parameter.unitGuessed ? "?" : "") + " ";
    return out;
}

TEST_F(Units, OfUsualNamesAreGuessedAndSaySo) {
    const std::string path =
        write("a.csv", table({{"T", 350, 1}, {"p", 1e5, 10}, {"rho", 1, 0.1}, {"Velocity", -1, 1}, {"O2", 5, 1}}));
    EXPECT_EQ(unitsOf(openFiles({path}, {})), "T:K? p:Pa? rho:kg/m3? Velocity:m/s? O2: ");
    ImportOptions options;
    options.units["T"] = "degC";
    EXPECT_EQ(unitsOf(openFiles({path}, options)), "T:degC p:Pa? rho:kg/m3? Velocity:m/s? O2: ");
}

TEST_F(Units, AreNotGuessedAgainstTheValuesOrTheFile) {
    EXPECT_EQ(unitsOf(openFiles({write("a.csv", table({{"T", 60, 1}, {"p", 1, 0.1}, {"rho", -1, 1}}))}, {})),
              "T: p: rho: "); // degrees, bar, something else
    EXPECT_EQ(unitsOf(openFiles({write("b.csv", table({{"T [degC]", 350, 1}, {"p", 1e5, 10}}))}, {})), "T:degC p: ");
    EXPECT_EQ(unitsOf(openFiles({write("c.csv", table({{"Tair", 350, 1}, {"u'", 1, 1}}))}, {})), "Tair: u': ");
}

TEST_F(Units, GuessedOnesAreNotWrittenAsStated) {
    const Dataset dataset = openFiles({write("a.csv", table({{"T", 350, 1}}))}, {});
    const std::string path = (folder_ / "b.vti").string();
    exportDataset(dataset, {}, path);
    EXPECT_EQ(unitsOf(openFiles({path}, {})), "T:K? ");
}

std::string lengthUnitOf(const std::string& path) {
    return openFiles({path}, {}).info.lengthUnit;
}

TEST_F(Units, OfLengthsAreNotMadeUp) {
    EXPECT_EQ(lengthUnitOf(write("a.csv", table({{"T", 350, 1}}))), "");
    EXPECT_EQ(lengthUnitOf(write("a.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\n"
                                          "DIMENSIONS 2 2 1\nORIGIN 0 0 0\nSPACING 1 2 3\nPOINT_DATA 4\n"
                                          "SCALARS T double 1\nLOOKUP_TABLE default\n1 2 3 4\n")),
              "");
    Dataset dataset = openFiles({write("b.csv", table({{"T", 350, 1}}))}, {});
    for (const char* unit : {"", "mm"}) // the unit of this file is stated there
        for (const char* name : {"b.vti", "b.nrrd", "b.raw"}) {
            dataset.info.lengthUnit = unit;
            const std::string path = (folder_ / name).string();
            exportDataset(dataset, {}, path);
            EXPECT_EQ(lengthUnitOf(path), unit) << name;
        }
    ImportOptions options;
    options.lengthUnit = "km";
    EXPECT_EQ(openFiles({(folder_ / "a.csv").string()}, options).info.lengthUnit, "km");
}

TEST_F(Units, OfLengthsInHeadersOfImages) {
    const auto nrrd = [&](const std::string& fields, const std::string& samples) {
        return lengthUnitOf(write("a.nrrd", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\n" + fields + samples));
    };
    const std::string raw = "encoding: raw\n\n12345678", text = "encoding: text\n\n1 2 3 4 5 6 7 8\n";
    for (const std::string& samples : {raw, text}) {
        EXPECT_EQ(nrrd("", samples), "");
        EXPECT_EQ(nrrd("space dimension: 3\nspace units: \"mm\" \"mm\" \"mm\"\n", samples), "mm");
        EXPECT_EQ(nrrd("units: \"micron\" \"micron\" \"micron\"\n", samples), "um");
        EXPECT_EQ(nrrd("units: \"mm\" \"mm\" \"s\"\n", samples), "") << "of another kind";
    }
    const auto meta = [&](const std::string& fields) {
        return lengthUnitOf(write("a.mha", "ObjectType = Image\nNDims = 3\nBinaryData = True\n"
                                           "BinaryDataByteOrderMSB = False\n" +
                                               fields +
                                               "ElementSpacing = 1 2 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n"
                                               "ElementDataFile = LOCAL\n12345678"));
    };
    EXPECT_EQ(meta(""), "");
    EXPECT_EQ(meta("DistanceUnits = mm\n"), "mm");
    for (const auto& [code, unit] : {std::pair{0, ""}, {1, "m"}, {2, "mm"}, {3, "um"}, {10, "mm"}}) {
        std::string head(352, '\0');
        const auto put = [&](std::size_t at, const std::string& bytes) { head.replace(at, bytes.size(), bytes); };
        put(0, bytesOf(std::int32_t(348)));
        put(40, bytesOf(std::vector<std::int16_t>{3, 2, 2, 2, 1, 1, 1, 1}));
        put(70, bytesOf(std::vector<std::int16_t>{2, 8}));
        put(76, bytesOf(std::vector<float>{1, 1, 2, 3}));
        put(108, bytesOf(352.0f));
        head[123] = char(code); // 10: with seconds
        put(344, std::string("n+1\0", 4));
        EXPECT_EQ(lengthUnitOf(write("a.nii", head + "12345678")), unit) << code;
    }
}

/// A classic NetCDF file of T on 2 x 2 x 2 samples at places with these units.
std::string netCdfIn(const std::array<std::string, 3>& units) {
    const auto number = [](std::int32_t value) { return bytesOf(value, true); };
    const auto words = [&](const std::string& text) {
        return number(std::int32_t(text.size())) + inBytes(text, (text.size() + 3) / 4 * 4);
    };
    std::string out = "CDF\x01" + number(0) + number(10) + number(3);
    for (const char* axis : {"z", "y", "x"}) out += words(axis) + number(2);
    out += number(0) + number(0) + number(11) + number(4);
    const auto list = [&](int begin) {
        std::string all;
        for (int axis = 0; axis < 3; ++axis) { // of doubles
            const std::string& unit = units[std::size_t(axis)];
            const std::string stated = number(12) + number(1) + words("units") + number(2) + words(unit);
            all += words(std::string(1, "zyx"[axis])) + number(1) + number(axis) +
                   (unit.empty() ? number(0) + number(0) : stated) + number(6) + number(16) + number(begin + 16 * axis);
        }
        return all + words("T") + number(3) + number(0) + number(1) + number(2) + number(0) + number(0) + number(5) +
               number(32) + number(begin + 48);
    };
    const int begin = int((out + list(0)).size());
    out += list(begin);
    for (int axis = 0; axis < 3; ++axis) out += bytesOf(std::vector<double>{0, 0.5}, true);
    return out + bytesOf(std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8}, true);
}

TEST_F(Units, OfLengthsInNetCdfAreThoseOfItsAxes) {
    const auto in = [&](const std::array<std::string, 3>& units) {
        return lengthUnitOf(write("a.nc", netCdfIn(units)));
    };
    EXPECT_EQ(in({"", "", ""}), "");
    EXPECT_EQ(in({"m", "m", "m"}), "m");
    EXPECT_EQ(in({"millimeters", "millimeters", "mm"}), "mm");
    EXPECT_EQ(in({"m", "degrees_north", "degrees_east"}), "");
}

TEST_F(Units, OfOpenFoamComeFromItsDimensions) {
    const std::string archive = testData("fuel-cell/openfoam-case.tar.xz");
    if (archive.empty()) GTEST_SKIP() << "no test data";
    ASSERT_EQ(std::system(("tar xJf '" + archive + "' -C '" + folder_.string() + "'").c_str()), 0);
    const DatasetInfo info = previewFiles({(folder_ / "cell").string()}, {}).info;
    const auto unit = [&](const char* name) {
        for (const Parameter& parameter : info.parameters)
            if (parameter.name == name) return parameter.unit + (parameter.unitGuessed ? "?" : "");
        return std::string("missing");
    };
    EXPECT_EQ(unit("T"), "K");
    EXPECT_EQ(unit("U.air"), "m/s");
    EXPECT_EQ(unit("O2.air"), ""); // a mass fraction
    EXPECT_EQ(unit("p_rgh"), "Pa");
    EXPECT_EQ(unit("diffSp.O2"), "m2/s");
}

} // namespace
} // namespace tessera::volume
