#include "tests/volume/uneven.h"
#include "volume/flow/balance.h"
#include "volume/flow/flow.h"
#include "volume/flow/paths.h"
#include "volume/mesh/isosurface.h"
#include "volume/reconstruct/probe.h"
#include "volume/reconstruct/sample_grid.h"
#include "volume/resample/even_grid.h"
#include "volume/resample/hyperplane.h"
#include "volume/resample/resample.h"
#include "volume/resample/resample_slices.h"
#include "volume/resample/resample_taps.h"
#include "volume/sources/even_source.h"
#include "volume/sources/plane_source.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <random>

/// Lines, surfaces and other grids of data on axes of uneven spacing.
namespace tessera::volume {
namespace {

using Of = AxisMap::Of;
using test::layeredLattice;
using test::unevenBox;
using test::unevenSource;

constexpr Of kWays[] = {Of::Cells, Of::Points};

double tilted(glm::dvec3 p) {
    return 2e3 * p.x - 1e4 * p.y + 4e4 * p.z;
}

/// A flow with components of these functions.
template <class X, class Y, class Z>
std::shared_ptr<const BrickSource> flowOf(const Lattice& lattice, const X& x, const Y& y, const Z& z) {
    Dataset data = test::unevenDataset({test::sampled<float>(lattice, [](glm::dvec3) { return 1.0; }),
                                        test::sampled<float>(lattice, x), test::sampled<float>(lattice, y),
                                        test::sampled<float>(lattice, z)});
    data.info.parameters.resize(2);
    data.info.parameters[1].name = "U";
    data.info.parameters[1].components = 3;
    data.read = [read = data.read](int parameter, int component, int time) {
        return read(parameter + component, 0, time);
    };
    return makeMemorySource(data, {.brickSize = 8});
}

double areaOf(const SurfaceMesh& mesh) {
    double area = 0;
    for (const glm::uvec3 t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        area += 0.5 * glm::length(glm::cross(b - a, c - a));
    }
    return area;
}

} // namespace

TEST(UnevenFlow, LinesOfAUniformFlowAreStraight) {
    for (const Of of : kWays) {
        const Lattice lattice = layeredLattice(of);
        const glm::dvec3 u(0.5, 0.1, 1);
        const auto source = flowOf(
            lattice, [&](glm::dvec3) { return u.x; }, [&](glm::dvec3) { return u.y; }, [&](glm::dvec3) { return u.z; });
        const VectorGrid grid = readVector(*source, 1, 0, 0);
        const Box box = source->info().bounds;
        const glm::dvec3 seed(1.05e-3, 0.8e-3, 1.03e-3);
        const PathSettings settings{.lattice = lattice};
        const Pathline line =
            pathline([&](glm::dvec3 p, double) { return grid.at(p); }, seed, 0, -1e300, 1e300, settings);
        ASSERT_GT(line.places.size(), 10u);
        int layers[4] = {};
        for (std::size_t i = 0; i < line.places.size(); ++i) {
            const glm::dvec3 way = line.places[i] - seed;
            EXPECT_LT(glm::length(glm::cross(way, glm::normalize(u))), 1e-9);
            EXPECT_NEAR(line.times[i], glm::dot(way, u) / glm::dot(u, u), 1e-9);
            const double z = line.places[i].z;
            const double ends[] = {1e-3, 1.025e-3, 1.035e-3, 1.235e-3, 2.736e-3};
            for (int layer = 0; layer < 4; ++layer)
                if (z >= ends[layer] && z <= ends[layer + 1]) ++layers[layer];
        }
        for (const int points : layers) EXPECT_GE(points, 4);
        // From face to face, to 1/256 of the cells there.
        EXPECT_NEAR(line.places.front().z, box.lo.z, 12.5e-6 / 100);
        EXPECT_NEAR(line.places.back().z, box.hi.z, 350e-6 / 100);
        double length = 0;
        for (std::size_t i = 1; i < line.places.size(); ++i)
            length += glm::distance(line.places[i], line.places[i - 1]);
        EXPECT_NEAR(length, glm::distance(line.places.front(), line.places.back()), 1e-12);
    }
}

TEST(UnevenFlow, NoStepLeapsOverAThinLayer) {
    // Cells of 200 um on either side of a layer of two cells of 0.5 um.
    const auto planes = test::layerPlanes({{1e-3, 5}, {1e-6, 2}, {1e-3, 5}});
    const Lattice lattice = withAxes(test::ccLattice({3, 3, 1}, glm::dvec3(1e-3)),
                                     {{nullptr, nullptr, std::make_shared<const AxisMap>(Of::Cells, planes)}});
    const VectorField up = [&](glm::dvec3 p) -> std::optional<glm::dvec3> {
        if (p.z < 0 || p.z > 2.001e-3) return std::nullopt;
        return glm::dvec3(0, 0, 2);
    };
    const auto line = streamline(up, {1e-3, 1e-3, 0.1e-3}, {.lattice = lattice});
    const auto in = std::ranges::count_if(line, [](glm::dvec3 p) { return p.z >= 1e-3 && p.z <= 1.001e-3; });
    EXPECT_GE(in, 4);
    EXPECT_LT(line.size(), 80u);
}

TEST(UnevenFlow, AHelixThroughGradedCellsIsTheAnalyticOne) {
    const Lattice lattice = layeredLattice(Of::Points);
    const glm::dvec3 axis(1.5e-3, 1.3e-3, 0);
    const double turn = 4000;
    const VectorField helix = [&](glm::dvec3 p) -> std::optional<glm::dvec3> {
        if (p.z > 2.7e-3 || p.z < 1e-3) return std::nullopt;
        return glm::dvec3(-turn * (p.y - axis.y), turn * (p.x - axis.x), 1);
    };
    const glm::dvec3 seed(1.8e-3, 1.3e-3, 1.001e-3);
    for (const glm::dvec3 p : streamline(helix, seed, {.lattice = lattice})) {
        const double angle = turn * (p.z - seed.z);
        EXPECT_NEAR(p.x, axis.x + 3e-4 * std::cos(angle), 5e-7);
        EXPECT_NEAR(p.y, axis.y + 3e-4 * std::sin(angle), 5e-7);
    }
}

TEST(UnevenBalance, ClosesInAUniformFlowAndUsesTrueDistances) {
    for (const Of of : kWays) {
        const Lattice lattice = layeredLattice(of);
        Dataset data =
            test::unevenDataset({test::sampled<float>(lattice, [](glm::dvec3 p) { return 1 + 1e3 * (p.z - 1e-3); }),
                                 test::sampled<float>(lattice, [](glm::dvec3) { return 0.25; }),
                                 test::sampled<float>(lattice, [](glm::dvec3 p) { return p.z < 1.035e-3 ? 1 : 3; }),
                                 test::sampled<float>(lattice, [](glm::dvec3) { return 1.0; })});
        const auto source = makeMemorySource(data, {.brickSize = 8});
        const Box box = unevenBox(lattice);
        const double area = (box.hi.x - box.lo.x) * (box.hi.y - box.lo.y);
        BalanceQuery query{3, {1, 1, 1}, 2, {1, 3}, 0};
        for (const RegionBalance& region : computeBalance(*source, query)) {
            EXPECT_NEAR(region.residual(), 0, 1e-10 * region.total().in);
            EXPECT_NEAR(region.amount, region.volume, 1e-12 * region.volume);
        }
        // A linear c at the border between the regions has its value there.
        query.channel = 0;
        const std::vector<RegionBalance> of3 = computeBalance(*source, query);
        const double border = of == Of::Cells ? 1.035e-3 : lattice.axes[2]->border(of3.empty() ? 0 : 5);
        const double place = of == Of::Cells ? border : 0;
        if (of == Of::Cells) {
            ASSERT_EQ(of3[0].borders.size(), 1u);
            EXPECT_NEAR(of3[0].borders[0].crossing.out, 0.25 * area * (1 + 1e3 * (place - 1e-3)), 1e-6 * area);
            EXPECT_NEAR(of3[1].borders[0].crossing.in, of3[0].borders[0].crossing.out, 1e-12 * area);
        }
    }
}

TEST(UnevenSurface, OfALinearFieldIsFlat) {
    for (const Of of : kWays) {
        const Lattice lattice = layeredLattice(of);
        const Box box = unevenBox(lattice);
        for (const double place : {1.007e-3, 1.0313e-3, 1.2e-3, 2.4e-3}) {
            const auto source =
                unevenSource({test::sampled<float>(lattice, [&](glm::dvec3 p) { return (p.z - place) * 1e4; })});
            const SurfaceMesh mesh = extractIsosurface(*source, 0, 0, 0, 0);
            ASSERT_FALSE(mesh.triangles.empty());
            const double area = (box.hi.x - box.lo.x) * (box.hi.y - box.lo.y);
            EXPECT_NEAR(areaOf(mesh), area, 1e-6 * area);
            for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
                EXPECT_NEAR(double(mesh.positions[i].z) + mesh.origin.z, place, 1e-9);
                EXPECT_NEAR(mesh.normals[i].z, -1, 1e-6);
            }
        }
        // Oblique: flat within the samples, normals those of space.
        const SampleGrid grid = readSamples(*unevenSource({test::sampled<float>(lattice, tilted)}), 0, 0, 0);
        const SurfaceMesh mesh = extractIsosurface(grid, 50);
        ASSERT_GT(mesh.triangles.size(), 100u);
        const glm::dvec3 normal = -glm::normalize(glm::dvec3(2e3, -1e4, 4e4));
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const glm::dvec3 p = glm::dvec3(mesh.positions[i]) + mesh.origin;
            EXPECT_NEAR(tilted(p), 50, 2e-4); // 1e-9 m
            EXPECT_GT(glm::dot(glm::dvec3(mesh.normals[i]), normal), 0.99999);
        }
    }
}

