#include "volume/base/unit_product.h"

#include "volume/base/unit_conversion.h"

#include <gtest/gtest.h>
#include <vector>

namespace tessera::volume {
namespace {

struct Case {
    std::vector<UnitPower> factors;
    double factor;
    std::string unit;
};

TEST(UnitProduct, CancelsAndConverts) {
    const Case cases[] = {
        {{{"mol/m3", 1}, {"m/s", 1}, {"m", 2}}, 1, "mol/s"},
        {{{"mol/m3", 1}, {"m/s", 1}, {"mm", 2}}, 1e-6, "mol/s"},
        {{{"mol/m^3", 1}, {"m", 2}}, 1, "mol/m"},
        {{{"mol m-3", 1}, {"cm s^-1", 1}, {"um", 2}}, 1e-14, "mol/s"},
        {{{"mol/m\u00b3", 1}, {"m", 3}}, 1, "mol"},
        {{{"mol/l", 1}, {"m", 3}}, 1, "mol m3/l"},
        {{{"Pa", 1}, {"m/s", 1}, {"m", 2}}, 1, "Pa m3/s"},
        {{{"kg/(m s2)", 1}, {"m", 1}}, 1, "kg/s2"},
        {{{"kg/m/s\u00b2", 1}}, 1, "kg/(m s2)"},
        {{{"W\u00b7m", 1}}, 1, "W m"},
        {{{"1/s", 1}}, 1, "1/s"},
        {{{"kg/h", 1}, {"min", 1}}, 1.0 / 60, "kg"},
        {{{"\u00b5m", 1}}, 1e-6, "m"},
        {{{"", 1}, {"m/s", 1}, {"m", 2}}, 1, "m3/s"},
        {{{"K", 1}, {"K", -1}}, 1, ""},
        {{{"?3/", 1}, {"m", 1}}, 1, "?3/ m"}, // what cannot be read stays one name
        {{{"degC", 1}}, 1, "degC"},
        {{{"%", 1}, {"m", 2}}, 1, "% m2"},
    };
    for (const Case& test : cases) {
        const ComposedUnit unit = composedUnit(test.factors);
        EXPECT_EQ(unit.unit, test.unit) << test.factors.front().unit;
        EXPECT_NEAR(unit.factor, test.factor, 1e-12 * test.factor) << test.factors.front().unit;
    }
}

TEST(UnitConversion, ConvertsWhatMeasuresTheSame) {
    struct Pair {
        const char *from, *to;
        double factor, offset;
    };
    const Pair pairs[] = {{"bar", "Pa", 1e5, 0},
                          {"kPa", "Pa", 1e3, 0},
                          {"Pa", "kg/(m s2)", 1, 0},
                          {"mbar", "hPa", 1, 0},
                          {"atm", "Pa", 101325, 0},
                          {"degC", "K", 1, 273.15},
                          {"\u00b0C", "degF", 1.8, 32},
                          {"C", "K", 1, 273.15},
                          {"W/m2", "mW/cm2", 0.1, 0},
                          {"A/cm2", "A/m2", 1e4, 0},
                          {"kJ/(kg K)", "J/kg/K", 1e3, 0},
                          {"km/h", "m/s", 1 / 3.6, 0},
                          {"mol/l", "mol/m3", 1e3, 0},
                          {"g/mol", "kg/kmol", 1, 0},
                          {"S/cm", "S/m", 100, 0},
                          {"V", "W/A", 1, 0},
                          {"%", "1", 0.01, 0},
                          {"px/s", "px/ms", 1e-3, 0},
                          {"", "", 1, 0},
                          {"any thing//", "any thing//", 1, 0}};
    for (const Pair& pair : pairs) {
        const auto made = unitConversion(pair.from, pair.to);
        ASSERT_TRUE(made) << pair.from << " " << pair.to;
        EXPECT_NEAR(made->factor, pair.factor, 1e-12 * pair.factor) << pair.from << " " << pair.to;
        EXPECT_NEAR(made->offset, pair.offset, 1e-9) << pair.from << " " << pair.to;
        const auto back = unitConversion(pair.to, pair.from);
        ASSERT_TRUE(back);
        EXPECT_NEAR((*back)((*made)(17)), 17, 1e-9);
    }
    const std::pair<const char*, const char*> apart[] = {{"K", "Pa"}, {"mol/m3", "kg/m3"}, {"", "K"},    {"m", "m2"},
                                                         {"px", "m"}, {"W/K", "W/degC"},   {"a//b", "m"}};
    for (const auto& [from, to] : apart) EXPECT_FALSE(unitConversion(from, to)) << from << " " << to;
}

} // namespace
} // namespace tessera::volume
