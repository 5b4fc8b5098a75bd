#include "volume/flow/sections.h"

#include "tests/volume/cell_data.h"
#include "tests/volume/cell_lengths.h"
#include "volume/flow/box_cut.h"
#include "volume/flow/flow_channels.h"
#include "volume/import/foreign.h"
#include "volume/import/import.h"
#include "volume/synthetic/models.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <map>
#include <tbb/global_control.h>

namespace tessera::volume {
namespace {

using test::cellData;
using test::cellLength;
using test::cellSource;
using test::forAll;

struct Plane {
    double samples = 0, area = 0, integral = 0, weight = 0, weighted = 0, flux = 0, flow = 0, least = INFINITY,
           most = -INFINITY;
};

/// A value of a field, NaN where absent.
double valueAt(const Field& field, std::size_t i) {
    return field.present(i) ? double(float(field.value(i))) : NAN;
}

/// Planes across an axis by position, straight from the formulas of sections.h.
std::map<double, Plane> bruteForce(const Dataset& data, int parameter, int axis, std::optional<int> region,
                                   bool massFlow, const std::function<double(double, glm::dvec3)>& doi = {}) {
    const Lattice& lattice = data.info.lattice;
    const Field f = data.read(parameter, 0, 0), label = data.read(test::kRegion, 0, 0),
                rho = data.read(test::kRho, 0, 0), u = data.read(test::kU, axis, 0);
    std::map<double, Plane> planes;
    forAll(lattice, [&](glm::ivec3 at, std::size_t i) {
        Plane& plane = planes[lattice.position(at)[axis]];
        const double value = valueAt(f, i);
        if (region && valueAt(label, i) != *region) return;
        if (std::isnan(value)) return;
        const double d = doi ? doi(value, lattice.position(at)) : 1;
        if (d <= 0) return;
        const double a = d * cellLength(lattice, data.info.bounds, at, (axis + 1) % 3) *
                         cellLength(lattice, data.info.bounds, at, (axis + 2) % 3);
        const double speed = std::isnan(valueAt(u, i)) ? 0 : valueAt(u, i);
        const double weight = massFlow ? std::abs(valueAt(rho, i) * speed) * a : a;
        plane.samples += d;
        plane.area += a;
        plane.integral += value * a;
        plane.weight += weight;
        plane.weighted += value * weight;
        plane.flux += value * speed * a;
        plane.flow += speed * a;
        if (d < 0.5) return;
        plane.least = std::min(plane.least, value);
        plane.most = std::max(plane.most, value);
    });
    return planes;
}

void expectPlanes(const Sections& got, const std::vector<SectionValues>& values, const std::map<double, Plane>& want) {
    ASSERT_EQ(got.place.size(), want.size());
    std::size_t p = 0;
    for (const auto& [place, plane] : want) {
        EXPECT_NEAR(got.place[p], place, 1e-12);
        const SectionValues& value = values[p++];
        EXPECT_NEAR(value.samples, plane.samples, 1e-9);
        EXPECT_NEAR(value.area, plane.area, 1e-12 * (1 + plane.area));
        EXPECT_NEAR(value.flux, plane.flux, 1e-10 * (1 + std::abs(plane.flux)));
        EXPECT_NEAR(value.flow, plane.flow, 1e-10 * (1 + std::abs(plane.flow)));
        if (plane.area == 0) {
            EXPECT_TRUE(std::isnan(value.mean) && std::isnan(value.integral) && std::isnan(value.least));
            continue;
        }
        EXPECT_NEAR(value.integral, plane.integral, 1e-10 * (1 + std::abs(plane.integral)));
        if (plane.weight > 0) {
            EXPECT_NEAR(value.mean, plane.weighted / plane.weight, 1e-10);
        }
        if (plane.least > plane.most) continue;
        EXPECT_EQ(value.least, plane.least);
        EXPECT_EQ(value.most, plane.most);
    }
}

SectionQuery queryOf(SpaceAxis axis, SectionWeight weight) {
    SectionQuery query;
    query.channels = {0, 2};
    query.velocity = {3, 4, 5};
    query.density = 2;
    query.weight = weight;
    query.axis = axis;
    return query;
}

std::vector<Lattice> lattices() {
    const Lattice cc = test::ccLattice({9, 11, 19}, {0.5, 0.25, 2}, {1, -2, 3});
    return {cc, bccFor(cc), test::ccLattice({1, 3, 1}, {0.5, 0.25, 2})};
}

Box boxFor(const Lattice& lattice) {
    const Lattice cc = test::ccLattice({9, 11, 19}, {0.5, 0.25, 2}, {1, -2, 3});
    return lattice.size == glm::ivec3(1, 3, 1) ? test::boxOf(lattice) : test::boxOf(cc);
}

TEST(Sections, AgreeWithBruteForceOnEveryLatticeAxisAndWeight) {
    for (const Lattice& lattice : lattices()) {
        const Dataset data = cellData(lattice, boxFor(lattice));
        const auto source = cellSource(data);
        for (const SpaceAxis axis : {SpaceAxis::X, SpaceAxis::Y, SpaceAxis::Z})
            for (const SectionWeight weight : {SectionWeight::Area, SectionWeight::Volume, SectionWeight::MassFlow}) {
                SectionQuery query = queryOf(axis, weight);
                const bool massFlow = weight == SectionWeight::MassFlow;
                const Sections all = computeSections(*source, query);
                expectPlanes(all, all.values[0][0], bruteForce(data, test::kO2, int(axis), {}, massFlow));
                expectPlanes(all, all.values[0][1], bruteForce(data, test::kRho, int(axis), {}, massFlow));
                query.label = 1;
                query.regions = {3, 0, 1};
                const Sections regions = computeSections(*source, query);
                for (std::size_t r = 0; r < 3; ++r)
                    expectPlanes(regions, regions.values[r][0],
                                 bruteForce(data, test::kO2, int(axis), query.regions[r], massFlow));
            }
    }
}

TEST(Sections, WeighByTheDegreeOfInterest) {
    const Dataset data = cellData(lattices()[1], boxFor(lattices()[1]));
    const auto source = cellSource(data);
    const auto doi = [](double value, glm::dvec3 p) {
        return std::isnan(value) ? 0.0 : std::clamp((value - 3.5) * 0.5 + 0.1 * p.x, 0.0, 1.0);
    };
    SectionQuery query = queryOf(SpaceAxis::Y, SectionWeight::Area);
    query.doiChannels = {2, 0};
    query.doi = [&](std::span<const float> values, glm::dvec3 p) { return doi(double(values[1]), p); };
    const Sections sections = computeSections(*source, query);
    expectPlanes(sections, sections.values[0][0], bruteForce(data, test::kO2, 1, {}, false, doi));
}

TEST(Sections, OfAConstantAreTheConstantAndTheArea) {
    for (const Lattice& lattice : lattices()) {
        const Box box = boxFor(lattice);
        Dataset data = test::datasetOf({test::sampled<float>(lattice, [](glm::dvec3) { return 2.5; })});
        data.info.bounds = box;
        const auto source = cellSource(data);
        for (const SpaceAxis axis : {SpaceAxis::X, SpaceAxis::Y, SpaceAxis::Z}) {
            SectionQuery query;
            query.channels = {0};
            query.axis = axis;
            double area = 1;
            for (int other = 0; other < 3; ++other)
                if (other != int(axis)) area *= box.size()[other] > 0 ? box.size()[other] : lattice.spacing[other];
            const Sections sections = computeSections(*source, query);
            for (const SectionValues& value : sections.values[0][0]) {
                EXPECT_NEAR(value.area, area, 1e-12 * area);
                EXPECT_NEAR(value.integral, 2.5 * area, 1e-12 * area);
                EXPECT_NEAR(value.mean, 2.5, 1e-14);
                EXPECT_EQ(value.flux, 0);
            }
        }
    }
}

TEST(Sections, OfALinearFunctionAreItsValueInTheMiddleOfThePlane) {
    const Lattice lattice = lattices()[0];
    const Box box = boxFor(lattice);
    const glm::dvec3 slope(0.5, -2, 0.25); // exact in floats at these samples
    Dataset data = test::datasetOf({test::sampled<float>(lattice, [&](glm::dvec3 p) { return glm::dot(slope, p); })});
    const auto source = cellSource(data);
    for (int axis = 0; axis < 3; ++axis) {
        SectionQuery query;
        query.channels = {0};
        query.axis = SpaceAxis(axis);
        const Sections sections = computeSections(*source, query);
        for (std::size_t p = 0; p < sections.place.size(); ++p) {
            glm::dvec3 middle = box.center();
            middle[axis] = sections.place[p];
            EXPECT_NEAR(sections.values[0][0][p].mean, glm::dot(slope, middle), 1e-12);
        }
    }
}

/// Sum over planes of integral * thickness.
double overPlanes(const Sections& sections, std::size_t region) {
    double sum = 0;
    for (std::size_t p = 0; p < sections.place.size(); ++p)
        if (sections.values[region][0][p].area > 0)
            sum += sections.values[region][0][p].integral * sections.thickness[p];
    return sum;
}

TEST(Sections, AddUpToTheVolumeIntegralAlongAxesAndLines) {
    for (const Lattice& lattice : {lattices()[0], lattices()[1]}) {
        const Box box = boxFor(lattice);
        const Dataset data = cellData(lattice, box);
        const auto source = cellSource(data);
        const Field o2 = data.read(test::kO2, 0, 0), label = data.read(test::kRegion, 0, 0);
        const int share = lattice.kind == LatticeKind::BCC ? 2 : 1;
        std::map<int, double> whole;
        forAll(lattice, [&](glm::ivec3 at, std::size_t i) {
            if (!o2.present(i) || !label.present(i)) return;
            double cell = 1.0 / share;
            for (int axis = 0; axis < 3; ++axis) cell *= cellLength(lattice, box, at, axis);
            whole[int(label.value(i))] += cell * o2.value(i);
        });
        std::vector<SectionQuery> queries;
        for (int axis = 0; axis < 3; ++axis) queries.push_back(queryOf(SpaceAxis(axis), SectionWeight::Area));
        // Lines long enough that all of the box lies between their ends.
        for (const glm::dvec3 along : {glm::dvec3(1, 2, 3), glm::dvec3(-1, 0, 0.3), glm::dvec3(0, 0, -1),
                                       glm::dvec3(1e-5, 1, 2e-5), glm::dvec3(3, -1, 1)})
            for (const int planes : {1, 7, 400}) {
                SectionQuery query = queryOf(SpaceAxis::Z, SectionWeight::Volume);
                const glm::dvec3 reach = 60.0 * glm::normalize(along);
                query.line = {box.center() - reach, box.center() + reach};
                query.planes = planes;
                queries.push_back(query);
            }
        for (SectionQuery& query : queries) {
            query.label = 1;
            query.regions = {0, 1, 3};
            const Sections sections = computeSections(*source, query);
            for (std::size_t r = 0; r < 3; ++r)
                EXPECT_NEAR(overPlanes(sections, r), whole[query.regions[r]], 1e-8 * std::abs(whole[query.regions[r]]));
        }
    }
}

TEST(Sections, AcrossALineFollowAFunctionOfTheDistance) {
    const Lattice lattice = test::ccLattice({40, 40, 40}, {0.1, 0.1, 0.1});
    const glm::dvec3 along = glm::normalize(glm::dvec3(1, 2, 2));
    const Dataset data =
        test::datasetOf({test::sampled<float>(lattice, [&](glm::dvec3 p) { return glm::dot(along, p); })});
    SectionQuery query;
    query.channels = {0};
    query.line = {glm::dvec3(0), 5.0 * along};
    query.planes = 25;
    const Sections sections = computeSections(*cellSource(data), query);
    for (std::size_t p = 3; p < 25; ++p) {
        EXPECT_NEAR(sections.place[p], (double(p) + 0.5) / 5, 1e-12);
        EXPECT_NEAR(sections.values[0][0][p].mean, sections.place[p], 0.005);
    }
    // The plane through the middle of a cube of 3.9 a side.
    query.line = {glm::dvec3(1.95) - along, glm::dvec3(1.95) + along};
    query.planes = 1;
    double points = 0, inside = 0; // of a disc's square in the plane
    const glm::dvec3 a = glm::normalize(glm::cross(along, glm::dvec3(1, 0, 0))), b = glm::cross(along, a);
    for (double s = -4; s < 4; s += 0.01)
        for (double t = -4; t < 4; t += 0.01, ++points) {
            const glm::dvec3 p = s * a + t * b;
            if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < 1.95) ++inside;
        }
    EXPECT_NEAR(computeSections(*cellSource(data), query).values[0][0][0].area, inside * 1e-4, 0.04);
}

TEST(Sections, DoNotDependOnTheNumberOfThreads) {
    const Dataset data = cellData(lattices()[1], boxFor(lattices()[1]));
    const auto source = cellSource(data);
    SectionQuery query = queryOf(SpaceAxis::X, SectionWeight::MassFlow);
    query.line = {glm::dvec3(0), glm::dvec3(3, 2, 30)};
    const auto means = [&] {
        std::vector<double> out;
        const Sections sections = computeSections(*source, query);
        for (const SectionValues& value : sections.values[0][0]) out.push_back(value.mean);
        return out;
    };
    const std::vector<double> many = means();
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const std::vector<double> single = means();
    for (std::size_t i = 0; i < many.size(); ++i)
        EXPECT_TRUE(many[i] == single[i] || (std::isnan(many[i]) && std::isnan(single[i])));
}

TEST(Sections, ALineWithoutLengthIsAnError) {
    SectionQuery query;
    query.channels = {0};
    query.line = {glm::dvec3(1), glm::dvec3(1)};
    EXPECT_THROW(computeSections(*cellSource(cellData(lattices()[0], boxFor(lattices()[0]))), query), Error);
}

/// Means per slice of a parameter of a CC data set along z, by area of half cells at the faces, of one label value.
std::vector<double> meansAlongZ(const Dataset& data, int parameter, int label, int region, int time) {
    const Lattice& lattice = data.info.lattice;
    const Field f = data.read(parameter, 0, time), labels = data.read(label, 0, time);
    std::vector<double> sums(std::size_t(lattice.size.z)), areas(sums);
    forAll(lattice, [&](glm::ivec3 at, std::size_t i) {
        if (!f.present(i) || !labels.present(i) || labels.value(i) != region) return;
        const double area = test::lengthInBox(data.info, at, 0) * test::lengthInBox(data.info, at, 1);
        sums[std::size_t(at.z)] += area * double(float(f.value(i)));
        areas[std::size_t(at.z)] += area;
    });
    for (std::size_t z = 0; z < sums.size(); ++z) sums[z] /= areas[z];
    return sums;
}

int parameterNamed(const DatasetInfo& info, const std::string& name) {
    for (std::size_t p = 0; p < info.parameters.size(); ++p)
        if (info.parameters[p].name == name) return int(p);
    ADD_FAILURE() << "no " << name;
    return 0;
}

TEST(Sections, OfTheSharedFuelCellAreThoseMadeByHand) {
    const char* stated = std::getenv("TESSERA_DATA");
    const std::filesystem::path file =
        std::filesystem::path(stated != nullptr ? stated : TESSERA_TEST_DATA) / "fuel-cell/grid/large_0260.vti";
    if (!std::filesystem::exists(file) || findImporter().empty()) GTEST_SKIP() << "no " << file << " or no importer";
    const Dataset data = openFiles({file.string()}, {});
    const auto source = makeMemorySource(data, {LatticeKind::CC, 32, std::size_t(1) << 30});
    const DatasetInfo& info = source->info();
    const int label = parameterNamed(info, "region");
    struct Along {
        const char* name;
        int region;
        double first, last; // as averaged by hand, to the digits given
    };
    for (const Along& along : {Along{"O2", 1, 5.28, 3.02}, Along{"H2O", 1, 1.24, 4.97}, Along{"H2", 3, 21.80, 20.78}}) {
        SectionQuery query;
        query.channels = {*info.findChannel(along.name)};
        query.label = *labelChannel(info);
        query.regions = {along.region};
        const Sections sections = computeSections(*source, query);
        const std::vector<double> want = meansAlongZ(data, parameterNamed(info, along.name), label, along.region, 0);
        const std::vector<SectionValues>& got = sections.values[0][0];
        ASSERT_EQ(got.size(), want.size());
        for (std::size_t z = 0; z < want.size(); ++z) EXPECT_NEAR(got[z].mean, want[z], 1e-9) << along.name << z;
        EXPECT_NEAR(got.front().mean, along.first, 0.01) << along.name;
        EXPECT_NEAR(got.back().mean, along.last, 0.01) << along.name;
    }
}

void expectCellAsByBruteForce(bool even) {
    SCOPED_TRACE(even);
    const Dataset data =
        makeModel("fuel-cell", {{"nx", 11}, {"ny", 13}, {"nz", 31}, {"times", 2}, {"even", double(even)}});
    const auto source = makeMemorySource(data, {LatticeKind::CC, 32, std::size_t(1) << 28});
    const DatasetInfo& info = source->info();
    const auto label = labelChannel(info);
    ASSERT_TRUE(label && velocityChannels(info));
    const std::vector<int> regions = labelValues(*source, *label, 1);
    ASSERT_GE(regions.size(), 2u);
    SectionQuery query;
    query.channels = {*info.findChannel("T")};
    query.label = *label;
    query.regions = regions;
    query.time = 1;
    const Sections sections = computeSections(*source, query);
    for (std::size_t r = 0; r < regions.size(); ++r) {
        const std::vector<double> want = meansAlongZ(
            data, parameterNamed(info, "T"), parameterNamed(info, parameterOf(info, *label).name), regions[r], 1);
        for (std::size_t z = 0; z < want.size(); ++z)
            EXPECT_TRUE(std::isnan(want[z]) || std::abs(sections.values[r][0][z].mean - want[z]) < 1e-9);
    }
}

TEST(Sections, OfTheBuiltInCellAgreeWithBruteForce) {
    expectCellAsByBruteForce(true);
    expectCellAsByBruteForce(false);
}

} // namespace
} // namespace tessera::volume