TEST(UnevenSurface, CarriesTheValuesOfSpace) {
    const Lattice lattice = layeredLattice(Of::Points);
    const auto source =
        unevenSource({test::sampled<float>(lattice, tilted),
                      test::sampled<float>(lattice, [](glm::dvec3 p) { return 1e3 * p.z + 1e3 * p.x; })});
    SurfaceMesh mesh = extractIsosurface(*source, 0, 0, 50, 0);
    sampleAtVertices(mesh, *source, 1, 0, 0);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        EXPECT_NEAR(mesh.scalars[i], 1e3 * (double(mesh.positions[i].z) + double(mesh.positions[i].x)), 2e-6);
}

TEST(UnevenResample, ToAnEvenGridAndBackIsExactForALinearField) {
    for (const Of of : kWays) {
        const Lattice lattice = layeredLattice(of);
        const Field field = test::sampled<float>(lattice, tilted);
        const Lattice even = evenFor(lattice);
        EXPECT_TRUE(even.isEven());
        EXPECT_EQ(even.size.y, lattice.size.y);
        EXPECT_LE(even.spacing.z, 5e-6 * (1 + 1e-9));
        const Field made = resample(field, even, ResampleFilter::Cubic); // linear in its place
        const glm::dvec3 lo = lattice.position(glm::ivec3(0)), hi = lattice.position(lattice.size - 1);
        double scale = 0;
        for (int z = 0; z < even.size.z; ++z)
            for (int x = 0; x < even.size.x; ++x) {
                const glm::ivec3 at(x, 3, z);
                const glm::dvec3 p = glm::clamp(even.position(at), lo, hi);
                ASSERT_NEAR(made.value(even.index(at)), tilted(p), 1e-4) << x << " " << z;
                scale = std::max(scale, std::abs(tilted(p)));
            }
        EXPECT_GT(scale, 50);
        const Field back = resample(made, lattice, ResampleFilter::Linear);
        for (int z = 1; z + 1 < lattice.size.z; ++z)
            for (int x = 1; x + 1 < lattice.size.x; ++x) {
                const glm::ivec3 at(x, 3, z);
                if (of == Of::Cells && (x < 2 || z < 2)) continue; // even samples beside are of the constant half cell
                ASSERT_NEAR(back.value(lattice.index(at)), tilted(lattice.position(at)), 2e-4);
            }
        const SliceMemory memory{.step = 4, .folder = ::testing::TempDir()};
        SlicedFrame frame = inMemory(field);
        frame.extent.add(field);
        frame.whole = nullptr;
        const SlicedFrame sliced = resampled(frame, even, {}, memory);
        const Field some = sliced.read(100, 3);
        for (std::size_t i = 0; i < some.count(); ++i)
            ASSERT_EQ(some.value(i), made.value(even.index({0, 0, 100}) + i));
    }
    EXPECT_EQ(filterNote(layeredLattice(Of::Cells).axes, {}, {.filter = ResampleFilter::Cubic}),
              "linear between samples in place of cubic, since the spacing of the axes differs");
    EXPECT_EQ(filterNote({}, {}, {.filter = ResampleFilter::Cubic}), "");
}

