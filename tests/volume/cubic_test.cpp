#include "volume/reconstruct/cubic.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

/// Reconstruction by cubic B-splines, and the coefficients that it reads.
namespace tessera::volume {
namespace {

constexpr LatticeKind kCubicKinds[] = {LatticeKind::CC, LatticeKind::BCC};

std::size_t at(const BrickSamples& of, glm::ivec3 i) {
    return (std::size_t(i.z) * std::size_t(of.size.y) + std::size_t(i.y)) * std::size_t(of.size.x) + std::size_t(i.x);
}

/// Where a sample lies, in cells.
glm::dvec3 placeOf(LatticeKind kind, glm::ivec3 i) {
    if (kind == LatticeKind::CC) return glm::dvec3(i);
    return glm::dvec3(i.x, i.y, i.z >> 1) + 0.5 * (i.z & 1);
}

BrickSamples sampled(LatticeKind kind, int edge, const auto& value) {
    BrickSamples out;
    out.size = glm::ivec3(edge, edge, kind == LatticeKind::BCC ? 2 * edge : edge);
    for (int z = 0; z < out.size.z; ++z)
        for (int y = 0; y < out.size.y; ++y)
            for (int x = 0; x < out.size.x; ++x) out.values.push_back(float(value(placeOf(kind, {x, y, z}))));
    return out;
}

/// The kernel by its definition.
double kernel(LatticeKind kind, glm::dvec3 cells) {
    double product = kind == LatticeKind::BCC ? 0.5 : 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double t = std::abs(cells[axis]);
        product *= t < 1 ? 2.0 / 3 - t * t + t * t * t / 2 : t < 2 ? (2 - t) * (2 - t) * (2 - t) / 6 : 0;
    }
    return product;
}

// Polynomials of third degree come back as they were, between samples, too: the filter is of order four.
TEST(Cubic, PolynomialsOfThirdDegreeAreExact) {
    const auto value = [](glm::dvec3 p) {
        const glm::dvec3 q = (p - 9.0) / 9.0;
        return q.x * q.x * q.x - 2 * q.x * q.y * q.z + q.y * q.y - 0.7 * q.z * q.z * q.y + 0.3 * q.x - 1;
    };
    std::mt19937 random(3);
    for (const LatticeKind kind : kCubicKinds) {
        const LevelGeometry geometry{kind, 1, 0};
        const int reach = prefilterReach(Prefilter::Cubic, geometry), inner = 7;
        const BrickSamples raw = sampled(kind, inner + 2 * reach, value),
                           found = prefiltered(raw, geometry, Prefilter::Cubic);
        ASSERT_EQ(found.size, glm::ivec3(inner, inner, kind == LatticeKind::BCC ? 2 * inner : inner));
        const BrickView samples{found, kind, {}}, before{raw, kind, {}};
        double worst = 0, without = 0;
        for (int n = 0; n < 500; ++n) {
            glm::dvec3 cells;
            for (int axis = 0; axis < 3; ++axis)
                cells[axis] = std::uniform_real_distribution<double>(2, inner - 3)(random);
            const double wanted = value(cells + double(reach));
            worst = std::max(worst, std::abs(*cubic(geometry, samples, cells).value() - wanted));
            without = std::max(without, std::abs(*cubic(geometry, before, cells + double(reach)).value() - wanted));
        }
        EXPECT_LT(worst, 5e-6) << kLatticeNames[int(kind)];
        EXPECT_GT(without, 1e-3) << "the kernel alone smooths";
    }
}

// Against the steps of the definition, sample by sample; absent samples count as the one beside which they are read.
TEST(Cubic, CoefficientsAreThoseOfTheSteps) {
    for (const LatticeKind kind : kCubicKinds)
        for (const bool masked : {false, true}) {
            const LevelGeometry geometry{kind, 1, 0};
            const int slices = kind == LatticeKind::BCC ? 2 : 1, reach = prefilterReach(Prefilter::Cubic, geometry);
            std::mt19937 random(7);
            BrickSamples raw = sampled(kind, 2 * reach + 3, [&](glm::dvec3) {
                return 353 + std::uniform_real_distribution<double>(0, 3)(random);
            });
            if (masked)
                for (std::size_t i = 0; i < raw.values.size(); ++i) raw.present.push_back(random() % 4 != 0);
            std::vector<double> now(raw.values.begin(), raw.values.end());
            for (const double factor : cubicSteps(geometry)) {
                std::vector<double> next = now;
                for (int z = 0; z < raw.size.z; ++z)
                    for (int y = 0; y < raw.size.y; ++y)
                        for (int x = 0; x < raw.size.x; ++x) {
                            const glm::ivec3 here(x, y, z), far(2, 2, 4), lo = glm::max(here - far, glm::ivec3(0)),
                                                                          hi = glm::min(here + far + 1, raw.size);
                            double smooth = 0, weights = 0;
                            for (int k = lo.z; k < hi.z; ++k)
                                for (int j = lo.y; j < hi.y; ++j)
                                    for (int i = lo.x; i < hi.x; ++i) {
                                        const glm::ivec3 there(i, j, k);
                                        const double weight = kernel(kind, placeOf(kind, there) - placeOf(kind, here));
                                        const bool is = raw.isPresent(at(raw, there));
                                        smooth += weight * now[at(raw, is ? there : here)];
                                        weights += weight;
                                    }
                            const std::size_t own = at(raw, here);
                            next[own] += factor * (double(raw.values[own]) - smooth - (1 - weights) * now[own]);
                        }
                now = next;
            }
            const BrickSamples found = cubicCoefficients(raw, geometry);
            ASSERT_EQ(found.present.empty(), !masked);
            for (int z = 0; z < found.size.z; ++z)
                for (int y = 0; y < found.size.y; ++y)
                    for (int x = 0; x < found.size.x; ++x) {
                        const std::size_t from = at(raw, glm::ivec3(x, y, z) + reach * glm::ivec3(1, 1, slices)),
                                          to = at(found, {x, y, z});
                        ASSERT_EQ(found.isPresent(to), raw.isPresent(from));
                        if (found.isPresent(to)) {
                            ASSERT_NEAR(double(found.values[to]), now[from], 2e-4)
                                << kLatticeNames[int(kind)] << (masked ? " masked" : "");
                        }
                    }
        }
}

// Room for filtered samples in textures: no samples within a range give coefficients further beyond it, and some come
// close.
TEST(Cubic, CoefficientsStayWithinTheOvershoot) {
    double most = 0;
    for (const LatticeKind kind : kCubicKinds) {
        const LevelGeometry geometry{kind, 1, 0};
        const int reach = prefilterReach(Prefilter::Cubic, geometry), edge = 4 * reach + 1;
        const double middle = 2 * reach + (kind == LatticeKind::BCC ? 0.5 : 0);
        const BrickSamples response = cubicCoefficients(
            sampled(kind, edge, [&](glm::dvec3 p) { return p == glm::dvec3(middle) ? 1 : 0; }), geometry);
        double sum = 0;
        for (const float value : response.values) sum += std::abs(double(value));
        const double beyond = (sum - 1) / 2;
        EXPECT_LE(beyond, prefilterOvershoot(Prefilter::Cubic));
        most = std::max(most, beyond);
    }
    EXPECT_GT(most, 0.9 * prefilterOvershoot(Prefilter::Cubic));
}

} // namespace
} // namespace tessera::volume
