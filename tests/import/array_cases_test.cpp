// NetCDF, HDF5 and NumPy files of other writers (netCDF4, xarray, h5py, NumPy) in tests/import/cases/arrays.
#include "tests/import/foreign_files.h"

namespace tessera::volume {
namespace {

/// A file, its grid, and how samples follow from their place: value = first + x + row * y + layer * z + step * time,
/// times `scale`, and `offset`.
struct ArrayCase {
    std::string file, parameter;
    glm::ivec3 size;
    glm::dvec3 spacing, origin;
    std::string lengthUnit, unit;
    std::vector<double> times;
    std::string timeUnit;
    std::array<double, 3> along; ///< x, y, z
    double first = 0, step = 0;
    int absent = 0; ///< at the first time
    std::string note = "";
};

const glm::ivec3 kCaseSize(10, 11, 12), kSmall(5, 4, 6);
constexpr std::array<double, 3> kRule{1, 10, 110};

const std::vector<ArrayCase>& arrayCases() {
    const glm::dvec3 steps(0.25, 0.5, 2), ones(1), none(0), begin(0, 1, 0);
    static const std::vector<ArrayCase> cases = {
        {"nc_missing.nc", "T", kCaseSize, steps, none, "m", "K", {0}, "", kRule, 0, 0, 5},
        {"nc_group.nc", "fields/T", kCaseSize, steps, none, "m", "K", {0}, "", kRule},
        {"nc_mix_i8.nc", "T", kCaseSize, steps, none, "m", "K", {0}, "", kRule},
        {"nc_packed.nc", "T", kCaseSize, steps, none, "m", "K", {0}, "", {0.01, 0.1, 1.1}, 280, 0, 5},
        {"nc_desc_fill.nc",
         "T",
         kCaseSize,
         {0.75, 0.75, 2},
         {0, 82.5, 0},
         "",
         "K",
         {0},
         "",
         {1, -10, 110},
         100,
         0,
         108},
        {"nc_xrtf.nc", "T", kCaseSize, ones, none, "", "", {0, 1, 2, 3, 4}, "", kRule, 0, 1320},
        {"nc_xrxyz.nc", "T", kCaseSize, {0.25, 0.5, 1}, none, "", "", {0}, "", kRule},
        {"h5_scales_xyz.h5", "T", kCaseSize, steps, none, "", "", {0}, "", kRule},
        {"h5_il4c.h5", "exported_data.0", kCaseSize, ones, none, "", "", {0}, "", kRule, 0, 0, 0, "holds channels"},
        {"h5_il4c.h5", "exported_data.1", kCaseSize, ones, none, "", "", {0}, "", kRule, 1, 0, 0, "order of the axes"},
        {"h5_tomo.h5", "exchange/data", kCaseSize, ones, none, "", "", {0}, "", kRule, 0, 0, 0, "exchange/data_white"},
        {"npz_with_string.npz", "T", kCaseSize, ones, none, "", "", {0}, "", kRule, 0, 0, 0, "\"name\" (<U5)"},
        {"unsigned.nc", "T", kSmall, steps, begin, "m", "", {0}, "", {2, 20, 50}, 180, 0, 1},
        {"ocean.nc",
         "thetao",
         kSmall,
         {0.5, 0.5, 2},
         {359, 1, -10},
         "",
         "degrees_C",
         {10, 11, 12},
         "d",
         {0.01, 0.1, -1.1},
         5.5,
         1,
         6,
         "z = -depth"},
        {"wrf.nc", "T", kSmall, ones, none, "", "K", {0, 3600, 7200}, "s", kRule, 0, 1, 0, "\"U\" (Time"},
        {"ilastik.h5", "exported_data.1", kSmall, ones, none, "", "", {0, 1, 2}, "", kRule, 100, 1},
        {"nexus.nxs", "entry/data/data", kSmall, steps, begin, "mm", "", {0}, "", kRule, 0, 0, 0, "\"entry/other\""},
        {"virtual.h5", "T", kSmall, ones, none, "", "", {0, 1}, "", kRule},
        {"external.h5", "T", kSmall, ones, none, "", "", {0}, "", kRule},
        {"extlink.h5", "T2", kSmall, ones, none, "", "", {0}, "", kRule},
        {"virtual_gone.h5", "S", kSmall, ones, none, "", "", {0}, "", kRule, 0, 0, 0, "its file gone.h5 is missing"}};
    return cases;
}

using ArrayCases = ForeignFiles;

std::string arrayCasePath(const std::string& file) {
    return std::string(TESSERA_SOURCE_DIR) + "/tests/import/cases/arrays/" + file;
}

int parameterNamed(const Dataset& dataset, const std::string& name) {
    for (std::size_t p = 0; p < dataset.info.parameters.size(); ++p)
        if (dataset.info.parameters[p].name == name) return int(p);
    return -1;
}

TEST_F(ArrayCases, AreReadAsTheyWereWritten) {
    for (const ArrayCase& wanted : arrayCases()) {
        SCOPED_TRACE(wanted.file);
        const Dataset dataset = openFiles({arrayCasePath(wanted.file)}, {});
        const DatasetInfo& info = dataset.info;
        ASSERT_EQ(info.lattice.size, wanted.size);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(info.lattice.spacing[axis], wanted.spacing[axis], 1e-6);
            EXPECT_NEAR(info.lattice.origin[axis], wanted.origin[axis], 1e-6);
        }
        EXPECT_EQ(info.lengthUnit, wanted.lengthUnit);
        EXPECT_EQ(info.times, wanted.times);
        EXPECT_EQ(info.timeUnit, wanted.timeUnit);
        const int parameter = parameterNamed(dataset, wanted.parameter);
        ASSERT_GE(parameter, 0);
        const Parameter& about = info.parameters[std::size_t(parameter)];
        EXPECT_EQ(about.unitGuessed ? "" : about.unit, wanted.unit);
        for (std::size_t n = 0; n < 2 * wanted.times.size(); ++n) { // in a mixed order, each time twice
            const std::size_t t = (n * 2 + n / wanted.times.size()) % wanted.times.size();
            const Field field = dataset.read(parameter, 0, int(t));
            int absent = 0;
            for (std::size_t i = 0; i < field.count(); ++i) {
                const auto at = int(i);
                const glm::ivec3 place(at % wanted.size.x, at / wanted.size.x % wanted.size.y,
                                       at / wanted.size.x / wanted.size.y);
                double value = wanted.first + wanted.step * double(t);
                for (int axis = 0; axis < 3; ++axis) value += wanted.along[std::size_t(axis)] * place[axis];
                if (field.present(i)) {
                    ASSERT_NEAR(field.value(i), value, 1e-3) << "time " << t << ", sample " << i;
                } else {
                    ++absent;
                }
            }
            EXPECT_EQ(absent, wanted.absent);
        }
        if (!wanted.note.empty()) {
            EXPECT_THAT(previewFiles({arrayCasePath(wanted.file)}, {}).notes,
                        testing::Contains(testing::HasSubstr(wanted.note)));
        }
    }
}

TEST_F(ArrayCases, TwoAxesOfTimeBecomeTheirUnion) {
    const Dataset dataset = openFiles({arrayCasePath("twotimes.nc")}, {});
    EXPECT_EQ(dataset.info.times, (std::vector<double>{0, 6, 12, 24}));
    EXPECT_EQ(dataset.info.timeUnit, "h");
    const int often = parameterNamed(dataset, "A"), daily = parameterNamed(dataset, "B");
    ASSERT_GE(std::min(often, daily), 0);
    const double absent = -1;
    const auto first = [&](int parameter, int time) {
        const Field field = dataset.read(parameter, 0, time);
        return field.present(7) ? field.value(7) : absent;
    };
    for (const int time : {3, 0, 2, 1}) {
        EXPECT_EQ(first(often, time), time == 3 ? absent : 12 + time);
        EXPECT_EQ(first(daily, time), time == 0 ? 12 : time == 3 ? 11 : absent);
    }
}

TEST_F(ArrayCases, IterationsOfOpenPmdAreTimes) {
    const Dataset dataset = openFiles({arrayCasePath("pmd.h5")}, {});
    EXPECT_EQ(dataset.info.times, (std::vector<double>{0.5, 2}));
    EXPECT_EQ(dataset.info.timeUnit, "s");
    EXPECT_EQ(dataset.info.lengthUnit, "m");
    EXPECT_NEAR(dataset.info.lattice.spacing.z, 2e-3, 1e-12);
    EXPECT_NEAR(dataset.info.lattice.origin.y, 1e-3, 1e-12);
    const int vector = parameterNamed(dataset, "E"), constant = parameterNamed(dataset, "c");
    ASSERT_GE(std::min(vector, constant), 0);
    EXPECT_EQ(dataset.info.parameters[std::size_t(vector)].components, 3);
    EXPECT_EQ(dataset.info.parameters[std::size_t(vector)].unit, "kg m/(s3 A)");
    for (const int time : {1, 0, 1})
        for (int c = 0; c < 3; ++c) // stored in units of 10, in iterations 20 and 100
            EXPECT_EQ(dataset.read(vector, c, time).value(26), 10 * (121 + c + 20 + 80 * time));
    EXPECT_FALSE(dataset.read(constant, 0, 0).present(0)); // of the later iteration alone
    EXPECT_EQ(dataset.read(constant, 0, 1).value(0), 5);
}

TEST_F(ArrayCases, CutsAreTold) {
    for (const char* name : {"nc_packed.nc", "unsigned.nc", "h5_scales_xyz.h5", "ilastik.h5"}) {
        const std::string path = write(name, read(arrayCasePath(name)));
        expectCutsAreTold(path, path);
    }
}

} // namespace
} // namespace tessera::volume
