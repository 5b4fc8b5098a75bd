// Curves over time against sums over the samples and numbers read from the files here.
#include "volume/analysis/curves.h"

#include "volume/base/error.h"
#include "volume/derived/formula_unit.h"
#include "volume/field/quantities.h"
#include "volume/import/foreign.h"
#include "volume/import/import.h"
#include "volume/sources/axis_source.h"
#include "volume/sources/memory_source.h"
#include "volume/synthetic/models.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <regex>

namespace tessera::volume {
namespace {

namespace fs = std::filesystem;

/// Sums over the samples of one parameter, those `inside` says.
struct Sums {
    double count = 0, all = 0, squares = 0, volume = 0, integral = 0;
    double least = std::numeric_limits<double>::infinity(), most = -std::numeric_limits<double>::infinity();
    double mean() const { return integral / volume; }
};

Sums sumsOf(const Dataset& dataset, int parameter, int time, const std::function<bool(std::size_t)>& inside) {
    const Field field = dataset.read(parameter, 0, time);
    const Lattice& lattice = dataset.info.lattice;
    Sums sums;
    for (int z = 0; z < lattice.size.z; ++z)
        for (int y = 0; y < lattice.size.y; ++y)
            for (int x = 0; x < lattice.size.x; ++x) {
                const std::size_t i = lattice.index({x, y, z});
                if (!field.present(i)) continue;
                ++sums.all;
                if (!inside(i)) continue;
                const double value = double(float(field.value(i)));
                double cell = 1; // half of it lies outside at the faces
                for (int a = 0; a < 3; ++a) {
                    const int at = a == 0 ? x : a == 1 ? y : z;
                    cell *= lattice.spacing[a] * (at == 0 || at == lattice.size[a] - 1 ? 0.5 : 1);
                }
                ++sums.count;
                sums.volume += cell;
                sums.integral += cell * value;
                sums.squares += cell * value * value;
                sums.least = std::min(sums.least, value);
                sums.most = std::max(sums.most, value);
            }
    return sums;
}

int numberOfParameter(const DatasetInfo& info, const std::string& name) {
    return info.channel(*info.findChannel(name)).parameter;
}

/// Compares every statistic with the sums, everywhere and in one region; integrals with `inUnit` times theirs.
void expectStatistics(const Dataset& dataset, const std::string& parameter, const std::string& label, int value,
                      double inUnit = 1) {
    const auto source = makeMemorySource(dataset, {.lattice = LatticeKind::CC, .brickSize = 8});
    CurvesQuery query;
    for (const char* kind : {"mean", "min", "max", "deviation", "share", "volume", "integral"})
        query.y.push_back(std::string(kind) + "(" + parameter + ")");
    for (const bool region : {false, true}) {
        if (region) {
            query.label = *dataset.info.findChannel(label);
            query.regions = {value};
        }
        const Curves curves = computeCurves(*source, query);
        EXPECT_EQ(curves.times, dataset.info.times);
        EXPECT_EQ(curves.x.values, dataset.info.times);
        for (std::size_t t = 0; t < dataset.info.times.size(); ++t) {
            const Field labels = dataset.read(numberOfParameter(dataset.info, label), 0, int(t));
            const Sums sums = sumsOf(dataset, numberOfParameter(dataset.info, parameter), int(t), [&](std::size_t i) {
                return !region || (labels.present(i) && labels.value(i) == value);
            });
            ASSERT_GT(sums.count, 20);
            if (region) {
                ASSERT_LT(sums.count, sums.all);
            }
            const double spread = sums.most - sums.least;
            EXPECT_NEAR(curves.y[0].values[t], sums.mean(), 1e-5 * spread + 1e-9);
            EXPECT_EQ(curves.y[1].values[t], sums.least);
            EXPECT_EQ(curves.y[2].values[t], sums.most);
            EXPECT_NEAR(curves.y[3].values[t], std::sqrt(sums.squares / sums.volume - sums.mean() * sums.mean()),
                        1e-3 * spread);
            EXPECT_NEAR(curves.y[4].values[t], sums.count / sums.all, 1e-3);
            EXPECT_NEAR(curves.y[5].values[t], sums.volume, 2e-3 * sums.volume);
            EXPECT_NEAR(curves.y[6].values[t], inUnit * sums.integral, 2e-3 * std::abs(inUnit * sums.integral));
        }
    }
}

TEST(Curves, StatisticsOfTheBuiltInCellAreSumsOverItsSamples) {
    Dataset cell = makeModel("fuel-cell", {{"nx", 9}, {"ny", 13}, {"nz", 21}, {"times", 3}, {"even", 1}});
    std::string label;
    for (const Parameter& parameter : cell.info.parameters)
        if (parameter.categorical) label = parameter.name;
    ASSERT_FALSE(label.empty());
    const int value = cell.info.parameters[std::size_t(numberOfParameter(cell.info, label))].labels.at(0).value;
    expectStatistics(cell, "T", label, value);
}

TEST(Curves, IntegralsAreInAUnitThatIsTheirs) {
    Dataset dataset;
    dataset.info.lattice = {LatticeKind::CC, {9, 7, 5}, {0.5, 1, 2}, {0, 0, 0}};
    dataset.info.bounds = {glm::dvec3(0), glm::dvec3(4, 6, 8)};
    dataset.info.times = {0, 1};
    dataset.info.lengthUnit = "mm";
    dataset.info.parameters = {{"O2", "mol/m3", 1, ScalarType::F32, false, {}, {{0, 100}}},
                               {"region", "", 1, ScalarType::U8, true, {{0, "a"}, {1, "b"}}, {{0, 1}}}};
    dataset.read = [lattice = dataset.info.lattice](int parameter, int, int time) {
        Field field = makeField(lattice, parameter == 0 ? ScalarType::F32 : ScalarType::U8);
        for (std::size_t i = 0; i < field.count(); ++i) {
            if (parameter == 1)
                field.as<std::uint8_t>()[i] = std::uint8_t(i % 9 > 3 ? 1 : 0);
            else
                field.as<float>()[i] = float(5 + (i * 37 + std::size_t(time)) % 41);
        }
        return field;
    };
    expectStatistics(dataset, "O2", "region", 1, 1e-9);
    CurvesQuery query;
    query.y = {"integral(O2)",
               "integral(O2)/volume(O2)",
               "volume(O2)",
               "integral(O2) / volume(O2) - mean(O2)",
               "2 * max(integral(O2)/volume(O2), mean(O2))",
               "volume(O2)^2/volume(O2) > volume(O2) * 0.999 ? 1 : 0"};
    const Curves curves = computeCurves(*makeMemorySource(dataset, {.lattice = LatticeKind::CC}), query);
    EXPECT_EQ(curves.y[0].unit, "mol");
    const double ratio = curves.y[0].values[1] / (1e-9 * curves.y[2].values[1]); // mol by m3, not by mm3
    EXPECT_EQ(curves.y[1].unit, "mol/m3");
    EXPECT_NEAR(curves.y[1].values[1], ratio, 1e-9 * ratio);
    EXPECT_GT(ratio, 5);
    EXPECT_LT(ratio, 46) << "within the range of O2";
    EXPECT_EQ(curves.y[2].unit, "mm3") << "alone it stays in the unit of the data";
    EXPECT_EQ(curves.y[3].unit, "mol/m3");
    EXPECT_LT(std::abs(curves.y[3].values[1]), 0.1 * ratio);
    EXPECT_EQ(curves.y[4].unit, "mol/m3");
    EXPECT_GT(curves.y[4].values[1], 2 * 0.9 * ratio);
    EXPECT_LT(curves.y[4].values[1], 2 * 1.1 * ratio);
    EXPECT_EQ(curves.y[5].values[1], 1) << "m3 are compared with mm3";
    dataset.info.lengthUnit.clear();
    const Curves unstated = computeCurves(*makeMemorySource(dataset, {.lattice = LatticeKind::CC}), query);
    EXPECT_EQ(unstated.y[0].unit, "mol length3/m3") << "no unit of length is made up";
    dataset.info.lengthUnit = "mm";
    // A degree of interest of one half everywhere is half of it.
    CurvesQuery half = query;
    half.doi = [](std::span<const float>, glm::dvec3) { return 0.5; };
    const Curves halved = computeCurves(*makeMemorySource(dataset, {.lattice = LatticeKind::CC}), half);
    EXPECT_NEAR(halved.y[0].values[1], curves.y[0].values[1] / 2, 1e-9 * curves.y[0].values[1]);
}

TEST(Curves, UnitsAreCarriedOrRefused) {
    const std::vector<std::string> names = {"a", "b", "c", "d", "T"};
    const std::vector<std::string> units = {"mm", "m", "mol/l", "", "degC"}; // d: not known
    const std::vector<double> values = {5, 2, 3, 7, 20};
    const auto carried = [&](const std::string& formula) {
        const Expression expression(formula, names);
        std::vector<std::optional<std::string>> own;
        std::vector<std::vector<double>> inputs;
        for (const int name : expression.used()) {
            const std::string& unit = units[std::size_t(name)];
            own.push_back(unit.empty() ? std::nullopt : std::optional(unit));
            inputs.push_back({values[std::size_t(name)]});
        }
        const CarriedUnits all = carriedUnits(expression, own);
        std::vector<double> out(1);
        all.expression.evaluate(inputs, out);
        return std::pair(out[0], all.unit);
    };
    struct Case {
        const char* formula;
        double value;
        const char* unit;
    };
    for (const Case& each : {Case{"a", 5, "mm"},
                             {"2*a - 1", 9, "mm"},
                             {"a + b", 2005, "mm"},
                             {"b + a", 2.005, "m"},
                             {"b - a*2 - a", 1.985, "m"},
                             {"a/b", 2.5e-3, ""},
                             {"b/a/a*1", 2 / 25e-6, "1/m"},
                             {"b/a^2", 2 / 25e-6, "1/m"},
                             {"(a*b)^2", 1e-4, "m4"},
                             {"-a*-b", 1e-2, "m2"},
                             {"max(b, a, 1.5)", 2, "m"},
                             {"a < b ? a : b", 5, "mm"},
                             {"a > b ? 1 : 0", 0, ""},
                             {"a > 1 && b < a ? 1 : 2", 2, ""},
                             {"1 + a/b", 1.0025, ""},
                             {"T", 20, "degC"},
                             {"a*d", 35, ""},
                             {"sqrt(a*b)", 0.1, ""}}) {
        const auto [value, unit] = carried(each.formula);
        EXPECT_NEAR(value, each.value, 1e-12 * std::abs(each.value)) << each.formula;
        EXPECT_EQ(unit, each.unit) << each.formula;
    }
    for (const char* formula : {"a + c", "1 + (b*a - b)", "b > c ? 1 : 0", "max(a, c)", "a > 1 ? a : T"})
        EXPECT_THROW(carried(formula), Error) << formula;
    try {
        carried("a + c");
    } catch (const Error& error) {
        EXPECT_EQ(error.reason(), "mm and mol/l cannot be added");
    }
}

/// Three times of one scalar, with quantities.
Dataset small() {
    Dataset dataset;
    dataset.info.lattice.size = {2, 2, 2};
    dataset.info.bounds = {glm::dvec3(0), glm::dvec3(1)};
    dataset.info.times = {1, 2, 4};
    dataset.info.timeName = "operating point";
    dataset.info.timeUnit = "";
    dataset.info.parameters = {{"T", "K", 1, ScalarType::F32, false, {}, {{0, 10}}}};
    dataset.info.quantities = {
        {"cell voltage", "V", {0.7, 0.5, 0.6}}, {"j", "A/m2", {1000, 5000, std::nan("")}}, {"falling", "", {9, 8, 2}}};
    dataset.read = [lattice = dataset.info.lattice](int, int, int time) {
        Field field = makeField(lattice, ScalarType::F32);
        for (std::size_t i = 0; i < field.count(); ++i) field.as<float>()[i] = float(time + 1) * float(i);
        return field;
    };
    return dataset;
}

TEST(Curves, QuantitiesAndFormulasOfThemRunOverEachOther) {
    const auto source = makeMemorySource(small(), {.lattice = LatticeKind::CC});
    CurvesQuery query;
    query.x = "j";
    query.y = {"cell voltage", "`cell voltage` * j", "mean(T) - min(T) + `operating point`", "max(T)", "j / falling"};
    const Curves curves = computeCurves(*source, query);
    EXPECT_EQ(curves.x.name, "j");
    EXPECT_EQ(curves.x.unit, "A/m2");
    EXPECT_EQ(curves.y[0].values, (std::vector<double>{0.7, 0.5, 0.6}));
    EXPECT_EQ(curves.y[0].unit, "V");
    EXPECT_DOUBLE_EQ(curves.y[1].values[0], 700);
    EXPECT_DOUBLE_EQ(curves.y[1].values[1], 2500);
    EXPECT_TRUE(std::isnan(curves.y[1].values[2]));
    EXPECT_EQ(curves.y[1].unit, "W/m2");
    for (int t = 0; t < 3; ++t) {
        EXPECT_NEAR(curves.y[2].values[std::size_t(t)], 3.5 * (t + 1) + source->info().times[std::size_t(t)], 1e-6);
        EXPECT_EQ(curves.y[3].values[std::size_t(t)], 7 * (t + 1));
    }
    EXPECT_EQ(curves.y[2].unit, "");
    EXPECT_EQ(curves.y[3].unit, "K");
    EXPECT_EQ(curves.y[4].unit, ""); // one has no unit: none is invented
    const auto rows = curveRows(curves);
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[1], (std::vector<double>{2, 5000, 0.5, 2500, 9, 14, 625}));
    query.x = "time"; // another word for the axis
    EXPECT_EQ(computeCurves(*source, query).x.values, source->info().times);
    const auto problem = [&](const std::string& formula) -> std::string {
        query.y = {formula};
        try {
            computeCurves(*source, query);
        } catch (const Error& error) {
            return error.reason();
        }
        return "";
    };
    EXPECT_EQ(problem("mean(nothing)"), "no parameter is named \"nothing\"");
    EXPECT_EQ(problem("mean(T"), "a closing parenthesis is missing");
    EXPECT_EQ(problem("T"), "\"T\" has more than one value here: write mean(T), for example");
    EXPECT_EQ(cellQuantities(source->info()).voltage, "cell voltage");
    EXPECT_EQ(cellQuantities(source->info()).current, "j");
}

TEST(Curves, CountSamplesByTheirDegreeOfInterest) {
    const auto source = makeMemorySource(small(), {.lattice = LatticeKind::CC});
    CurvesQuery query;
    query.y = {"share(T)", "mean(T)", "min(T)"};
    query.doiChannels = {0};
    query.doi = [](std::span<const float> values, glm::dvec3 place) {
        return values[0] > 5 && place.z > 0.5 ? 1.0 : 0.0;
    };
    const Curves curves = computeCurves(*source, query);
    // Samples 4..7 lie at z = 1; their values are (t + 1) i.
    EXPECT_NEAR(curves.y[0].values[0], 2 / 8.0, 1e-3); // 6, 7
    EXPECT_NEAR(curves.y[0].values[1], 4 / 8.0, 1e-3);
    EXPECT_NEAR(curves.y[1].values[0], 6.5, 1e-3);
    EXPECT_EQ(curves.y[2].values[1], 8);
}

TEST(Curves, ThePolarisationCurveOfTheSharedCellIsThatOfItsFiles) {
    const char* named = std::getenv("TESSERA_DATA");
    const fs::path folder = fs::path(named != nullptr ? named : TESSERA_TEST_DATA) / "fuel-cell/grid";
    if (!fs::exists(folder / "small.pvd") || findImporter().empty())
        GTEST_SKIP() << "no fuel cell or no tessera-import";
    Dataset cell = openFiles({(folder / "small.pvd").string()}, {});
    scanRanges(cell);
    const CellQuantities quantities = cellQuantities(cell.info);
    EXPECT_EQ(quantities.voltage, "voltage");
    EXPECT_EQ(quantities.current, "current_density");
    CurvesQuery query;
    query.x = quantities.current;
    query.y = {quantities.voltage, "voltage*current_density"};
    const Curves curves = computeCurves(*makeMemorySource(cell, {.lattice = LatticeKind::CC}), query);
    for (std::size_t t = 0; t < 26; ++t) {
        char name[32];
        std::snprintf(name, sizeof name, "small_%04ld.vti", std::lround(1000 * cell.info.times[t]));
        std::ifstream in(folder / name, std::ios::binary);
        const std::string head = std::string(std::istreambuf_iterator<char>(in), {}).substr(0, 2000);
        const auto value = [&head](const std::string& quantity) {
            std::smatch found;
            EXPECT_TRUE(std::regex_search(
                head, found, std::regex("Name=\"" + quantity + "\" NumberOfTuples=\"1\"[^>]*RangeMin=\"([^\" ]+)")));
            return std::stod(found[1]);
        };
        EXPECT_NEAR(curves.x.values[t], value("current_density"), 1e-3);
        EXPECT_NEAR(curves.y[0].values[t], value("voltage"), 1e-12);
        EXPECT_NEAR(curves.y[1].values[t], value("voltage") * value("current_density"), 1e-3);
    }
    // The steps of the voltage: 0.70, 0.50, 0.60, 0.40 V.
    EXPECT_EQ(curves.y[0].values.front(), 0.7);
    EXPECT_EQ(curves.y[0].values.back(), 0.4);
    cell.info.times.resize(3);
    for (Quantity& quantity : cell.info.quantities) quantity.values.resize(3);
    expectStatistics(cell, "T", "region", 1);
}

TEST(AxisBy, AQuantityThatRisesOrFallsTakesThePlaceOfTheTimes) {
    const DatasetInfo info = small().info;
    EXPECT_FALSE(axisBy(info, "cell voltage")); // up and down
    EXPECT_FALSE(axisBy(info, "j"));            // not known at every time
    EXPECT_FALSE(axisBy(info, "none"));
    const auto falling = axisBy(info, "falling");
    ASSERT_TRUE(falling);
    EXPECT_EQ(falling->info.times, (std::vector<double>{2, 8, 9}));
    EXPECT_EQ(falling->info.timeName, "falling");
    EXPECT_EQ(falling->order, (std::vector<int>{2, 1, 0}));
    EXPECT_EQ(falling->info.quantities[0].values, (std::vector<double>{0.6, 0.5, 0.7}));
    EXPECT_EQ(falling->info.quantities[2], (Quantity{"operating point", "", {4, 2, 1}}));
    const auto source = onAxis(makeMemorySource(small(), {.lattice = LatticeKind::CC}), *falling);
    const Dataset dataset = onAxis(small(), *falling);
    for (int t = 0; t < 3; ++t) {
        EXPECT_EQ(source->read({0, t, 0, {0, 0, 0}}).values[1], float(3 - t));
        EXPECT_EQ(dataset.read(0, 0, t).value(1), 3 - t);
        EXPECT_EQ(source->stats({0, t, 0, {0, 0, 0}}).max, float(7 * (3 - t)));
    }
    // And back again.
    const auto back = axisBy(falling->info, "operating point");
    ASSERT_TRUE(back);
    EXPECT_EQ(back->info.times, info.times);
    EXPECT_EQ(back->order, (std::vector<int>{2, 1, 0}));
}

} // namespace
} // namespace tessera::volume
