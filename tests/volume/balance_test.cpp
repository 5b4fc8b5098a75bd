#include "volume/flow/balance.h"

#include "tests/volume/cell_data.h"

#include <cmath>
#include <gtest/gtest.h>
#include <map>

namespace tessera::volume {
namespace {

using test::cellData;
using test::cellLength;
using test::cellSource;
using test::forAll;

const Lattice kCc = test::ccLattice({9, 11, 19}, {0.5, 0.25, 2}, {1, -2, 3});

BalanceQuery query() {
    BalanceQuery out;
    out.channel = 0;
    out.velocity = {3, 4, 5};
    out.label = 1;
    out.regions = {0, 1, 3};
    return out;
}

double valueAt(const Field& field, std::size_t i) {
    return field.present(i) ? double(float(field.value(i))) : NAN;
}

TEST(Balance, AgreesWithBruteForceOnEveryFaceAndBorder) {
    for (const Lattice& lattice : {kCc, bccFor(kCc)}) {
        const Dataset data = cellData(lattice, test::boxOf(kCc));
        const int step = lattice.kind == LatticeKind::BCC ? 2 : 1; // between slices of a sublattice
        const Field c = data.read(test::kO2, 0, 0), label = data.read(test::kRegion, 0, 0);
        std::vector<Field> u;
        for (int axis = 0; axis < 3; ++axis) u.push_back(data.read(test::kU, axis, 0));
        struct Sum {
            double in = 0, out = 0, area = 0, flow = 0;
        };
        std::map<int, std::map<int, Sum>> faces, borders; // by region, then face or other region
        std::map<int, Sum> absent, unlabelled;
        std::map<int, double> amount;
        const auto put = [](Sum& sum, double carried, double flow, double area) {
            if (carried > 0) sum.out += carried;
            if (carried < 0) sum.in -= carried;
            sum.area += area;
            sum.flow += flow;
        };
        forAll(lattice, [&](glm::ivec3 at, std::size_t i) {
            if (!label.present(i) || !c.present(i)) return;
            const int own = int(label.value(i));
            glm::dvec3 cell;
            for (int axis = 0; axis < 3; ++axis) cell[axis] = cellLength(lattice, data.info.bounds, at, axis);
            amount[own] += valueAt(c, i) * cell.x * cell.y * cell.z / step;
            for (int axis = 0; axis < 3; ++axis)
                for (const int side : {-1, 1}) {
                    const double speed = valueAt(u[std::size_t(axis)], i);
                    if (std::isnan(speed)) continue;
                    const double area = cell[(axis + 1) % 3] * cell[(axis + 2) % 3] / step;
                    glm::ivec3 next = at;
                    next[axis] += side * (axis == 2 ? step : 1);
                    if (next[axis] < 0 || next[axis] >= lattice.size[axis]) {
                        put(faces[own][2 * axis + (side + 1) / 2], valueAt(c, i) * speed * side * area,
                            speed * side * area, area);
                        continue;
                    }
                    const std::size_t j = lattice.index(next);
                    const double beyond = valueAt(c, j) * valueAt(u[std::size_t(axis)], j);
                    if (std::isnan(beyond)) {
                        double carried = valueAt(c, i) * speed, flow = speed;
                        glm::ivec3 before = at;
                        before[axis] -= side * (axis == 2 ? step : 1);
                        if (before[axis] >= 0 && before[axis] < lattice.size[axis]) {
                            const std::size_t b = lattice.index(before);
                            const double inner = valueAt(u[std::size_t(axis)], b), both = valueAt(c, b) * inner;
                            if (!std::isnan(both))
                                carried = 1.5 * carried - 0.5 * both, flow = 1.5 * flow - 0.5 * inner;
                        }
                        put(absent[own], carried * side * area, flow * side * area, area);
                        continue;
                    }
                    if (label.present(j) && int(label.value(j)) == own) continue;
                    put(label.present(j) ? borders[own][int(label.value(j))] : unlabelled[own],
                        0.5 * (valueAt(c, i) * speed + beyond) * side * area,
                        0.5 * (speed + valueAt(u[std::size_t(axis)], j)) * side * area, area);
                }
        });
        const std::vector<RegionBalance> got = computeBalance(*cellSource(data), query());
        ASSERT_EQ(got.size(), 3u);
        const auto expectCrossing = [](const Crossing& crossing, const Sum& want) {
            EXPECT_NEAR(crossing.in, want.in, 1e-10 * (1 + want.in));
            EXPECT_NEAR(crossing.out, want.out, 1e-10 * (1 + want.out));
            EXPECT_NEAR(crossing.area, want.area, 1e-10 * (1 + want.area));
            EXPECT_NEAR(crossing.flow, want.flow, 1e-10 * (1 + std::abs(want.flow)));
        };
        for (const RegionBalance& balance : got) {
            EXPECT_NEAR(balance.amount, amount[balance.region], 1e-10 * amount[balance.region]);
            double in = 0, out = 0;
            for (int f = 0; f < 6; ++f) {
                expectCrossing(balance.faces[std::size_t(f)], faces[balance.region][f]);
                in += faces[balance.region][f].in;
                out += faces[balance.region][f].out;
            }
            for (const auto& [crossing, want] : {std::pair{balance.absent, absent[balance.region]},
                                                 std::pair{balance.unlabelled, unlabelled[balance.region]}}) {
                expectCrossing(crossing, want);
                EXPECT_GT(want.area, 0);
                in += want.in;
                out += want.out;
            }
            ASSERT_EQ(balance.borders.size(), borders[balance.region].size());
            for (const BorderCrossing& border : balance.borders) {
                const Sum& want = borders[balance.region][border.region];
                expectCrossing(border.crossing, want);
                in += want.in;
                out += want.out;
            }
            EXPECT_NEAR(balance.residual(), out - in, 1e-9);
        }
        // What leaves one region over a border enters the other.
        for (const RegionBalance& one : got)
            for (const RegionBalance& other : got)
                for (const BorderCrossing& a : one.borders)
                    for (const BorderCrossing& b : other.borders)
                        if (a.region == other.region && b.region == one.region) {
                            EXPECT_NEAR(a.crossing.in, b.crossing.out, 1e-10);
                            EXPECT_NEAR(a.crossing.flow, -b.crossing.flow, 1e-10);
                        }
    }
}

/// A channel through which `speed(p)` carries `c(p)`, region 1 below the middle of y and 2 above.
std::shared_ptr<const BrickSource> channel(const std::function<double(glm::dvec3)>& c,
                                           const std::function<glm::dvec3(glm::dvec3)>& speed) {
    std::vector<Field> fields{test::sampled<float>(kCc, c),
                              test::sampled<float>(kCc, [](glm::dvec3 p) { return p.y < -0.7 ? 1 : 2; })};
    for (int axis = 0; axis < 3; ++axis)
        fields.push_back(test::sampled<float>(kCc, [&](glm::dvec3 p) { return speed(p)[axis]; }));
    Dataset data = test::datasetOf(std::move(fields));
    data.info.parameters[1].categorical = true;
    return cellSource(data);
}

BalanceQuery ofChannel(bool regions) {
    BalanceQuery out;
    out.velocity = {2, 3, 4};
    out.label = regions ? 1 : -1;
    out.regions = {1, 2};
    return out;
}

TEST(Balance, IsZeroWhereNothingReactsAndThatIsSeenToRounding) {
    // Divergence free: what enters along x leaves along y and z.
    const auto source = channel([](glm::dvec3) { return 3.0; },
                                [](glm::dvec3 p) { return glm::dvec3(2 + p.x, 1 - 0.75 * p.y, 8 - 0.25 * p.z); });
    const RegionBalance whole = computeBalance(*source, ofChannel(false)).at(0);
    EXPECT_NEAR(whole.residual(), 0, 1e-11 * whole.total().in);
    EXPECT_GT(whole.total().in, 1);
    EXPECT_NEAR(whole.volume, 4 * 2.5 * 36, 1e-9);
    EXPECT_NEAR(whole.amount, 3 * 4 * 2.5 * 36, 1e-8);
}

TEST(Balance, FindsAReactionOfAThousandth) {
    // c falls by a thousandth along z in a flow of 1: used up = 0.001 * c * area.
    const auto source = channel([](glm::dvec3 p) { return 5 * (1 - 0.001 * (p.z - 3) / 36); },
                                [](glm::dvec3) { return glm::dvec3(0, 0, 1); });
    for (const RegionBalance& balance : computeBalance(*source, ofChannel(true))) {
        EXPECT_NEAR(balance.residual() / balance.total().in, -0.001, 1e-6);
        EXPECT_EQ(balance.faces[4].out, 0); // z from below: all flows in
        EXPECT_EQ(balance.faces[5].in, 0);
        EXPECT_EQ(balance.total().flow, 0);
        ASSERT_EQ(balance.borders.size(), 1u);
        EXPECT_EQ(balance.borders[0].crossing.in + balance.borders[0].crossing.out, 0);
    }
}

TEST(Balance, OfACrossFlowLeavesThroughTheBorder) {
    const auto source = channel([](glm::dvec3) { return 2.0; }, [](glm::dvec3) { return glm::dvec3(0, 0.5, 0); });
    const std::vector<RegionBalance> both = computeBalance(*source, ofChannel(true));
    const double carried = 2 * 0.5 * 4 * 36;
    EXPECT_NEAR(both[0].faces[2].in, carried, 1e-9);
    EXPECT_NEAR(both[0].borders.at(0).crossing.out, carried, 1e-9);
    EXPECT_EQ(both[0].borders[0].region, 2);
    EXPECT_NEAR(both[1].borders.at(0).crossing.in, carried, 1e-9);
    EXPECT_NEAR(both[1].residual(), 0, 1e-9);
}

// A pipe whose end lies inside the box: what flows out there has not reacted.
TEST(Balance, OfAPipeThatEndsInsideTheBoxIsZero) {
    const auto inside = [](glm::dvec3 p) { return p.z < 20; };
    for (const bool alsoVelocity : {false, true}) {
        std::vector<Field> fields{test::sampled<float>(kCc, [](glm::dvec3) { return 2.0; })};
        for (int axis = 0; axis < 3; ++axis)
            fields.push_back(test::sampled<float>(kCc, [&](glm::dvec3) { return axis == 2 ? 0.5 : 0.0; }));
        for (std::size_t i = 0; i < fields.size(); ++i)
            if (i == 0 || alsoVelocity) test::removeWhere(fields[i], [&](glm::dvec3 p) { return !inside(p); });
        BalanceQuery query;
        query.velocity = {1, 2, 3};
        const RegionBalance whole = computeBalance(*cellSource(test::datasetOf(std::move(fields))), query).at(0);
        const double carried = 2 * 0.5 * 4 * 2.5;
        EXPECT_NEAR(whole.faces[4].in, carried, 1e-9);
        EXPECT_EQ(whole.faces[5].out, 0);
        EXPECT_NEAR(whole.absent.out, carried, 1e-9);
        EXPECT_NEAR(whole.absent.flow, 0.5 * 4 * 2.5, 1e-9);
        EXPECT_NEAR(whole.residual(), 0, 1e-9) << "without the surface: all of it reacts";
    }
}

// Speeds that fall to 0 at a wall half a cell beyond the last sample that has any.
TEST(Balance, NothingFlowsThroughAWallInsideTheBox) {
    double last = kCc.origin.z;
    while (last + kCc.spacing.z < 20) last += kCc.spacing.z;
    const double wall = last + 0.5 * kCc.spacing.z;
    std::vector<Field> fields{test::sampled<float>(kCc, [](glm::dvec3) { return 2.0; })};
    for (int axis = 0; axis < 3; ++axis)
        fields.push_back(test::sampled<float>(kCc, [&](glm::dvec3 p) { return axis == 2 ? wall - p.z : 0.0; }));
    test::removeWhere(fields[0], [&](glm::dvec3 p) { return p.z > wall; });
    BalanceQuery query;
    query.velocity = {1, 2, 3};
    const RegionBalance whole = computeBalance(*cellSource(test::datasetOf(std::move(fields))), query).at(0);
    EXPECT_GT(whole.absent.area, 1);
    EXPECT_GT(whole.faces[4].in, 1);
    EXPECT_NEAR(whole.absent.net(), 0, 1e-5 * whole.faces[4].in);
    EXPECT_NEAR(whole.absent.flow, 0, 1e-5 * whole.faces[4].in);
}

} // namespace
} // namespace tessera::volume
