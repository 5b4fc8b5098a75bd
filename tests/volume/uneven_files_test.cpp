// Files of grids with uneven axes: sidecars, rectilinear grids, headers of streams.
#include "tests/volume/uneven.h"
#include "volume/base/error.h"
#include "volume/export/export.h"
#include "volume/field/axes_json.h"
#include "volume/field/own_axes.h"
#include "volume/field/slices.h"
#include "volume/import/files/raw.h"
#include "volume/import/files/stream.h"
#include "volume/import/import.h"

#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <iterator>
#include <nlohmann/json.hpp>
#include <random>
#include <unistd.h>

namespace tessera::volume {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;
using Of = AxisMap::Of;

class UnevenFiles : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("tessera_uneven_" + std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    std::string in(const std::string& name) const { return (folder_ / name).string(); }
    fs::path folder_;
};

std::string bytesOfFile(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// A float with absent samples, a vector and a label.
Dataset layeredDataset(const Lattice& lattice, std::size_t times = 1) {
    Dataset made;
    made.info.name = "layers";
    made.info.lattice = lattice;
    made.info.bounds = gridBounds(lattice);
    made.info.times.clear();
    for (std::size_t t = 0; t < times; ++t) made.info.times.push_back(double(t));
    made.info.parameters = {{"T", "K", 1, ScalarType::F32, false, {}, {}},
                            {"U", "m/s", 3, ScalarType::F32, false, {}, {}},
                            {"region", "", 1, ScalarType::U8, true, {{0, "solid"}, {1, "air"}}, {}}};
    made.read = [lattice](int p, int c, int t) {
        std::mt19937 random(unsigned(p * 100 + c * 10 + t));
        Field field = makeField(lattice, p == 2 ? ScalarType::U8 : ScalarType::F32);
        Mask mask(field.count(), 1);
        for (std::size_t i = 0; i < field.count(); ++i) {
            const auto number = unsigned(random());
            if (p == 2) field.as<std::uint8_t>()[i] = std::uint8_t(number % 2);
            if (p != 2) field.as<float>()[i] = float(number % 1000) / 3;
            if (p == 0) mask[i] = number % 5 == 0 ? 0 : 1;
        }
        if (p == 0) field.mask = std::make_shared<const Mask>(std::move(mask));
        return field;
    };
    return made;
}

/// Axes of all kinds at once: cells, even, points.
Lattice mixedLattice() {
    Lattice lattice = test::layeredLattice(Of::Cells);
    AxisMaps axes = lattice.axes;
    axes.of[0] = std::make_shared<const AxisMap>(Of::Points, std::vector<double>{-1e-3, 1e-4, 5e-4, 3e-3});
    return withAxes(lattice, axes);
}

TEST_F(UnevenFiles, RawComesBackBitForBit) {
    for (const Lattice& lattice : {test::layeredLattice(Of::Cells), test::layeredLattice(Of::Points), mixedLattice()}) {
        const Dataset made = layeredDataset(lattice, 2);
        exportDataset(made, {}, in("a.raw"));
        ImportOptions asIs;
        asIs.autoAbsent = false;
        const Dataset back = openFiles({in("a.raw")}, asIs);
        EXPECT_EQ(back.info.lattice, lattice);
        EXPECT_EQ(back.info.bounds.lo, made.info.bounds.lo);
        EXPECT_EQ(back.info.bounds.hi, made.info.bounds.hi);
        const Field was = made.read(1, 2, 1), is = back.read(1, 2, 1);
        EXPECT_TRUE(std::ranges::equal(was.as<float>(), is.as<float>()));
        EXPECT_EQ(is.lattice, lattice);
    }
}

TEST_F(UnevenFiles, FilesOfOneDataSetLieAtTheSamePlanes) {
    const Lattice lattice = test::layeredLattice(Of::Cells);
    AxisMaps axes = lattice.axes;
    std::vector<double> planes = axes.of[2]->planes();
    planes[3] += 1e-6; // the sheet stays
    axes.of[2] = std::make_shared<const AxisMap>(Of::Cells, planes);
    exportDataset(layeredDataset(lattice), {}, in("a_0.raw"));
    exportDataset(layeredDataset(lattice), {}, in("a_1.raw"));
    exportDataset(layeredDataset(withAxes(lattice, axes)), {}, in("b_1.raw"));
    EXPECT_EQ(openFiles({in("a_0.raw"), in("a_1.raw")}, {}).info.lattice, lattice);
    try {
        openFiles({in("a_0.raw"), in("b_1.raw")}, {});
        ADD_FAILURE() << "other planes were taken";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("does not lie on the grid of"));
    }
}

json layeredSidecar() {
    const Lattice lattice = test::layeredLattice(Of::Cells);
    return {{"dims", {lattice.size.x, lattice.size.y, lattice.size.z}},
            {"dtype", "u8"},
            {"spacing", {lattice.spacing.x, lattice.spacing.y, lattice.spacing.z}},
            {"origin", {lattice.origin.x, lattice.origin.y, lattice.origin.z}},
            {"axes", json::parse(axesJson(lattice.axes))}};
}

std::string refusedSidecar(const json& sidecar) {
    try {
        parseSidecar(sidecar.dump(), "a.json");
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return error.what();
    }
    return "taken";
}

TEST_F(UnevenFiles, SidecarsMayLeaveOutTheSheet) {
    json sidecar = layeredSidecar();
    EXPECT_EQ(parseSidecar(sidecar.dump(), "a.json").lattice, test::layeredLattice(Of::Cells));
    sidecar.erase("origin");
    sidecar.erase("spacing");
    sidecar["axes"][1] = json::parse(
        axesJson({{std::make_shared<const AxisMap>(Of::Points, std::vector<double>{0, 1, 2, 3, 4, 5, 6, 7, 9})}}))[0];
    const Lattice read = parseSidecar(sidecar.dump(), "a.json").lattice;
    EXPECT_EQ(read.axes[2]->planes(), test::layeredLattice(Of::Cells).axes[2]->planes());
    EXPECT_EQ(read.spacing.z, read.axes[2]->spacing());
    EXPECT_EQ(read.origin.y, 0);
    EXPECT_EQ(read.spacing.y, 9.0 / 8);
}

TEST_F(UnevenFiles, DamagedSidecarsAreRefusedInOneLine) {
    const json good = layeredSidecar();
    EXPECT_EQ(refusedSidecar(good), "taken");
    const auto changed = [&](auto&& change) {
        json bad = good;
        change(bad);
        return refusedSidecar(bad);
    };
    EXPECT_THAT(changed([](json& all) { all["axes"] = "z"; }), HasSubstr("a.json: axes: must be a list of three"));
    EXPECT_THAT(changed([](json& all) { all["axes"][2]["of"] = 3; }), HasSubstr("axes[2].of"));
    EXPECT_THAT(changed([](json& all) { all["axes"][2]["planes"].push_back(9); }),
                HasSubstr("axes[2].planes: holds 22"));
    EXPECT_THAT(changed([](json& all) { all["axes"][2]["planes"][3] = "nan"; }),
                HasSubstr("planes[3]: must be a number"));
    EXPECT_THAT(changed([](json& all) { all["axes"][2]["planes"][3] = 7; }), HasSubstr("do not rise from 3 to 4"));
    EXPECT_THAT(changed([](json& all) { all["spacing"][2] = 1e-3; }), HasSubstr("axes: spacing and origin are not"));
    EXPECT_THAT(changed([](json& all) { all["origin"][0] = 0; }), HasSubstr("axes: spacing and origin are not"));
    EXPECT_THAT(changed([](json& all) { all["dims"][2] = 1000000000; }), HasSubstr("dims[2]"));
    std::string text = good.dump();
    text.replace(text.find("0.001"), 5, "1e999"); // a number that no double holds
    EXPECT_THROW(parseSidecar(text, "a.json"), Error);
}

TEST_F(UnevenFiles, HeadersOfStreamsStateAxes) {
    json sidecar = layeredSidecar();
    json block = {{"name", ""},
                  {"mesh", false},
                  {"dims", sidecar["dims"]},
                  {"spacing", sidecar["spacing"]},
                  {"origin", sidecar["origin"]},
                  {"axes", sidecar["axes"]},
                  {"times", json::array()},
                  {"arrays", json::array()}};
    const auto parse = [&] {
        return parseStreamHeader(json{{"format", "vtr"}, {"blocks", {block}}}.dump(), "a.vtr").at(0);
    };
    const FileBlock read = parse();
    EXPECT_EQ(read.lattice, test::layeredLattice(Of::Cells));
    EXPECT_TRUE(read.cellData);
    EXPECT_EQ(read.box.hi.z, read.lattice.axes[2]->hi());
    block["axes"] = json::parse(axesJson({{nullptr, nullptr, test::layeredLattice(Of::Points).axes.of[2]}}));
    EXPECT_THROW(parse(), Error); // 21 points are not 20 samples
    block["axes"] = json::array();
    EXPECT_THROW(parse(), Error);
}

/// A rectilinear grid as it stands in the file.
struct Rectilinear {
    std::string head;
    std::array<std::vector<double>, 3> places;
    std::string samples; ///< of all arrays, with their lengths
};

Rectilinear readVtr(const std::string& path) {
    const std::string text = bytesOfFile(path);
    Rectilinear out;
    std::size_t at = text.find("encoding=\"raw\">\n_");
    if (at == std::string::npos) return out;
    at += 17;
    out.head = text.substr(0, at);
    for (std::vector<double>& places : out.places) {
        std::uint64_t bytes = 0;
        std::memcpy(&bytes, text.data() + at, sizeof bytes);
        places.resize(bytes / sizeof(double));
        std::memcpy(places.data(), text.data() + at + sizeof bytes, bytes);
        at += sizeof bytes + bytes;
    }
    out.samples = text.substr(at);
    return out;
}

TEST_F(UnevenFiles, RectilinearGridsStatePlanesBitForBit) {
    const Lattice cells = test::layeredLattice(Of::Cells), points = test::layeredLattice(Of::Points);
    exportDataset(layeredDataset(cells), {}, in("cells.vtr"));
    exportDataset(layeredDataset(points), {}, in("points.vtr"));
    const Rectilinear ofCells = readVtr(in("cells.vtr")), ofPoints = readVtr(in("points.vtr"));
    EXPECT_THAT(ofCells.head, HasSubstr("WholeExtent=\"0 12 0 9 0 20\""));
    EXPECT_THAT(ofCells.head, HasSubstr("<CellData>"));
    EXPECT_THAT(ofCells.head, Not(HasSubstr("<PointData>")));
    EXPECT_THAT(ofPoints.head, HasSubstr("WholeExtent=\"0 12 0 8 0 20\""));
    EXPECT_THAT(ofPoints.head, HasSubstr("<PointData>"));
    for (const int axis : {0, 2}) {
        EXPECT_EQ(ofCells.places[std::size_t(axis)], cells.axes[axis]->planes());
        EXPECT_EQ(ofPoints.places[std::size_t(axis)], points.axes[axis]->planes());
    }
    ASSERT_EQ(ofCells.places[1].size(), 10u); // half a cell around the samples
    for (int j = 0; j < 9; ++j) {
        const auto at = std::size_t(j);
        EXPECT_NEAR((ofCells.places[1][at] + ofCells.places[1][at + 1]) / 2, cells.position({0, j, 0}).y, 1e-18);
        EXPECT_EQ(ofPoints.places[1][at], points.position({0, j, 0}).y);
    }
    // The first array is T, absent samples NaN.
    const Field T = layeredDataset(cells).read(0, 0, 0);
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, ofCells.samples.data(), sizeof bytes);
    ASSERT_EQ(bytes, T.count() * sizeof(float));
    for (std::size_t i = 0; i < T.count(); ++i) {
        float value = 0;
        std::memcpy(&value, ofCells.samples.data() + 8 + i * sizeof value, sizeof value);
        EXPECT_TRUE(T.present(i) ? double(value) == T.value(i) : std::isnan(value)) << i;
    }
}

