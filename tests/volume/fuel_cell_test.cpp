#include "volume/synthetic/fuel_cell.h"

#include "volume/base/error.h"
#include "volume/synthetic/fuel_cell_properties.h"
#include "volume/synthetic/fuel_cell_solver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <string>
#include <tbb/global_control.h>
#include <unistd.h>
#include <utility>

namespace tessera::volume {
namespace {

using cell::FuelCellSolver;
using cell::GasSpace;

FuelCellSettings sized(int nx, int ny, int nz) {
    FuelCellSettings settings;
    settings.nx = nx, settings.ny = ny, settings.nz = nz;
    return settings;
}

/// Steady at the voltage after the load step, default grid; solved once for all tests.
const FuelCellSolver& loaded() {
    static const FuelCellSolver solver = [] {
        FuelCellSolver made((FuelCellSettings()));
        made.settle(made.settings().voltageAfter);
        return made;
    }();
    return solver;
}

/// Mean over the channel cells of a gas space at z.
double channelMean(const GasSpace& space, const std::vector<double>& values, int z) {
    const std::size_t section = space.kind.size();
    double sum = 0;
    int count = 0;
    for (std::size_t s = 0; s < section; ++s)
        if (space.kind[s] == 1) sum += values[s + section * std::size_t(z)], ++count;
    return sum / count;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
    double ma = 0, mb = 0, ab = 0, aa = 0, bb = 0;
    for (std::size_t i = 0; i < a.size(); ++i) ma += a[i] / double(a.size()), mb += b[i] / double(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        ab += (a[i] - ma) * (b[i] - mb);
        aa += (a[i] - ma) * (a[i] - ma), bb += (b[i] - mb) * (b[i] - mb);
    }
    return ab / std::sqrt(aa * bb);
}

TEST(FuelCell, GasesBalanceTheCurrent) {
    const FuelCellSolver& s = loaded();
    const double charge = s.totalCurrent() / cell::kFaraday; // mol/s of electrons
    const cell::Balance fuel = s.balance(0), air = s.balance(1);
    EXPECT_NEAR((air.reactantIn - air.reactantOut) / (charge / 4), 1, 1e-3);
    EXPECT_NEAR((fuel.reactantIn - fuel.reactantOut) / (charge / 2), 1, 1e-3);
    // Water: what leaves is what came and what was made, over both sides.
    EXPECT_NEAR((air.waterOut + fuel.waterOut - air.waterIn - fuel.waterIn) / (charge / 2), 1, 1e-3);
    EXPECT_GT(air.reactantOut, 0);
    EXPECT_GT(fuel.reactantOut, 0);
    EXPECT_GT(s.meanCurrent(), 1e3);
    EXPECT_LT(s.meanCurrent(), 2e4);
}

/// The layers are as thick as they are said to be, whatever the number of rows, and the integral of each is that of
/// its cells.
TEST(FuelCell, LayersHaveTheirOwnThickness) {
    for (const int ny : {7, 13, 20, 90}) {
        const Dataset data = makeFuelCell({{"nx", 11}, {"ny", ny}, {"nz", 4}, {"times", 1}});
        const Lattice& lattice = data.info.lattice;
        const Field region = data.read(6, 0, 0);
        std::array<double, 8> thickness{};
        const int x = 5; // through the channels
        for (int y = 0; y < ny; ++y)
            thickness[std::size_t(region.value(lattice.index({x, y, 0})))] +=
                lattice.lengthsAt(lattice.position({x, y, 0})).y;
        const auto expected = [&](CellRegion layer, double metres) {
            EXPECT_NEAR(thickness[std::size_t(layer)] / metres, 1, 1e-9) << ny << ", " << int(layer);
        };
        for (const CellRegion layer : {CellRegion::AnodeChannel, CellRegion::CathodeChannel}) expected(layer, 400e-6);
        for (const CellRegion layer : {CellRegion::AnodeGdl, CellRegion::CathodeGdl}) expected(layer, 200e-6);
        for (const CellRegion layer : {CellRegion::AnodeCatalyst, CellRegion::CathodeCatalyst}) expected(layer, 10e-6);
        expected(CellRegion::Membrane, 51e-6);
        EXPECT_NEAR(data.info.bounds.size().y, 1271e-6, 1e-12);
        EXPECT_NEAR(data.info.bounds.size().z, 40e-3, 1e-9) << "to the faces of the cells";
    }
}

/// The even cell is that of sessions and files made before the layers had cells of their own.
TEST(FuelCell, AnEvenCellHasNoAxesAndOneMembraneLayer) {
    const Dataset data = makeFuelCell({{"even", 1}, {"times", 1}});
    EXPECT_TRUE(data.info.lattice.axes.isEven());
    EXPECT_DOUBLE_EQ(data.info.lattice.spacing.y, 1e-4);
    FuelCellSettings settings;
    settings.even = true;
    FuelCellSolver s(settings);
    s.settle(0.55);
    EXPECT_NEAR(s.meanCurrent(), 9080, 20);
    const double charge = s.totalCurrent() / cell::kFaraday;
    const cell::Balance fuel = s.balance(0), air = s.balance(1);
    EXPECT_NEAR((air.reactantIn - air.reactantOut) / (charge / 4), 1, 1e-3);
    EXPECT_NEAR((fuel.reactantIn - fuel.reactantOut) / (charge / 2), 1, 1e-3);
}

TEST(FuelCell, BalanceHoldsWhileTheLoadChanges) {
    FuelCellSolver s(sized(7, 13, 40));
    s.settle(0.75);
    for (int step = 0; step < 3; ++step) {
        s.step(0.005, 0.55);
        const double charge = s.totalCurrent() / cell::kFaraday;
        const cell::Balance air = s.balance(1), fuel = s.balance(0);
        EXPECT_NEAR((air.reactantIn - air.reactantOut - air.reactantStored) / (charge / 4), 1, 0.01);
        EXPECT_NEAR((fuel.reactantIn - fuel.reactantOut - fuel.reactantStored) / (charge / 2), 1, 0.01);
        EXPECT_NEAR(air.waterIn + air.waterReleased - air.waterOut - air.waterStored, 0, 1e-3 * air.waterOut);
    }
}

TEST(FuelCell, GasesChangeAlongTheirOwnFlow) {
    const FuelCellSolver& s = loaded();
    const int nz = s.grid().nz;
    const std::size_t section = s.fuel().kind.size();
    double oxygen = 1e9, water = 0, hydrogen = 1e9;
    for (int z = 0; z < nz; ++z) {
        const double o = channelMean(s.air(), s.air().reactant, z), w = channelMean(s.air(), s.air().water, z);
        EXPECT_LT(o, oxygen) << z;
        EXPECT_GT(w, water) << z;
        oxygen = o, water = w;
        // The fuel dries on its way, so that its H2 is judged by what flows, from z = nz - 1 down.
        const int back = nz - 1 - z;
        double flow = back == 0 ? s.balance(0).reactantOut : 0.0;
        for (std::size_t p = 0; p < section && back > 0; ++p) {
            const std::size_t lower = p + section * std::size_t(back - 1);
            flow -= s.fuel().fluxZ[lower] * s.fuel().reactant[lower + section];
        }
        EXPECT_LT(flow, hydrogen) << back;
        hydrogen = flow;
    }
    EXPECT_LT(oxygen, 0.6 * s.air().inletReactant);
    EXPECT_LT(hydrogen, 0.6 * s.balance(0).reactantIn);
    // Counter-flow: the velocities point opposite ways.
    const int x = s.grid().nx / 2, z = nz / 2;
    EXPECT_GT(s.air().velocity(s.grid(), x, s.air().rows - 2, z)[2], 0.5);
    EXPECT_LT(s.fuel().velocity(s.grid(), x, 1, z)[2], -0.1);
}

TEST(FuelCell, VelocityIsFreeOfDivergence) {
    const FuelCellSolver& s = loaded();
    for (const GasSpace* space : {&s.fuel(), &s.air()}) {
        double inflow = 0, worst = 0;
        for (double flux : space->inlet) inflow += flux;
        for (int z = 0; z < s.grid().nz; ++z)
            for (int row = 0; row < space->rows; ++row)
                for (int x = 0; x < s.grid().nx; ++x)
                    worst = std::max(worst, std::abs(space->divergence(s.grid(), x, row, z)));
        EXPECT_LT(worst, 1e-8 * inflow);
        double ends = inflow;
        for (double flux : space->wall) ends += flux;
        for (double flux : space->outlet) ends -= flux;
        EXPECT_NEAR(ends / inflow, 0, 1e-6);
    }
}

TEST(FuelCell, PressureDropIsThatOfADuct) {
    // Nearly no current, so that the flow does not change along the duct. Shah and London (1978): f Re of a rectangle
    // of aspect 0.4 is 16.37 (Fanning); dp/dx = 2 f Re mu u / Dh^2.
    FuelCellSolver s(sized(44, 52, 8));
    s.settle(0.99);
    const GasSpace& air = s.air();
    double flow = 0;
    for (double flux : air.inlet) flow += flux;
    const double area = cell::kChannelWidth * cell::kChannelHeight;
    const double diameter = 2 * area / (cell::kChannelWidth + cell::kChannelHeight);
    const double gradient = 2 * 16.37 * cell::kViscosityAir * (flow / area) / (diameter * diameter);
    const double drop = channelMean(air, air.pressure, 2) - channelMean(air, air.pressure, 5);
    EXPECT_NEAR(drop / (3 * s.grid().dz) / gradient, 1, 0.03);
}

TEST(FuelCell, HottestWhereTheCurrentIs) {
    const FuelCellSolver& s = loaded();
    const cell::CellGrid& g = s.grid();
    const std::vector<double>& t = s.temperature();
    const auto at = [&](int x, int y, int z) { return t[std::size_t(x + g.nx * (y + g.ny * z))]; };
    std::vector<double> catalyst;
    for (int z = 0; z < g.nz; ++z) {
        for (int x = 0; x < g.nx; ++x) catalyst.push_back(at(x, g.rows[4], z));
        int hottest = 0;
        for (int y = 1; y < g.ny; ++y)
            if (at(g.nx / 2, y, z) > at(g.nx / 2, hottest, z)) hottest = y;
        EXPECT_EQ(g.region(g.nx / 2, hottest), CellRegion::CathodeCatalyst) << z;
    }
    EXPECT_GT(correlation(catalyst, s.current()), 0.8);
    const auto peak = std::size_t(std::max_element(t.begin(), t.end()) - t.begin());
    EXPECT_EQ(g.region(int(peak % std::size_t(g.nx)), int(peak / std::size_t(g.nx)) % g.ny),
              CellRegion::CathodeCatalyst);
    EXPECT_GT(t[peak], s.settings().coolantTemperature + 1);
    EXPECT_LT(t[peak], s.settings().coolantTemperature + 15);
}

TEST(FuelCell, OnePhaseAtTheDefaultSettings) {
    const FuelCellSolver& s = loaded();
    const cell::CellGrid& g = s.grid();
    double highest = 0;
    for (const GasSpace* space : {&s.fuel(), &s.air()})
        for (std::size_t p = 0; p < space->water.size(); ++p) {
            const std::size_t section = p % space->kind.size(), z = p / space->kind.size();
            const double temperature =
                s.temperature()[section + std::size_t(g.nx * space->yBegin) + std::size_t(g.nx * g.ny) * z];
            EXPECT_GE(space->water[p], 0);
            EXPECT_GE(space->reactant[p], 0);
            const double saturated = cell::saturationPressure(temperature);
            highest = std::max(highest, space->water[p] * cell::kGas * temperature / saturated);
        }
    EXPECT_LT(highest, 1);
    EXPECT_GT(highest, 0.5);
}

TEST(FuelCell, RefinementConverges) {
    std::array<double, 3> current{};
    for (int level : {0, 1, 2}) {
        FuelCellSolver s(sized(11 * (level + 1), 13 * (level + 1), 16 * (level + 1)));
        s.settle(0.55);
        current[std::size_t(level)] = s.meanCurrent();
    }
    const double coarse = std::abs(current[1] - current[0]), fine = std::abs(current[2] - current[1]);
    EXPECT_LT(fine, 0.4 * coarse);
    EXPECT_LT(fine, 0.005 * current[2]);
}

TEST(FuelCell, DragAndBackDiffusionMoveWater) {
    FuelCellSettings settings = sized(7, 13, 20);
    const auto gained = [&](double drag, double back) { // by the fuel from the membrane, mol/s
        settings.dragFactor = drag, settings.backDiffusionFactor = back;
        FuelCellSolver s(settings);
        s.settle(0.65);
        return s.balance(0).waterReleased;
    };
    EXPECT_EQ(gained(0, 0), 0);
    EXPECT_LT(gained(1, 0), 0);
    settings.fuelHumidity = 0.1, settings.airHumidity = 0.6;
    EXPECT_GT(gained(0, 1), 0);
}

TEST(FuelCell, LoadStepRaisesTheCurrent) {
    const Dataset data =
        makeFuelCell({{"nx", 7}, {"ny", 13}, {"nz", 20}, {"times", 12}, {"interval", 0.02}, {"stepTime", 0.1}});
    ASSERT_EQ(data.info.times.size(), 12u);
    EXPECT_DOUBLE_EQ(data.info.times[5], 0.1);
    const auto mean = [&](const char* name, int time) {
        int parameter = 0;
        while (data.info.parameters[std::size_t(parameter)].name != name) ++parameter;
        const Field field = data.read(parameter, 0, time);
        double sum = 0, count = 0;
        for (std::size_t i = 0; i < field.count(); ++i)
            if (field.present(i)) sum += field.value(i), ++count;
        return sum / count;
    };
    EXPECT_NEAR(mean("O2", 5), mean("O2", 0), 1e-3);
    EXPECT_LT(mean("O2", 11), 0.9 * mean("O2", 5));
    EXPECT_GT(mean("T", 6), mean("T", 5) + 0.01);
    EXPECT_GT(mean("T", 11), mean("T", 6) + 0.1);

    FuelCellSolver s(sized(7, 13, 20));
    s.settle(0.75);
    const double before = s.meanCurrent();
    s.step(0.02, 0.55);
    EXPECT_GT(s.meanCurrent(), 2 * before);
    // Any step is stable: a long one gives the steady state.
    FuelCellSolver steady = s;
    steady.settle(0.55);
    for (int i = 0; i < 5; ++i) s.step(1e4, 0.55);
    EXPECT_NEAR(s.meanCurrent() / steady.meanCurrent(), 1, 1e-3);
}

void expectMasks(int nx, int ny, int nz, bool even = false) {
    SCOPED_TRACE(nx);
    const Dataset data = makeFuelCell({{"nx", nx}, {"ny", ny}, {"nz", nz}, {"times", 2}, {"even", even}});
    const DatasetInfo& info = data.info;
    EXPECT_EQ(info.lattice.size, glm::ivec3(nx, ny, nz));
    const Field region = data.read(6, 0, 0);
    ASSERT_TRUE(info.parameters[6].categorical);
    std::vector<int> seen(even ? 6 : 8);
    EXPECT_EQ(info.parameters[6].labels.size(), seen.size());
    for (std::size_t i = 0; i < region.count(); ++i) ++seen.at(std::size_t(region.value(i)));
    for (int count : seen) EXPECT_GT(count, 0);
    for (int parameter = 0; parameter < 6; ++parameter) {
        const Parameter& described = info.parameters[std::size_t(parameter)];
        ASSERT_EQ(described.ranges.size(), described.components == 3 ? 4u : 1u);
        for (int part = 0; part < 2 * described.components; ++part) {
            const int component = part / 2;
            const Field field = data.read(parameter, component, part % 2);
            ASSERT_EQ(field.count(), region.count());
            const Range range = described.ranges[std::size_t(component)];
            int wrong = 0, outside = 0;
            for (std::size_t i = 0; i < field.count(); ++i) {
                const auto r = CellRegion(int(region.value(i)));
                const bool fuel =
                    r == CellRegion::AnodeChannel || r == CellRegion::AnodeGdl || r == CellRegion::AnodeCatalyst;
                const bool air =
                    r == CellRegion::CathodeChannel || r == CellRegion::CathodeGdl || r == CellRegion::CathodeCatalyst;
                const bool wanted = described.name == "T"    ? true
                                    : described.name == "O2" ? air
                                    : described.name == "H2" ? fuel
                                                             : fuel || air;
                wrong += field.present(i) != wanted;
                if (!field.present(i)) continue;
                outside += !(field.value(i) >= range.lo && field.value(i) <= range.hi);
                if (described.components == 1) outside += !(field.value(i) > 0);
            }
            EXPECT_EQ(wrong, 0) << described.name;
            EXPECT_EQ(outside, 0) << described.name;
        }
    }
    // Equal masks are one.
    EXPECT_EQ(data.read(2, 0, 0).mask, data.read(5, 1, 1).mask);
    EXPECT_EQ(data.read(4, 0, 0).mask, nullptr);
}

TEST(FuelCell, GasesAreAbsentWhereTheyCannotBe) {
    expectMasks(11, 13, 9);
    expectMasks(3, 7, 4);
    expectMasks(3, 5, 4, true);
    expectMasks(17, 31, 5);
    expectMasks(17, 31, 5, true);
    expectMasks(60, 70, 7);
    EXPECT_THROW(makeFuelCell({{"ny", 6}, {"times", 1}}), Error) << "fewer rows than layers";
}

TEST(FuelCell, RefinedFramesAgreeWithSolvedOnes) {
    // 88 columns are interpolated from 44: every field must stay close to the same field on half the columns.
    const Dataset fine = makeFuelCell({{"nx", 88}, {"ny", 13}, {"nz", 6}, {"times", 1}});
    const Dataset coarse = makeFuelCell({{"nx", 44}, {"ny", 13}, {"nz", 6}, {"times", 1}});
    for (int parameter : {0, 1, 2, 4}) {
        const Field a = fine.read(parameter, 0, 0), b = coarse.read(parameter, 0, 0);
        const Range range = coarse.info.parameters[std::size_t(parameter)].ranges[0];
        for (int z = 0; z < 6; ++z)
            for (int y = 0; y < 13; ++y)
                for (int x = 0; x < 44; ++x) {
                    const std::size_t to = b.lattice.index({x, y, z}), from = a.lattice.index({2 * x, y, z});
                    ASSERT_EQ(b.present(to), a.present(from));
                    if (!b.present(to)) continue;
                    ASSERT_NEAR(0.5 * (a.value(from) + a.value(from + 1)), b.value(to), 0.02 * (range.hi - range.lo));
                }
    }
}

TEST(FuelCell, SameOnAnyNumberOfThreads) {
    const auto all = [](int threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
        const Dataset data = makeFuelCell({{"nx", 9}, {"ny", 13}, {"nz", 33}, {"times", 8}});
        std::vector<std::byte> bytes;
        for (int parameter = 0; parameter < 6; ++parameter) {
            const Field field = data.read(parameter, 0, 7);
            bytes.insert(bytes.end(), field.samples.begin(), field.samples.end());
        }
        return bytes;
    };
    const auto one = all(1);
    EXPECT_EQ(one, all(2));
    EXPECT_EQ(one, all(5));
}

TEST(FuelCell, SettingsAreChecked) {
    const auto message = [](const std::map<std::string, double>& settings) {
        try {
            fuelCellSettings(settings);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(message({{"volts", 1}}).find("volts"), std::string::npos);
    EXPECT_NE(message({{"nx", 251}}).find("nx"), std::string::npos);
    EXPECT_NE(message({{"nz", 10.5}}).find("whole"), std::string::npos);
    EXPECT_NE(message({{"times", 0}}).find("times"), std::string::npos);
    EXPECT_NE(message({{"voltageAfter", std::nan("")}}).find("voltageAfter"), std::string::npos);
    EXPECT_EQ(message({{"nx", 250}, {"ny", 250}, {"nz", 1000}, {"voltageAfter", 0.6}}), "");
    EXPECT_EQ(fuelCellSettings({{"nz", 77}, {"airHumidity", 0.5}}).nz, 77);
}

TEST(FuelCell, StarvedCellsAreRefused) {
    // Hydrogen for 0.1 A/cm2 at a voltage that wants ten times as much.
    const std::map<std::string, double> settings{{"nx", 5},
                                                 {"ny", 13},
                                                 {"nz", 16},
                                                 {"times", 6},
                                                 {"interval", 0.05},
                                                 {"stepTime", 0},
                                                 {"ratedCurrent", 1000},
                                                 {"hydrogenStoichiometry", 1.2},
                                                 {"airStoichiometry", 20},
                                                 {"voltageAfter", 0.4}};
    try {
        const Dataset data = makeFuelCell(settings);
        for (std::size_t gas : {0u, 1u, 2u}) EXPECT_GE(data.info.parameters[gas].ranges[0].lo, -1e-6);
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("feed more gas"), std::string::npos);
    }
}

TEST(FuelCell, CanBeStopped) {
    std::stop_source source;
    Progress progress;
    progress.stop = source.get_token();
    progress.report = [&](double fraction, const std::string&) {
        if (fraction > 0.4) source.request_stop();
    };
    EXPECT_THROW(makeFuelCell({{"nx", 5}, {"ny", 7}, {"nz", 8}}, progress), Cancelled);
}

/// The default cell comes from what was solved by an earlier start of the program; any setting solves it.
TEST(FuelCell, AKeptSolutionIsTheSolvedOne) {
    const std::string home = ::testing::TempDir() + "tessera_kept_cell_" + std::to_string(::getpid());
    const char* const before = std::getenv("XDG_CACHE_HOME");
    const std::string restored = before ? before : "";
    ::setenv("XDG_CACHE_HOME", home.c_str(), 1);
    int reports = 0;
    const Progress counted{[&](double, const std::string& what) { reports += what == "load step" ? 1 : 0; }, {}};
    const Dataset first = makeFuelCell({}, counted);
    EXPECT_GT(std::exchange(reports, 0), 0);
    const Dataset again = makeFuelCell({}, counted), solved = makeFuelCell({{"times", 24}});
    EXPECT_EQ(reports, 0) << "it is solved again";
    for (const Dataset* other : {&again, &solved}) {
        EXPECT_EQ(other->info, first.info);
        for (const int time : {0, 5, 23})
            for (int parameter = 0; parameter < int(first.info.parameters.size()); ++parameter)
                for (int c = 0; c < first.info.parameters[std::size_t(parameter)].components; ++c) {
                    const Field one = first.read(parameter, c, time), two = other->read(parameter, c, time);
                    EXPECT_TRUE(one.samples == two.samples) << parameter << " " << c << " " << time;
                }
    }
    std::filesystem::remove_all(home);
    before ? ::setenv("XDG_CACHE_HOME", restored.c_str(), 1) : ::unsetenv("XDG_CACHE_HOME");
}

TEST(FuelCellProperties, AgreeWithTheirSources) {
    EXPECT_NEAR(cell::saturationPressure(353.15), 47.4e3, 500); // steam tables
    EXPECT_NEAR(cell::waterContent(1), 14.0, 0.05);             // Springer et al. 1991
    EXPECT_NEAR(cell::protonConductivity(14, 303), 6.87, 0.05); // S/m, the same
    EXPECT_NEAR(cell::reversibleVoltage(298.15, 101325, 101325), 1.229, 1e-9);
    EXPECT_NEAR(cell::fibreDiffusibility(1, false), 1, 1e-12);
    for (double a : {0.1, 0.5, 0.9, 1.5}) {
        const double slope = (cell::waterContent(a + 1e-6) - cell::waterContent(a - 1e-6)) / 2e-6;
        EXPECT_NEAR(cell::waterContentSlope(a), slope, 1e-4);
    }
    // The current falls with the voltage and never passes the limit of diffusion.
    double last = 1e9;
    for (double voltage = 0.2; voltage < 1.1; voltage += 0.05) {
        const double i = cell::localCurrent(voltage, 353.15, 25, 4, 0.1, 2e-5);
        EXPECT_LT(i, last);
        EXPECT_LT(i, 4 * cell::kFaraday * 0.1 * 4);
        last = i;
    }
    EXPECT_LT(cell::localCurrent(1.3, 353.15, 25, 4, 0.1, 2e-5), 1e-3);
}

} // namespace
} // namespace tessera::volume