TEST(UnevenResample, LabelsAreThoseOfTheCellAPlaceLiesIn) {
    const Lattice lattice = layeredLattice(Of::Cells);
    const Field field = test::sampled<std::uint8_t>(lattice, [](glm::dvec3 p) {
        return p.z < 1.025e-3 ? 1 : p.z < 1.035e-3 ? 2 : 3;
    });
    const Lattice even = evenFor(lattice);
    const Field made = resample(field, even, ResampleFilter::Nearest);
    for (int z = 0; z < even.size.z; ++z) {
        const double place = even.position({4, 4, z}).z;
        EXPECT_EQ(made.value(even.index({4, 4, z})), place < 1.025e-3 ? 1 : place < 1.035e-3 ? 2 : 3) << place;
    }
}

TEST(UnevenResample, EvenGridsKeepToTheirLimits) {
    const auto planes = test::layerPlanes({{1e-3, 40}, {1e-7, 2}, {1e-3, 40}});
    const auto map = std::make_shared<const AxisMap>(Of::Cells, planes);
    Lattice lattice = withAxes(test::ccLattice({200, 1, 1}), {{nullptr, map, map}});
    EXPECT_EQ(evenFor(lattice, {.perAxis = 256, .samples = 1e12}).size, glm::ivec3(200, 256, 256));
    const glm::ivec3 size = evenFor(lattice, {.perAxis = 1024, .samples = 2e6}).size;
    EXPECT_EQ(size.x, 200);
    EXPECT_LE(double(size.x) * size.y * size.z, 2e6);
    EXPECT_GT(double(size.x) * size.y * size.z, 1.8e6);
    EXPECT_THROW(evenFor(bccFor(lattice)), std::exception);
}