TEST_F(UnevenFiles, AxesOfPointsAmongCellsKeepTheirPlaces) {
    const Lattice lattice = mixedLattice();
    exportDataset(layeredDataset(lattice), {}, in("a.vtr"));
    const Rectilinear file = readVtr(in("a.vtr"));
    EXPECT_THAT(file.head, HasSubstr("<CellData>"));
    EXPECT_THAT(file.head,
                HasSubstr("Name=\"points_x\" NumberOfTuples=\"4\" format=\"ascii\">-0.001 1e-04 5e-04 0.003"));
    EXPECT_EQ(file.places[0],
              (std::vector<double>{-1e-3, (-1e-3 + 1e-4) / 2, (1e-4 + 5e-4) / 2, (5e-4 + 3e-3) / 2, 3e-3}));
    EXPECT_EQ(file.places[2], lattice.axes[2]->planes());
}

TEST_F(UnevenFiles, EvenGridsAreRectilinearToo) {
    const Lattice lattice = test::ccLattice({3, 4, 2}, {0.1, 2e-5, 1}, {-1, 0.25, 3});
    exportDataset(layeredDataset(lattice), {}, in("a.vtr"));
    const Rectilinear file = readVtr(in("a.vtr"));
    EXPECT_THAT(file.head, HasSubstr("WholeExtent=\"0 2 0 3 0 1\""));
    EXPECT_THAT(file.head, HasSubstr("<PointData>"));
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < lattice.size[axis]; ++i)
            EXPECT_EQ(file.places[std::size_t(axis)][std::size_t(i)], lattice.origin[axis] + i * lattice.spacing[axis]);
}

