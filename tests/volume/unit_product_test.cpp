#include "volume/analysis/unit_product.h"

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

} // namespace
} // namespace tessera::volume
