// Pictures to scale of samples with uneven axes: what is drawn, exported and read out names the same places.
#include "app/data/open.h"
#include "app/data/picture_lattice.h"
#include "app/data/sources.h"
#include "app/planes/plane_export.h"
#include "app/queries/visibility_query.h"
#include "app/user_files/import_memory.h"
#include "app/views/compare/compare_offers.h"
#include "app/views/shadow_cube/wall_projection.h"
#include "app/views/slices/slice_layout.h"
#include "codec/pack/pack.h"
#include "tests/app/drawn_text.h"
#include "tests/app/uneven_layers.h"
#include "tests/app/views_fixture.h"
#include "tests/app/workbench_fixture.h"
#include "tests/codec/make_dataset.h"
#include "volume/sources/memory_source.h"
#include "volume/synthetic/models.h"

#include <filesystem>
#include <glm/geometric.hpp>
#include <set>
#include <unistd.h>

namespace tessera::app {
namespace {

using volume::AxisMap;

/// Numbers on uneven axes, and pictures of them to scale.
class ToScale : public ViewsTest {
protected:
    void SetUp() override {
        ViewsTest::SetUp();
        numbers = unevenLayers(AxisMap::Of::Points);
        show(app::drawnOn(numbers, PictureLattice::Even));
        session.data.lattice = PictureLattice::Even;
        ASSERT_TRUE(source->info().lattice.isEven());
        ASSERT_FALSE(numbers->info().lattice.isEven());
    }
    ViewContext context() {
        ViewContext made{session, source, renderer, jobs, caches};
        made.numbers = numbers;
        made.headless = true;
        made.offerExport = [&](ViewExport one) { offered = std::move(one); };
        return made;
    }
    template <class View> Table tableOf(View view, void (*function)(ViewContext&, const std::string&, View&)) {
        offered = {};
        frame([&] {
            ViewContext own = context();
            ImGui::SetNextWindowSize({900, 700});
            ImGui::Begin("view", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
            function(own, "view", view);
            ImGui::End();
        });
        return offered.table ? offered.table({}) : Table{};
    }
    /// The positions of a table, in metres, and its values.
    std::vector<std::pair<glm::dvec3, double>> rowsOf(const Table& table) const {
        std::vector<std::pair<glm::dvec3, double>> rows;
        const AxisLabels labels = axisLabels(session, numbers->info());
        for (std::size_t c = 0; c < table.columns.size(); ++c)
            for (std::size_t i = 0; i < table.columns[c].numbers.size(); ++i) {
                rows.resize(std::max(rows.size(), i + 1));
                for (std::size_t axis = 0; axis < 3; ++axis)
                    if (table.columns[c].name == labels[axis].name)
                        rows[i].first[int(axis)] = table.columns[c].numbers[i] / labels[axis].unit.perUnit;
                if (table.columns[c].name == "T") rows[i].second = table.columns[c].numbers[i];
            }
        return rows;
    }

    std::shared_ptr<const volume::BrickSource> numbers;
    ViewExport offered;
};

TEST_F(ToScale, ContourLinesLieWhereTheirValueIs) {
    const volume::DatasetInfo& info = source->info();
    const PlanePicture picture = axisPlane(session, info, {0, 2, 1}, session.cursor.y,
                                           {.channel = 0, .lines = {.count = 12, .channel = "", .values = true}});
    const ContourQuery query = contourQuery(picture);
    EXPECT_TRUE(query.maps == info.lattice.axes);
    ContourQuery byCells = query;
    byCells.maps = numbers->info().lattice.axes;
    EXPECT_FALSE(query == byCells) << "other axes, other lines";
    const Contours contours = readContours(*numbers, query);
    ASSERT_FALSE(contours.lines.empty());
    for (const volume::ContourLine& line : contours.lines)
        for (const glm::dvec2& point : line.points) {
            const glm::dvec3 place = picture.placeAt(point);
            const glm::dvec3 node = info.bounds.size() / 40.0; // lines are straight from node to node
            EXPECT_NEAR(unevenLinear(place), line.level, 1e3 * node.x + 2e4 * node.z);
        }
}

TEST_F(ToScale, ExportsAreOfThePlanesThatAreDrawn) {
    session.cursor = numbers->info().lattice.position({5, 4, 3});
    ObliqueView tilted;
    tilted.normal = {1, 0, 1};
    const auto rows = rowsOf(tableOf(tilted, drawObliqueView));
    ASSERT_GT(rows.size(), 100u);
    const glm::dvec3 normal = glm::normalize(glm::dvec3(1, 0, 1));
    const glm::dvec3 spacing = glm::abs(source->info().lattice.spacing);
    for (const auto& [place, value] : rows) {
        // To a step of the cursor across the plane.
        EXPECT_LT(std::abs(glm::dot(normal, place - session.cursor)), spacing.x + spacing.z) << "a plane in space";
        EXPECT_NEAR(value, unevenLinear(place), 0.02);
    }
    const auto equallyFar = [&](const Table& table) {
        std::set<double> heights;
        for (const auto& [place, value] : rowsOf(table)) heights.insert(std::round(place.z * 1e9) * 1e-9);
        ASSERT_GT(heights.size(), 2u);
        const double step = (*heights.rbegin() - *heights.begin()) / double(heights.size() - 1);
        double at = *heights.begin();
        for (const double height : heights) {
            EXPECT_NEAR(height, at, 0.05 * step + 2e-9);
            at += step;
        }
    };
    SliceMatrixView matrix;
    matrix.planes = 7;
    equallyFar(tableOf(matrix, drawSliceMatrixView));
    matrix = {};
    matrix.axis = volume::SpaceAxis::Y;
    matrix.planes = 1;
    equallyFar(tableOf(matrix, drawSliceMatrixView));
}

TEST_F(ToScale, TablesOfSlicesHaveTheRowsThatAreDrawn) {
    const auto own = rowsOf(tableOf(SlicesView{}, drawSlicesView));
    std::vector<PlanePicture> drawn;
    for (const SliceAxes& axes : kSlicePlanes)
        drawn.push_back(axisPlane(session, source->info(), axes, session.cursor[axes.normal], {.channel = 0}));
    const auto wanted = rowsOf(planesTable(*numbers, drawn, {0}));
    ASSERT_GT(own.size(), 100u);
    EXPECT_EQ(own, wanted);
}

TEST_F(ToScale, WallsReadTheirLineThroughSpace) {
    const volume::DatasetInfo& info = numbers->info();
    const CubeFace face = kCubeFaces[5];
    const glm::dvec3 at = info.lattice.position({5, 4, 0});
    const auto drawn = readWall(*numbers, session, 0, {.kind = WallKind::Mean}, face, at, 0, &source->info().lattice);
    const auto byCells = readWall(*numbers, session, 0, {.kind = WallKind::Mean}, face, at, 0);
    ASSERT_TRUE(drawn && byCells);
    const glm::dvec3 middle(at.x, at.y, (info.bounds.lo.z + info.bounds.hi.z) / 2);
    const double whole = 2e4 * info.bounds.size().z;
    EXPECT_NEAR(*drawn, unevenLinear(middle), 1e-3 * whole);
    EXPECT_GT(std::abs(*byCells - *drawn), 0.1 * whole);
}

TEST_F(ToScale, VisibilityIsThatOfThePictures) {
    session.layers = {{"t", true, vis::VolumeLayer{.channel = "T"}}};
    const Range range = numbers->info().channelRange(numbers->info().channel(0));
    AsyncVisibility own, wanted;
    ViewContext here = context();
    const auto shown = own.get(here, "own", 0, range, 16);
    ViewContext even = context();
    even.numbers = source;
    const auto expected = wanted.get(even, "even", 0, range, 16);
    ASSERT_TRUE(shown && expected);
    EXPECT_EQ(*shown, *expected);
}

TEST_F(ToScale, VariantsSayHowEachIsDrawn) {
    DataRef data;
    data.model = "membrane";
    data.settings = {{"nx", 12}, {"ny", 4}, {"nz", 40}};
    std::vector<std::string> said;
    for (const auto lattice : {PictureLattice::Even, PictureLattice::Grid}) {
        data.lattice = lattice;
        const Sources opened = openSources(data, said);
        show(opened.pictures);
        numbers = opened.numbers;
        session.data = data;
        CompareView compare;
        compare.showTable = false;
        compare.variants = {{"scaled", {{"/data/lattice", "\"even\""}}}, {"layered", {{"/data/lattice", "\"grid\""}}}};
        const auto body = [&] {
            ViewContext own = context();
            ImGui::SetNextWindowPos({0, 0});
            ImGui::SetNextWindowSize({480, 240});
            ImGui::Begin("compare", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
            drawCompareView(own, "compare", compare);
            ImGui::End();
            busy = own.answers.unfinished();
        };
        for (int i = 0; i < 3 || (busy && i < 200); ++i) {
            jobs.wait();
            frame(body);
        }
        std::vector<DrawnText> badges;
        for (const DrawnText& text : drawnTexts())
            if (text.text.find("by cells") != std::string::npos) badges.push_back(text);
        ASSERT_EQ(badges.size(), 1u);
        EXPECT_GT(badges[0].min.x, 240) << "the second one alone is drawn by cells";
    }
}

TEST(ToScaleRule, HoldsForWhatCanBeResampled) {
    volume::DatasetInfo info = unevenLayers(AxisMap::Of::Cells)->info();
    EXPECT_TRUE(drawsToScale(PictureLattice::Even, info));
    EXPECT_EQ(latticeFor(PictureLattice::Even, info), PictureLattice::Even);
    Session session = defaultSession(info, {});
    session.data.lattice = PictureLattice::Even;
    EXPECT_TRUE(brushSpace(session, info).frame.axes.isEven());
    EXPECT_TRUE(lensSpace(session, info).frame.axes.isEven());
    session.data.packed = codec::PackOptions{};
    EXPECT_TRUE(brushSpace(session, info).frame.axes.isEven());
    session.data.originals = true; // both are drawn as stored
    EXPECT_TRUE(brushSpace(session, info).frame.axes == info.lattice.axes);
    EXPECT_TRUE(lensSpace(session, info).frame.axes == info.lattice.axes);
    session.data = {};
    session.data.lattice = PictureLattice::Even;
    info.lattice.size.y = 1 << 20; // more than have room
    EXPECT_FALSE(drawsToScale(PictureLattice::Even, info));
    EXPECT_EQ(latticeFor(PictureLattice::Even, info), PictureLattice::Grid);
    EXPECT_EQ(firstLattice(PictureLattice::BodyCentred, info), PictureLattice::Grid);
    EXPECT_TRUE(brushSpace(session, info).frame.axes == info.lattice.axes);
    volume::DatasetInfo even = info;
    even.lattice.axes = {};
    EXPECT_EQ(latticeFor(PictureLattice::Even, even), DataRef{}.lattice) << "as usual";
    EXPECT_EQ(firstLattice(PictureLattice::Even, even), DataRef{}.lattice);
    const auto cell = volume::makeMemorySource(
        volume::makeModel("fuel-cell", {{"nx", 7}, {"ny", 9}, {"nz", 21}, {"times", 1}, {"even", 1}}), {});
    EXPECT_EQ(drawnOn(cell, PictureLattice::Even)->info().lattice.kind, volume::LatticeKind::BCC);
}

DataRef membrane() {
    DataRef data;
    data.model = "membrane";
    data.settings = {{"nx", 8}, {"ny", 4}, {"nz", 24}};
    return data;
}

Opened openedFirst(const DataRef& data, std::optional<PictureLattice> uneven,
                   std::optional<PictureLattice> usual = {}) {
    OpenRequest request;
    request.data = data;
    request.uneven = uneven;
    request.lattice = usual;
    return open(request);
}

TEST(ToScaleRule, ChoicesForEvenAndUnevenAxesAreApart) {
    const Opened scaled = openedFirst(membrane(), PictureLattice::Even, PictureLattice::BodyCentred);
    EXPECT_EQ(scaled.document.session.data.lattice, PictureLattice::Even);
    EXPECT_TRUE(scaled.source->info().lattice.isEven());
    const Opened byCells = openedFirst(membrane(), {}, PictureLattice::BodyCentred);
    EXPECT_EQ(byCells.document.session.data.lattice, PictureLattice::Grid) << "nothing was chosen for such data";
    EXPECT_EQ(byCells.source, byCells.numbers);
    DataRef cell = membrane();
    cell.model = "marschner-lobb";
    cell.settings = {{"nx", 8}, {"ny", 8}, {"nz", 8}};
    cell.lattice = PictureLattice::Even;
    const Opened even = openedFirst(cell, PictureLattice::Grid);
    EXPECT_EQ(even.document.session.data.lattice, DataRef{}.lattice);
    EXPECT_EQ(even.source->info().lattice.kind, volume::LatticeKind::BCC);
}

TEST(ToScaleRule, OriginalsAreDrawnAsStored) {
    DataRef data = membrane();
    data.packed = codec::PackOptions{};
    data.originals = true;
    const Opened first = openedFirst(data, PictureLattice::Even);
    EXPECT_EQ(first.document.session.data.lattice, PictureLattice::Grid);
    EXPECT_EQ(first.source, first.numbers);
    Opened scaled = openedFirst(membrane(), PictureLattice::Even);
    data.lattice = PictureLattice::Even;
    const Opened moved = openWith(std::move(scaled), data);
    EXPECT_FALSE(moved.source->info().lattice.isEven());
    EXPECT_EQ(moved.document.session.data.lattice, PictureLattice::Grid);
}

DataRef archived(const std::string& path) {
    DataRef data;
    data.files.emplace_back();
    data.files[0].path = data.files[0].absolutePath = path;
    return data;
}

TEST(ToScaleRule, ArchivesInSpaceAndTimeAreDrawnAsStored) {
    const codec::testing::TemporaryFolder folder;
    std::vector<volume::Field> frames;
    for (int t = 0; t < 8; ++t)
        frames.push_back(volume::test::sampled<float>(volume::test::layeredLattice(AxisMap::Of::Cells),
                                                      [t](glm::dvec3 p) { return unevenLinear(p) + t; }));
    volume::Dataset made = volume::test::unevenDataset(std::move(frames), 8);
    made.info.parameters[0].ranges = {Range{20, 70}};
    codec::PackOptions options;
    options.lattice = codec::StoredLattice::D4;
    options.discard = 1e-3; // so the samples of the grid are not kept
    codec::pack(made, options, folder / "a.tsr");
    std::vector<std::string> said;
    DataRef data = archived(folder / "a.tsr");
    for (const ShownGrids grids : {ShownGrids::Both, ShownGrids::First}) {
        data.grids = grids;
        const Sources stored = openSources(data, said);
        ASSERT_FALSE(canChooseLattice(data, *stored.numbers, stored.origin));
        const Opened first = openedFirst(data, PictureLattice::Even);
        EXPECT_EQ(first.document.session.data.lattice, PictureLattice::Grid);
        EXPECT_EQ(first.source, first.numbers);
    }
}

TEST(ToScaleRule, OtherDataAreReadForTheLatticeThatIsDrawn) {
    const codec::testing::TemporaryFolder folder;
    std::vector<std::string> said;
    volume::Dataset made = volume::makeModel("membrane", membrane().settings);
    codec::PackOptions options;
    options.lattice = codec::StoredLattice::BCC;
    options.discard = 1e-3; // so the samples of the grid are not kept
    codec::pack(made, options, folder / "a.tsr");
    DataRef data = archived(folder / "a.tsr");
    data.other = OtherData{.files = {}, .model = "membrane", .settings = membrane().settings, .import = {}};
    DataRef onGrid = data;
    onGrid.lattice = PictureLattice::Grid;
    const Sources wanted = openSources(onGrid, said);
    ASSERT_EQ(openSources(data, said).numbers->info().lattice.kind, volume::LatticeKind::BCC);
    ASSERT_EQ(wanted.numbers->info().lattice.kind, volume::LatticeKind::CC);
    const Opened first = openedFirst(data, {});
    EXPECT_EQ(first.document.session.data.lattice, PictureLattice::Grid);
    EXPECT_EQ(first.numbers->info().lattice.kind, volume::LatticeKind::CC) << "as on the grid from the beginning";
    EXPECT_EQ(first.origin.unpacked, wanted.origin.unpacked);
}

TEST(ToScaleRule, ComparisonsOfferItForUnevenAxes) {
    const volume::DatasetInfo uneven = unevenLayers(AxisMap::Of::Cells)->info();
    volume::DatasetInfo even = uneven;
    even.lattice.axes = {};
    const auto offered = [](PictureLattice lattice, const volume::DatasetInfo& drawn,
                            const volume::DatasetInfo& numbers) -> std::string {
        Session session = defaultSession(drawn, {});
        session.data.lattice = lattice;
        for (const CompareOffers& group : compareOffers(session, drawn, &numbers))
            if (group.title == "The other lattice") return group.offers.at(0).variants.at(0).name;
        return {};
    };
    EXPECT_EQ(offered(PictureLattice::Even, even, uneven), "By cells");
    EXPECT_EQ(offered(PictureLattice::Grid, uneven, uneven), "To scale");
    EXPECT_EQ(offered(PictureLattice::Even, even, even), "CC") << "drawn body-centred, as usual";
    EXPECT_EQ(offered(PictureLattice::Grid, even, even), "BCC");
    volume::DatasetInfo large = uneven;
    large.lattice.size.y = 1 << 20;
    EXPECT_EQ(offered(PictureLattice::Grid, large, large), "BCC");
}

class ToScaleMemory : public DrawnWorkbench {
protected:
    ToScaleMemory() : DrawnWorkbench({.stateFolder = made()}) {}
    static std::string made() {
        const auto path = std::filesystem::temp_directory_path() / ("tessera-to-scale-" + std::to_string(::getpid()));
        std::filesystem::create_directories(path);
        return path.string();
    }
    void TearDown() override { std::filesystem::remove_all(made()); }
    void openModel(const char* model) {
        OpenRequest request;
        request.data = membrane();
        request.data->model = model;
        request.data->settings = {{"nx", 12}, {"ny", 12}, {"nz", 24}};
        workbench.open(request);
        settle();
    }
    bool isChecked(const std::string& name) {
        for (const Command& command : workbench.commands())
            if (command.title() == name) return command.checked();
        return false;
    }
};

TEST_F(ToScaleMemory, ChoicesForUnevenAxesDoNotHoldForOthers) {
    openModel("membrane");
    ASSERT_TRUE(run("Draw grids with uneven spacing to scale"));
    settle();
    EXPECT_EQ(rememberedChoice(made(), "unevenLattice"), "even");
    EXPECT_EQ(rememberedChoice(made(), "lattice"), "");
    workbench.install(smallData(16));
    settle();
    openModel("marschner-lobb");
    EXPECT_EQ(workbench.session().data.lattice, PictureLattice::BodyCentred);
    EXPECT_TRUE(isChecked("Draw on the body-centred lattice (70.7 % of the samples)"));
    workbench.session().data.lattice = PictureLattice::Even; // as a session of other data has it
    settle();
    EXPECT_EQ(workbench.source()->info().lattice.kind, volume::LatticeKind::BCC);
    EXPECT_TRUE(isChecked("Draw on the body-centred lattice (70.7 % of the samples)"));
    EXPECT_FALSE(isChecked("Draw grids with uneven spacing to scale"));
    EXPECT_EQ(rememberedChoice(made(), "lattice"), "");
    ASSERT_TRUE(run("Draw on the grid of the file"));
    settle();
    EXPECT_EQ(rememberedChoice(made(), "lattice"), "grid");
    workbench.install(smallData(16));
    settle();
    openModel("membrane");
    EXPECT_EQ(workbench.session().data.lattice, PictureLattice::Even);
    EXPECT_TRUE(workbench.source()->info().lattice.isEven());
}

} // namespace
} // namespace tessera::app
