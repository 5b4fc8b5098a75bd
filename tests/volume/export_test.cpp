#include "volume/export/export.h"

#include "volume/base/error.h"
#include "volume/import/import.h"

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <iterator>
#include <random>
#include <unistd.h>

namespace tessera::volume {
namespace {

namespace fs = std::filesystem;

class Export : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("tessera_export_" + std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    fs::path folder_;
};

/// Two times of a float with absent samples, a vector, a u8 label with absent samples and an i16.
Dataset sample(glm::ivec3 size) {
    Dataset dataset;
    dataset.info.name = "sample";
    dataset.info.lattice.size = size;
    dataset.info.lattice.spacing = {0.1, 2e-5, 1};
    dataset.info.lattice.origin = {-1, 0.25, 3};
    dataset.info.bounds = {dataset.info.lattice.origin, dataset.info.lattice.position(size - 1)};
    dataset.info.times = {0.1, 0.3};
    dataset.info.parameters = {{"O2", "mol/m3", 1, ScalarType::F32, false, {}, {}},
                               {"U", "m/s", 3, ScalarType::F32, false, {}, {}},
                               {"region", "", 1, ScalarType::U8, true, {{0, "solid"}, {2, "air side"}}, {}},
                               {"counts", "", 1, ScalarType::I16, false, {}, {}}};
    dataset.read = [lattice = dataset.info.lattice, parameters = dataset.info.parameters](int p, int c, int t) {
        std::mt19937 random(unsigned(p * 100 + c * 10 + t));
        Field field = makeField(lattice, parameters[std::size_t(p)].type);
        Mask mask(field.count());
        std::mt19937 holes(99u);
        for (std::size_t i = 0; i < field.count(); ++i) {
            mask[i] = holes() % 4 != 0;
            dispatch(field.type, [&]<class T>(T) { field.as<T>()[i] = static_cast<T>(int(random() % 200) - 100); });
            if (field.type == ScalarType::F32) field.as<float>()[i] /= 3;
        }
        if (p == 0 || p == 2) field.mask = std::make_shared<const Mask>(mask);
        return field;
    };
    return dataset;
}

void expectEqual(const Dataset& a, const Dataset& b) {
    ASSERT_EQ(a.info.parameters.size(), b.info.parameters.size());
    for (std::size_t p = 0; p < a.info.parameters.size(); ++p) {
        const Parameter &x = a.info.parameters[p], &y = b.info.parameters[p];
        EXPECT_EQ(x.name, y.name);
        EXPECT_EQ(x.unit, y.unit);
        EXPECT_EQ(x.type, y.type) << x.name;
        EXPECT_EQ(x.categorical, y.categorical) << x.name;
        EXPECT_EQ(x.labels, y.labels);
        for (int c = 0; c < x.components; ++c)
            for (std::size_t t = 0; t < a.info.times.size(); ++t) {
                const Field f = a.read(int(p), c, int(t)), g = b.read(int(p), c, int(t));
                ASSERT_EQ(f.count(), g.count());
                for (std::size_t i = 0; i < f.count(); ++i) {
                    ASSERT_EQ(f.present(i), g.present(i)) << x.name << i;
                    if (f.present(i)) {
                        ASSERT_EQ(f.value(i), g.value(i)) << x.name << i;
                    }
                }
            }
    }
}

TEST_F(Export, RawComesBackBitForBit) {
    for (const glm::ivec3 size : {glm::ivec3(1, 1, 1), glm::ivec3(17, 3, 2), glm::ivec3(5, 4, 3)}) {
        const Dataset dataset = sample(size);
        const std::string path = (folder_ / "out.raw").string();
        EXPECT_EQ(exportDataset(dataset, {}, path).size(), 2u);
        ImportOptions asIs;
        asIs.autoAbsent = false;
        const Dataset back = openFiles({path}, asIs);
        EXPECT_EQ(back.info.times, dataset.info.times);
        EXPECT_EQ(back.info.lattice, dataset.info.lattice);
        expectEqual(dataset, back);
    }
}

TEST_F(Export, SelectionsAreKept) {
    const Dataset dataset = sample({3, 2, 2});
    const std::string path = (folder_ / "out.raw").string();
    ExportSelection selection;
    selection.parameters = {3, 1};
    selection.times = {1};
    exportDataset(dataset, selection, path);
    const Dataset back = openFiles({path}, {});
    ASSERT_EQ(back.info.parameters.size(), 2u);
    EXPECT_EQ(back.info.parameters[0].name, "counts");
    EXPECT_EQ(back.info.times, std::vector<double>{0.3});
    EXPECT_EQ(back.read(1, 2, 0).value(4), dataset.read(1, 2, 1).value(4));
}

TEST_F(Export, NrrdHoldsOneChannel) {
    const Dataset dataset = sample({3, 2, 2});
    const std::string path = (folder_ / "out.nrrd").string();
    EXPECT_THROW(exportDataset(dataset, {}, path), Error);
    ExportSelection selection;
    selection.parameters = {3};
    selection.times = {1};
    exportDataset(dataset, selection, path);
    std::ifstream in(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    EXPECT_THAT(bytes, testing::StartsWith("NRRD0004\n"));
    EXPECT_THAT(bytes, testing::HasSubstr("\ntype: int16\n"));
    const Field field = dataset.read(3, 0, 1);
    EXPECT_EQ(bytes.substr(bytes.find("\n\n") + 2),
              std::string(reinterpret_cast<const char*>(field.samples.data()), field.samples.size()));
}

// A vector is written whole; its length only where that is asked for. Every reader that we know of has it back.
TEST_F(Export, NrrdHoldsVectors) {
    const Dataset dataset = sample({3, 4, 2});
    const std::string path = (folder_ / "out.nrrd").string();
    ExportSelection selection;
    selection.parameters = {1};
    selection.times = {1};
    exportDataset(dataset, selection, path);
    std::ifstream in(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    EXPECT_THAT(bytes, testing::HasSubstr("\ndimension: 4\nsizes: 3 3 4 2\n"));
    EXPECT_THAT(bytes, testing::HasSubstr("\nspace directions: none (0.1,0,0) "));
    EXPECT_THAT(bytes, testing::HasSubstr("\nkinds: vector domain domain domain\n"));
    const std::string samples = bytes.substr(bytes.find("\n\n") + 2);
    std::vector<float> values(3 * 24);
    ASSERT_EQ(samples.size(), values.size() * sizeof(float));
    std::memcpy(values.data(), samples.data(), samples.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_EQ(double(values[i]), dataset.read(1, int(i % 3), 1).value(i / 3));
    const Dataset back = openFiles({path}, {});
    ASSERT_EQ(back.info.parameters.size(), 1u);
    EXPECT_EQ(back.info.lattice, dataset.info.lattice);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(back.read(0, c, 0).value(17), dataset.read(1, c, 1).value(17));
    selection.channel = dataset.info.findChannel("|U|");
    exportDataset(dataset, selection, path);
    const Dataset length = openFiles({path}, {});
    ASSERT_EQ(length.info.parameters[0].components, 1);
    const auto u = [&](int c) { return dataset.read(1, c, 1).value(5); };
    EXPECT_NEAR(length.read(0, 0, 0).value(5), std::hypot(u(0), u(1), u(2)), 1e-4);
}

/// An int16 vector at two times; `change` makes a frame of it special.
Dataset integerVector(std::function<void(Field& field, int component, int time)> change) {
    Dataset dataset;
    dataset.info.name = "vector";
    dataset.info.lattice.size = {5, 4, 3};
    dataset.info.times = {0, 1};
    dataset.info.parameters = {{"U", "m/s", 3, ScalarType::I16, false, {}, {}}};
    dataset.read = [lattice = dataset.info.lattice, change = std::move(change)](int, int c, int t) {
        Field field = makeField(lattice, ScalarType::I16);
        for (std::size_t i = 0; i < field.count(); ++i)
            field.as<std::int16_t>()[i] = std::int16_t((int(i) - 30) * (c + 1) + t);
        change(field, c, t);
        return field;
    };
    return dataset;
}

void withHole(Field& field, std::size_t at) {
    Mask mask(field.count(), 1);
    mask[at] = 0;
    field.mask = std::make_shared<const Mask>(std::move(mask));
}

/// The samples of the only array of a .vti that holds floats.
std::vector<float> floatsOfVti(const std::string& path, std::size_t count) {
    std::ifstream in(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    EXPECT_THAT(bytes, testing::HasSubstr("<DataArray type=\"Float32\" Name=\"U\""));
    EXPECT_THAT(bytes, testing::Not(testing::HasSubstr(".present")));
    std::vector<float> values(count);
    std::memcpy(values.data(), bytes.data() + bytes.find("\n_") + 2 + sizeof(std::uint64_t), count * sizeof(float));
    return values;
}

TEST_F(Export, RawKeepsTheScalingOfEachComponent) {
    const Dataset dataset = integerVector([](Field& field, int c, int) {
        field.scale = std::array{0.1, 0.2, 0.5}[std::size_t(c)];
        field.offset = std::array{0.0, -2.0, 7.0}[std::size_t(c)];
    });
    const std::string path = (folder_ / "out.raw").string();
    exportDataset(dataset, {}, path);
    expectEqual(dataset, openFiles({path}, {}));
}

TEST_F(Export, IntegersWhoseScalingChangesInTimeBecomeFloats) {
    const Dataset dataset = integerVector([](Field& field, int c, int t) { field.scale = c == 2 && t == 1 ? 0.5 : 1; });
    const std::string path = (folder_ / "out.raw").string();
    exportDataset(dataset, {}, path);
    const Dataset back = openFiles({path}, {});
    ASSERT_EQ(back.info.parameters.size(), 1u);
    EXPECT_EQ(back.info.parameters[0].type, ScalarType::F32);
    for (int c = 0; c < 3; ++c)
        for (int t = 0; t < 2; ++t)
            EXPECT_EQ(physicalValues(back.read(0, c, t)), physicalValues(dataset.read(0, c, t)));
}

/// One parameter of one component: stored numbers, their type and scaling; the last sample is absent if `hole`.
Dataset codes(ScalarType type, const std::vector<int>& numbers, double scale, double offset, bool hole) {
    Dataset dataset;
    dataset.info.name = "codes";
    dataset.info.lattice.size = {int(numbers.size()), 1, 1};
    dataset.info.parameters = {{"n", "", 1, type, false, {}, {}}};
    dataset.read = [=, lattice = dataset.info.lattice](int, int, int) {
        Field field = makeField(lattice, type);
        dispatch(type, [&]<class T>(T) {
            for (std::size_t i = 0; i < numbers.size(); ++i) field.as<T>()[i] = static_cast<T>(numbers[i]);
        });
        field.scale = scale, field.offset = offset;
        if (hole) withHole(field, numbers.size() - 1);
        return field;
    };
    return dataset;
}

/// As many numbers as there are bytes for.
template <class T> std::vector<T> numbersOf(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    std::vector<T> numbers(bytes.size() / sizeof(T));
    std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(T));
    return numbers;
}

TEST_F(Export, ValuesInPlaceOfCodes) {
    using testing::ElementsAre;
    const std::string path = (folder_ / "out.raw").string();
    ExportSelection values;
    values.values = true;
    exportDataset(codes(ScalarType::U8, {0, 25, 51}, 5, 0, false), values, path);
    EXPECT_THAT(numbersOf<std::uint8_t>(path), ElementsAre(0, 125, 255));
    exportDataset(codes(ScalarType::U8, {0, 25, 51}, 6, 0, false), values, path); // 306 takes 16 bits
    EXPECT_THAT(numbersOf<std::int16_t>(path), ElementsAre(0, 150, 306));
    exportDataset(codes(ScalarType::U16, {0, 25, 60000}, 100, -7, false), values, path);
    EXPECT_THAT(numbersOf<std::int32_t>(path), ElementsAre(-7, 2493, 5999993));
    exportDataset(codes(ScalarType::I16, {-4, 25, 51}, 0.5, 1, false), values, path);
    EXPECT_THAT(numbersOf<float>(path), ElementsAre(-1.f, 13.5f, 26.5f));
    exportDataset(codes(ScalarType::U8, {1, 25, 51}, 5, 0, true), values, path);
    EXPECT_THAT(numbersOf<std::uint8_t>(path), ElementsAre(5, 125, 0));
    const Dataset back = openFiles({path}, {});
    EXPECT_EQ(back.read(0, 0, 0).value(1), 125);
    EXPECT_FALSE(back.read(0, 0, 0).present(2));
    // Not asked for, they are written as they are stored.
    exportDataset(codes(ScalarType::U8, {0, 25, 51}, 5, 0, false), {}, path);
    EXPECT_THAT(numbersOf<std::uint8_t>(path), ElementsAre(0, 25, 51));
    const std::string nrrd = (folder_ / "out.nrrd").string();
    exportDataset(codes(ScalarType::U8, {0, 25, 51}, 5, 0, false), values, nrrd);
    std::ifstream in(nrrd, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    EXPECT_THAT(bytes, testing::HasSubstr("type: uint8\n"));
    EXPECT_EQ(bytes.substr(bytes.find("\n\n") + 2), std::string("\0\x7d\xff", 3));
}

TEST_F(Export, NrrdNeverChangesIntegersThatFloatsCannotHold) {
    const std::string path = (folder_ / "out.nrrd").string();
    constexpr int kExact = 1 << 24;
    exportDataset(codes(ScalarType::I32, {kExact + 1, 1, 2}, 1, 0, false), {}, path); // without gaps they stay integers
    std::filesystem::remove(path);
    exportDataset(codes(ScalarType::I32, {kExact, 1, 2}, 1, 0, true), {}, path);
    std::filesystem::remove(path);
    EXPECT_THROW(exportDataset(codes(ScalarType::I32, {kExact + 1, 1, 2}, 1, 0, true), {}, path), Error);
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(Export, ComponentsThatLackOtherSamplesBecomeFloats) {
    // No number tells the absent sample from the present ones, and one array of flags cannot speak for three.
    const Dataset dataset = integerVector([](Field& field, int c, int) {
        field.as<std::int16_t>()[0] = field.as<std::int16_t>()[std::size_t(c) + 1];
        withHole(field, std::size_t(c) + 1);
    });
    const std::string raw = (folder_ / "out.raw").string(), vti = (folder_ / "out.vti").string();
    exportDataset(dataset, {}, raw);
    const Dataset back = openFiles({raw}, {});
    ExportSelection first;
    first.times = {0};
    exportDataset(dataset, first, vti);
    const std::size_t count = dataset.info.lattice.count();
    const std::vector<float> tuples = floatsOfVti(vti, 3 * count);
    for (int c = 0; c < 3; ++c) {
        const Field field = dataset.read(0, c, 0), again = back.read(0, c, 0);
        for (std::size_t i = 0; i < count; ++i)
            for (const double value : {again.value(i), double(tuples[3 * i + std::size_t(c)])}) {
                EXPECT_EQ(std::isnan(value), !field.present(i)) << c << " " << i;
                if (field.present(i)) {
                    EXPECT_EQ(value, field.value(i)) << c << " " << i;
                }
            }
    }
}

TEST_F(Export, VtiHoldsIntegersAsTheyAre) {
    const Dataset dataset = sample({3, 2, 2});
    const std::string path = (folder_ / "out.vti").string();
    ExportSelection counts;
    counts.parameters = {3};
    counts.times = {1};
    exportDataset(dataset, counts, path);
    std::ifstream in(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    EXPECT_THAT(bytes, testing::HasSubstr("<DataArray type=\"Int16\" Name=\"counts\""));
    const Field field = dataset.read(3, 0, 1);
    const std::size_t begin = bytes.find("\n_") + 2 + sizeof(std::uint64_t);
    EXPECT_EQ(bytes.substr(begin, bytes.find("\n</AppendedData>") - begin),
              std::string(reinterpret_cast<const char*>(field.samples.data()), field.samples.size()));
}

TEST_F(Export, LabelsWithoutNamesStayLabels) {
    Dataset dataset = integerVector([](Field&, int, int) {});
    dataset.info.parameters = {{"grains", "", 1, ScalarType::I16, true, {}, {}}};
    const std::string path = (folder_ / "out.raw").string();
    exportDataset(dataset, {}, path);
    EXPECT_TRUE(openFiles({path}, {}).info.parameters[0].categorical);
    dataset.info.parameters[0].categorical = false;
    exportDataset(dataset, {}, path);
    EXPECT_FALSE(openFiles({path}, {}).info.parameters[0].categorical);
}

TEST_F(Export, VtiHoldsPhysicalValuesWhereAnyComponentIsScaled) {
    const Dataset dataset = integerVector([](Field& field, int c, int) { field.scale = c == 1 ? 0.25 : 1; });
    const std::string path = (folder_ / "out.vti").string();
    ExportSelection first;
    first.times = {0};
    exportDataset(dataset, first, path);
    const std::size_t count = dataset.info.lattice.count();
    const std::vector<float> tuples = floatsOfVti(path, 3 * count);
    for (int c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < count; ++i)
            EXPECT_EQ(tuples[3 * i + std::size_t(c)], dataset.read(0, c, 0).value(i)) << c << " " << i;
}

/// Floats may be scaled too, by a sidecar.
TEST_F(Export, AbsentNumbersOfScaledFloatsAreNotTakenForPhysicalOnes) {
    Dataset dataset = integerVector([](Field&, int, int) {});
    dataset.info.parameters[0].type = ScalarType::F32;
    dataset.read = [inner = std::move(dataset.read)](int p, int c, int t) {
        const Field integers = inner(p, c, t);
        Field field = makeField(integers.lattice, ScalarType::F32);
        for (std::size_t i = 0; i < field.count(); ++i) field.as<float>()[i] = float(integers.value(i));
        if (c == 1) { // 250 is stored 500 as a physical value
            field.scale = 2;
            field.as<float>()[3] = 500;
            field.as<float>()[4] = 250;
            withHole(field, 3);
        }
        return field;
    };
    const std::string path = (folder_ / "out.raw").string();
    exportDataset(dataset, {}, path);
    const Dataset back = openFiles({path}, {});
    for (int c = 0; c < 3; ++c) {
        const Field field = dataset.read(0, c, 0), again = back.read(0, c, 0);
        for (std::size_t i = 0; i < field.count(); ++i) {
            EXPECT_EQ(again.present(i) && !std::isnan(again.value(i)), field.present(i)) << c << " " << i;
            if (field.present(i)) {
                EXPECT_EQ(again.value(i), field.value(i)) << c << " " << i;
            }
        }
    }
}

TEST_F(Export, LeavesNothingHalfWritten) {
    Dataset dataset = sample({3, 2, 2});
    dataset.read = [inner = dataset.read](int p, int c, int t) {
        if (p == 1 && t == 1) throw Error("damaged");
        return inner(p, c, t);
    };
    for (const char* name : {"a.raw", "b.pvd"})
        EXPECT_THROW(exportDataset(dataset, {}, (folder_ / name).string()), Error);
    for (const auto& entry : fs::directory_iterator(folder_))
        EXPECT_EQ(entry.path().filename(), "b_0000.vti"); // the one frame that was complete
    EXPECT_THROW(exportDataset(sample({2, 2, 2}), {}, (folder_ / "a.xyz").string()), Error);
    EXPECT_THROW(exportDataset(sample({2, 2, 2}), {}, (folder_ / "no/such/a.raw").string()), MachineError);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(exportDataset(sample({2, 2, 2}), {}, (folder_ / "c.raw").string(), Progress{{}, stop.get_token()}),
                 Cancelled);
    EXPECT_FALSE(fs::exists(folder_ / "c.raw"));
}

} // namespace
} // namespace tessera::volume
