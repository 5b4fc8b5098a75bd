// The table of kinds: one field by the writers of many formats (tests/import/generate_kinds.py, kinds/kinds.json).
#include "tests/import/opened_case.h"

#include <nlohmann/json.hpp>

namespace tessera::volume {
namespace {

using nlohmann::json;

std::string kindsFile(const std::string& name) {
    return std::string(TESSERA_SOURCE_DIR) + "/tests/import/kinds/" + name;
}

json kinds() {
    std::ifstream in(kindsFile("kinds.json"));
    return json::parse(in);
}

class Kinds : public Cases {};

std::string parameterOf(const json& row, const OpenedCase& opened) {
    return row["parameter"].is_string() ? row["parameter"].get<std::string>() : opened.info().parameters.front().name;
}

TEST_F(Kinds, EachRowIsReadAsItsIndependentReaderReadsIt) {
    int rows = 0;
    for (const json& row : kinds()) {
        const auto file = row["file"].get<std::string>();
        SCOPED_TRACE(file + " by " + row["reader"].get<std::string>());
        ++rows;
        try {
            const OpenedCase opened = openCases({kindsFile(file)});
            const DatasetInfo& info = opened.info();
            for (int axis = 0; axis < 3; ++axis) {
                const auto a = std::size_t(axis);
                EXPECT_EQ(info.lattice.size[axis], row["dims"][a].get<int>());
                EXPECT_NEAR(info.lattice.spacing[axis], row["spacing"][a].get<double>(), 1e-6);
                EXPECT_NEAR(info.lattice.origin[axis], row["origin"][a].get<double>(), 1e-6);
            }
            EXPECT_EQ(info.lengthUnit, row["lengthUnit"].get<std::string>());
            if (!row["times"].empty()) {
                EXPECT_EQ(info.times, row["times"].get<std::vector<double>>());
                EXPECT_EQ(info.timeUnit, row["timeUnit"].get<std::string>());
            }
            const std::string name = parameterOf(row, opened);
            EXPECT_EQ(info.lattice.count() - opened.present(name), row["absent"].get<std::size_t>());
            for (const json& sample : row["samples"]) {
                const glm::ivec3 place(sample[0].get<int>(), sample[1].get<int>(), sample[2].get<int>());
                const double value = opened.at(name, place, sample[3].get<int>());
                if (sample[4].is_null())
                    EXPECT_TRUE(std::isnan(value)) << sample << " is " << value;
                else
                    EXPECT_NEAR(value, sample[4].get<double>(), row["tolerance"].get<double>()) << sample;
            }
        } catch (const Error& error) {
            ADD_FAILURE() << error.what();
        }
    }
    EXPECT_GT(rows, 20);
}

TEST_F(Kinds, TheSameFieldIsTheSameDataSet) {
    std::vector<double> wanted;
    int compared = 0;
    for (const json& row : kinds()) {
        if (!row["sameField"].get<bool>()) continue;
        const auto file = row["file"].get<std::string>();
        SCOPED_TRACE(file);
        try {
            const OpenedCase opened = openCases({kindsFile(file)});
            const Field field = opened.field(parameterOf(row, opened));
            std::vector<double> values;
            for (std::size_t i = 0; i < field.count(); ++i) values.push_back(field.present(i) ? field.value(i) : -1);
            if (wanted.empty()) wanted = values;
            EXPECT_EQ(values, wanted);
            EXPECT_EQ(std::ranges::count(values, -1), 1);
            ++compared;
        } catch (const Error& error) {
            ADD_FAILURE() << error.what();
        }
    }
    EXPECT_GE(compared, 10);
}

} // namespace
} // namespace tessera::volume
