// The layered cell of known integrals.
#include "volume/synthetic/membrane.h"

#include "volume/base/error.h"
#include "volume/synthetic/models.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace tessera::volume {
namespace {

constexpr double kArea = Membrane::kLengthX * Membrane::kLengthY;

struct LayerSums {
    double volume = 0, integral = 0;
};

/// LayerSums over the cells of a layer, in double.
template <class Value> LayerSums layerSums(const Membrane& cell, int layer, Value&& value) {
    const std::vector<double> x = cell.planesX(), z = cell.planesZ();
    const std::vector<int> layers = cell.layersZ();
    LayerSums sums;
    for (std::size_t k = 0; k < layers.size(); ++k)
        for (std::size_t i = 0; i + 1 < x.size() && layers[k] == layer; ++i) {
            const double height = z[k + 1] - z[k], volume = (x[i + 1] - x[i]) * height * Membrane::kLengthY;
            sums.volume += volume;
            sums.integral += volume * value((x[i] + x[i + 1]) / 2, z[k], height);
        }
    return sums;
}

void expectNear(double is, double wanted) {
    EXPECT_NEAR(is, wanted, 1e-12 * std::abs(wanted));
}

TEST(Membrane, VolumesAndIntegralsAreThoseOfTheFormulas) {
    for (const int nz : {16, 54, 61, 200}) {
        const MembraneSettings settings{.nx = 7, .ny = 3, .nz = nz};
        const Membrane cell(settings);
        ASSERT_EQ(cell.planesZ().size(), std::size_t(nz) + 1);
        ASSERT_EQ(cell.layersZ().size(), std::size_t(nz));
        double below = Membrane::kAirSide, phi = 0;
        for (int layer = 0; layer < 7; ++layer) {
            const Membrane::Layer& of = Membrane::kLayers[std::size_t(layer)];
            const double rise = settings.heatFlux * of.thickness / of.conductivity;
            const LayerSums T =
                layerSums(cell, layer, [&](double, double z, double h) { return cell.temperature(layer, z, h); });
            expectNear(T.volume, kArea * of.thickness);
            expectNear(T.integral, kArea * of.thickness * (below + rise / 2));
            below += rise;
            if (of.protons > 0) {
                const double step = settings.current * of.thickness / of.protons;
                const LayerSums of2 =
                    layerSums(cell, layer, [&](double, double z, double h) { return cell.potential(layer, z, h); });
                expectNear(of2.integral, kArea * of.thickness * (phi + step / 2));
                phi += step;
            } else {
                EXPECT_TRUE(std::isnan(cell.potential(layer, Membrane::begin(layer), 1e-6)));
            }
            if (of.speed != 0) {
                const LayerSums U =
                    layerSums(cell, layer, [&](double, double z, double h) { return cell.speed(layer, z, h); });
                expectNear(U.integral, kArea * of.thickness * of.speed);
            }
        }
        const LayerSums water = layerSums(cell, 3, [&](double, double z, double h) { return cell.water(3, z, h); });
        expectNear(water.integral, kArea * 25e-6 * 11);
        const LayerSums air = layerSums(cell, 0, [&](double x, double z, double h) { return cell.oxygen(0, x, z, h); });
        expectNear(air.integral, kArea * 1e-3 * Membrane::kOxygen * (1 - Membrane::kOxygenUsed / 2));
        const double flux = settings.current / (2 * Membrane::kFaraday); // of H2, to the membrane
        const LayerSums fuel =
            layerSums(cell, 5, [&](double x, double z, double h) { return cell.hydrogen(5, x, z, h); });
        expectNear(fuel.integral,
                   kArea * 200e-6 * (Membrane::kHydrogen * (1 - Membrane::kHydrogenUsed / 2) - flux * 100e-6 / 2e-5));
    }
}

TEST(Membrane, FluxesGoThroughAllLayers) {
    const MembraneSettings settings;
    const Membrane cell(settings);
    for (int layer = 0; layer < 7; ++layer) {
        const Membrane::Layer& of = Membrane::kLayers[std::size_t(layer)];
        const double lo = Membrane::begin(layer), hi = Membrane::begin(layer + 1), x = 0.01;
        const auto slope = [&](double at, double then) { return (then - at) / (hi - lo); };
        EXPECT_NEAR(of.conductivity * slope(cell.temperature(layer, lo, 0), cell.temperature(layer, hi, 0)),
                    settings.heatFlux, 1e-5 * settings.heatFlux);
        // Nothing jumps.
        EXPECT_NEAR(cell.temperature(std::max(0, layer - 1), lo, 0), cell.temperature(layer, lo, 0), 1e-10);
        if (layer == 1 || layer == 2) {
            EXPECT_NEAR(cell.oxygen(layer - 1, x, lo, 0), cell.oxygen(layer, x, lo, 0), 1e-12);
            EXPECT_NEAR(-of.diffusivity * slope(cell.oxygen(layer, x, lo, 0), cell.oxygen(layer, x, hi, 0)),
                        settings.current / (4 * Membrane::kFaraday), 1e-10);
        }
        if (layer == 4 || layer == 5) {
            EXPECT_NEAR(cell.hydrogen(layer, x, hi, 0), cell.hydrogen(layer + 1, x, hi, 0), 1e-12);
            EXPECT_NEAR(of.diffusivity * slope(cell.hydrogen(layer, x, lo, 0), cell.hydrogen(layer, x, hi, 0)),
                        settings.current / (2 * Membrane::kFaraday), 1e-10);
        }
    }
    for (const double x : {0.0, Membrane::kLengthX}) { // what reacts is there
        EXPECT_GT(cell.oxygen(2, x, Membrane::begin(3), 0), 1);
        EXPECT_GT(cell.hydrogen(4, x, Membrane::begin(4), 0), 1);
    }
}

TEST(Membrane, ADataSetHasTheseValuesAtItsCells) {
    const Dataset data = makeModel("membrane", {{"nx", 6}, {"ny", 4}, {"nz", 54}});
    const DatasetInfo& info = data.info;
    const Membrane cell({.nx = 6, .ny = 4, .nz = 54});
    ASSERT_TRUE(info.lattice.axes[0] && !info.lattice.axes[1] && info.lattice.axes[2]);
    EXPECT_EQ(info.lattice.size, glm::ivec3(6, 4, 54));
    EXPECT_EQ(info.lattice.axes[2]->of(), AxisMap::Of::Cells);
    EXPECT_EQ(info.lattice.axes[2]->planes(), cell.planesZ());
    EXPECT_NEAR(info.bounds.size().y, Membrane::kLengthY, 1e-18);
    EXPECT_NEAR(info.bounds.size().z, 2.445e-3, 1e-17);
    ASSERT_EQ(info.parameters.size(), 7u);
    EXPECT_EQ(info.parameters[0].labels[3].name, "membrane");
    const std::vector<int> layers = cell.layersZ();
    const std::vector<double> z = cell.planesZ();
    const Field region = data.read(0, 0, 0), T = data.read(1, 0, 0), O2 = data.read(2, 0, 0),
                water = data.read(4, 0, 0), U = data.read(6, 0, 0), across = data.read(6, 2, 0);
    for (int k = 0; k < 54; ++k) {
        const std::size_t at = info.lattice.index({5, 3, k});
        const int layer = layers[std::size_t(k)];
        const double begin = z[std::size_t(k)], height = z[std::size_t(k) + 1] - begin;
        EXPECT_EQ(region.value(at), layer + 1);
        EXPECT_EQ(T.value(at), double(float(cell.temperature(layer, begin, height))));
        EXPECT_EQ(water.present(at), layer == 3);
        EXPECT_EQ(O2.present(at), layer < 3);
        EXPECT_EQ(U.present(at), layer == 0 || layer == 6);
        if (U.present(at)) {
            EXPECT_EQ(U.value(at) > 0, layer == 0);
            EXPECT_EQ(across.value(at), 0);
        }
        if (O2.present(at)) {
            const double x = info.lattice.position({5, 3, k}).x;
            EXPECT_NEAR(O2.value(at), cell.oxygen(layer, x, begin, height), 1e-6);
        }
    }
    for (std::size_t p = 0; p < info.parameters.size(); ++p) {
        EXPECT_EQ(info.parameters[p].ranges.size(), info.parameters[p].components == 3 ? 4u : 1u);
        for (const Range& range : info.parameters[p].ranges) EXPECT_LE(range.lo, range.hi);
    }
}

TEST(Membrane, SettingsOutOfRangeAreRefused) {
    EXPECT_THROW(makeMembrane({{"nz", 15}}), Error);
    EXPECT_THROW(makeMembrane({{"heat", 1}}), Error);
    EXPECT_NO_THROW(makeMembrane({{"nx", 2}, {"ny", 2}, {"nz", 16}}));
}

} // namespace
} // namespace tessera::volume