TEST_F(UnevenFiles, SeriesOfUnevenGridsAreRectilinear) {
    const Dataset made = layeredDataset(test::layeredLattice(Of::Cells), 2);
    EXPECT_EQ(exportDataset(made, {}, in("a.pvd")),
              (std::vector<std::string>{in("a_0000.vtr"), in("a_0001.vtr"), in("a.pvd")}));
    EXPECT_THAT(bytesOfFile(in("a.pvd")), HasSubstr("a_0001.vtr"));
    EXPECT_EQ(exportDataset(made, {}, in("b.vtr")).size(), 3u);
    EXPECT_EQ(exportDataset(layeredDataset(test::ccLattice({2, 2, 2}), 2), {}, in("c.vtr")).at(0), in("c_0000.vtr"));
    EXPECT_EQ(exportDataset(layeredDataset(test::ccLattice({2, 2, 2}), 2), {}, in("c.pvd")).at(0), in("c_0000.vti"));
}

TEST_F(UnevenFiles, FormatsOfOneSpacingSaySo) {
    const Dataset made = layeredDataset(test::layeredLattice(Of::Cells));
    for (const char* name : {"a.vti", "a.nrrd"}) try {
            exportDataset(made, {.parameters = {0}, .times = {}, .channel = {}, .values = false}, in(name));
            ADD_FAILURE() << name << " was written";
        } catch (const Error& error) {
            EXPECT_THAT(error.what(), HasSubstr("along x, z is uneven: write .vtr"));
        }
    EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(UnevenFiles, SlicesAndBoxesStateTheirOwnPlanes) {
    const Lattice cells = test::layeredLattice(Of::Cells);
    const Lattice own = withOwnAxes(slicesOf(cells, 3, 5));
    EXPECT_EQ(own.size, glm::ivec3(12, 9, 5));
    const auto& planes = cells.axes[2]->planes();
    EXPECT_EQ(own.axes[2]->planes(), std::vector(planes.begin() + 3, planes.begin() + 9));
    EXPECT_EQ(own.axes[0]->planes(), cells.axes[0]->planes());
    for (int k = 0; k < 5; ++k) EXPECT_NEAR(own.position({0, 0, k}).z, cells.position({0, 0, k + 3}).z, 1e-15);
    EXPECT_EQ(withOwnAxes(cells), cells);
    Lattice second = cells; // every second sample
    second.size.z = 10;
    second.spacing.z *= 2;
    const Lattice of = withOwnAxes(second);
    EXPECT_EQ(of.axes[2]->of(), Of::Points);
    for (int k = 0; k < 10; ++k) EXPECT_NEAR(of.position({0, 0, k}).z, cells.position({0, 0, 2 * k}).z, 1e-15);
}

TEST_F(UnevenFiles, LengthsOfCellsAreFromPlaneToPlane) {
    const Lattice cells = test::layeredLattice(Of::Cells);
    const CellLengths along = cellLengthsAlong(cells, 2);
    EXPECT_NEAR(along.least, 5e-6, 1e-15);
    double greatest = 0;
    for (int k = 0; k < cells.size.z; ++k) greatest = std::max(greatest, cells.axes[2]->length(k));
    EXPECT_EQ(along.greatest, greatest);
    EXPECT_EQ(cellLengthsAlong(cells, 1).least, cells.spacing.y);
}

} // namespace
} // namespace tessera::volume