TEST(UnevenResample, ADataSetOnAnEvenGridKeepsItsBoxAndRegions) {
    const Lattice lattice = layeredLattice(Of::Cells);
    const double border = 1.035e-3;
    const auto valueOf = [&](glm::dvec3 p) { return p.z < border ? tilted(p) : 900 - 3 * tilted(p); };
    Dataset data =
        test::unevenDataset({test::sampled<float>(lattice, valueOf),
                             test::sampled<std::uint8_t>(lattice, [&](glm::dvec3 p) { return p.z < border ? 1 : 3; })});
    data.info.parameters[0].parts = {"p1", {{1}, {3}}};
    data.info.parameters[1].categorical = true;
    const Dataset even = onEvenGrid(data);
    EXPECT_EQ(even.info.bounds.hi, data.info.bounds.hi);
    ASSERT_EQ(even.info.notes.size(), 1u);
    const Field made = even.read(0, 0, 0);
    const Lattice& grid = even.info.lattice;
    EXPECT_EQ(made.lattice, grid);
    const glm::dvec3 lo = lattice.position(glm::ivec3(0)), hi = lattice.position(lattice.size - 1);
    for (int z = 0; z < grid.size.z; ++z) {
        const glm::dvec3 p = glm::clamp(grid.position({30, 3, z}), lo, hi);
        ASSERT_NEAR(made.value(grid.index({30, 3, z})), valueOf(p), 2e-4) << z;
    }
    EXPECT_EQ(onEvenGrid(even).info.notes.size(), 1u);
}

TEST(UnevenResample, ASourceOnAnEvenGridIsWhatItsDataSetIs) {
    const Lattice lattice = layeredLattice(Of::Cells);
    Dataset data = test::unevenDataset(
        {test::sampled<float>(lattice, [](glm::dvec3 p) { return p.z < 1.035e-3 ? tilted(p) : 900 - 3 * tilted(p); }),
         test::sampled<std::uint8_t>(lattice, [](glm::dvec3 p) { return p.z < 1.035e-3 ? 1 : 3; })});
    data.info.parameters[0].parts = {"p1", {{1}, {3}}};
    data.info.parameters[1].categorical = true;
    data.read = [read = data.read](int parameter, int component, int time) {
        Field field = read(parameter, component, time);
        if (parameter == 0) test::removeWhere(field, [](glm::dvec3 p) { return p.x > 2e-3 && p.z > 2e-3; });
        return field;
    };
    const Dataset a = onEvenGrid(data), b = onEvenGrid(makeMemorySource(data, {.brickSize = 8}));
    EXPECT_EQ(a.info, b.info);
    for (const int parameter : {0, 1}) {
        const Field one = a.read(parameter, 0, 0), other = b.read(parameter, 0, 0);
        EXPECT_EQ(one.samples, other.samples);
        EXPECT_EQ(one.mask != nullptr, other.mask != nullptr);
        if (one.mask) {
            EXPECT_EQ(*one.mask, *other.mask);
        }
    }
}

TEST(UnevenResample, OnTheSheetBccIsWhatItIsOfEvenAxes) {
    const Lattice lattice = layeredLattice(Of::Cells);
    Lattice sheet = lattice;
    sheet.axes = {};
    std::mt19937 random(5);
    Field field = makeField(lattice, ScalarType::F32);
    for (float& value : field.as<float>()) value = float(random() % 1000);
    Field even = field;
    even.lattice = sheet;
    const Field a = toBcc(field, false), b = toBcc(even, false);
    EXPECT_EQ(a.samples, b.samples);
    EXPECT_EQ(a.lattice, bccFor(lattice));
}

TEST(UnevenHyperplane, KeepsTheAxesThatItDoesNotReplace) {
    const Lattice lattice = layeredLattice(Of::Points);
    const auto frameAt = [&](int time) {
        return std::make_shared<const Field>(
            test::sampled<float>(lattice, [&](glm::dvec3 p) { return tilted(p) + time; }));
    };
    const Series series{{LatticeKind4::CC, glm::ivec4(lattice.size, 3), glm::dvec4(lattice.spacing, 1),
                         glm::dvec4(lattice.origin, 0), lattice.axes},
                        false,
                        frameAt};
    // Across x, at a place between samples: y, z and time remain.
    const double place = 1.7312e-3;
    const HyperplaneSlice slice = sliceBy(series, {{1, 0, 0, 0}, -place});
    EXPECT_EQ(slice.solved, 0);
    const Lattice& grid = slice.field.lattice;
    EXPECT_EQ(grid.size, glm::ivec3(lattice.size.y, lattice.size.z, 3));
    EXPECT_EQ(grid.axes[0], nullptr);
    ASSERT_NE(grid.axes[1], nullptr);
    EXPECT_EQ(grid.axes[2], nullptr);
    for (int t = 0; t < 3; ++t)
        for (int z = 0; z < lattice.size.z; ++z) {
            const glm::dvec3 at = grid.position({4, z, t});
            EXPECT_NEAR(at.y, lattice.position({0, 0, z}).z, 1e-15);
            EXPECT_NEAR(slice.field.value(grid.index({4, z, t})), tilted({place, at.x, at.y}) + t, 1e-4);
        }
}

TEST(UnevenTimeAxis, KeepsTheAxesThatItDoesNotReplace) {
    for (const Of of : kWays) {
        const Lattice lattice = layeredLattice(of);
        std::vector<Field> fields;
        for (int t = 0; t < 3; ++t)
            fields.push_back(test::sampled<float>(lattice, [&](glm::dvec3 p) { return tilted(p) + 10 * t; }));
        const auto source = makeMemorySource(test::unevenDataset(std::move(fields), 3), {.brickSize = 8});
        TimeAxis axis;
        axis.axis = SpaceAxis::X;
        axis.place = 0.5;
        const auto made = makePlaneSource(source, axis);
        const Lattice& grid = made->info().lattice;
        EXPECT_EQ(grid.axes[0], nullptr);
        ASSERT_NE(grid.axes[2], nullptr);
        EXPECT_EQ(*grid.axes[2], *lattice.axes[2]);
        const SampleGrid field = readSamples(*made, 0, 0, 0);
        const double x = 0.5 * (source->info().bounds.lo.x + source->info().bounds.hi.x);
        for (int t = 0; t < 3; ++t)
            for (int z = 0; z < grid.size.z; ++z) {
                const glm::dvec3 at = grid.position({t, 4, z});
                EXPECT_NEAR(field.values[grid.index({t, 4, z})], tilted({x, at.y, at.z}) + 10 * t, 1e-4);
            }
    }
}

} // namespace tessera::volume
