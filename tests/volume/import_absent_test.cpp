#include "volume/base/error.h"
#include "volume/import/absent.h"

#include <cmath>
#include <gtest/gtest.h>

namespace tessera::volume {
namespace {

/// 12 samples in a row: region 0 0 0 0 1 1 1 1 3 3 3 3; O2 lives in 1, T everywhere, U in 1 and 3, N has a NaN.
Dataset cell() {
    Dataset dataset;
    dataset.info.lattice.size = {12, 1, 1};
    dataset.info.times = {0, 1};
    dataset.info.parameters = {{"O2", "", 1, ScalarType::F32, false, {}, {}},
                               {"T", "", 1, ScalarType::F32, false, {}, {}},
                               {"U", "", 3, ScalarType::F32, false, {}, {}},
                               {"region", "", 1, ScalarType::U8, true, {{3, "fuel side"}}, {}},
                               {"N", "", 1, ScalarType::F32, false, {}, {}}};
    dataset.read = [lattice = dataset.info.lattice, parameters = dataset.info.parameters](int p, int c, int t) {
        Field field = makeField(lattice, parameters[std::size_t(p)].type);
        for (std::size_t i = 0; i < 12; ++i) {
            const int region = i < 4 ? 0 : i < 8 ? 1 : 3;
            if (p == 3)
                field.as<std::uint8_t>()[i] = std::uint8_t(region);
            else if (p == 0)
                field.as<float>()[i] = region == 1 ? 5.0f - float(t) : 0.0f;
            else if (p == 1)
                field.as<float>()[i] = 400.0f + float(i);
            else if (p == 2)
                field.as<float>()[i] = region != 0 && c == 0 ? float(i) : 0.0f;
            else
                field.as<float>()[i] = i == 5 ? std::nanf("") : float(i);
        }
        return field;
    };
    return dataset;
}

std::string presence(const Field& field) {
    std::string text;
    for (std::size_t i = 0; i < field.count(); ++i) text += field.present(i) ? '1' : '0';
    return text;
}

TEST(Absent, RulesAreRead) {
    EXPECT_EQ(parseAbsentRule("O2=region:0,3"), (AbsentRule{"O2", "region", {"0", "3"}, false}));
    EXPECT_EQ(parseAbsentRule("O2=-1e30"), (AbsentRule{"O2", "", {"-1e30"}, false}));
    EXPECT_EQ(parseAbsentRule("*=nan"), (AbsentRule{"*", "", {}, false}));
    EXPECT_TRUE(parseAbsentRule("O2=none").nothing);
    for (const char* text : {"O2=region:0,3", "p=0", "*=nan", "O2=none"})
        EXPECT_EQ(toText(parseAbsentRule(text)), text);
    for (const char* bad : {"", "O2", "=0", "O2=", "O2=x", "O2=:1", "O2=region:", "O2=1,,2", "O2=region:1,"})
        EXPECT_THROW(parseAbsentRule(bad), Error) << bad;
}

TEST(Absent, ByLabelValueNameAndNaN) {
    const auto with = [](const std::vector<std::string>& texts, int parameter) {
        std::vector<AbsentRule> rules;
        for (const std::string& text : texts) rules.push_back(parseAbsentRule(text));
        return presence(withAbsent(cell(), rules).read(parameter, 0, 0));
    };
    EXPECT_EQ(with({"O2=region:0,3"}, 0), "000011110000");
    EXPECT_EQ(with({"T=region:fuel side"}, 1), "111111110000");
    EXPECT_EQ(with({"O2=0"}, 0), "000011110000");
    EXPECT_EQ(with({"T=400,405"}, 1), "011110111111");
    EXPECT_EQ(with({}, 4), "111110111111");
    EXPECT_EQ(with({"*=region:1"}, 4), "111100001111");
    EXPECT_EQ(with({"*=region:1"}, 3), "111111111111"); // a label stays
    EXPECT_EQ(with({"U=0"}, 2), "000011111111");
    EXPECT_THROW(with({"X=0"}, 0), Error);
    EXPECT_THROW(with({"O2=material:0"}, 0), Error);
    EXPECT_THROW(with({"O2=region:air side"}, 0), Error);
}

TEST(Absent, EqualMasksAreOne) {
    const Dataset dataset = withAbsent(cell(), {parseAbsentRule("O2=region:0,3"), parseAbsentRule("T=region:0,3")});
    const Field a = dataset.read(0, 0, 0), b = dataset.read(1, 0, 0), c = dataset.read(0, 0, 1);
    EXPECT_EQ(a.mask, b.mask);
    EXPECT_EQ(a.mask, c.mask);
    EXPECT_EQ(withAbsent(cell(), {}).read(1, 0, 0).mask, nullptr);
}

TEST(Absent, ZerosOnWholeLabelsAreSuggested) {
    std::vector<std::string> texts;
    for (const AbsentRule& rule : suggestAbsentRules(cell())) texts.push_back(toText(rule));
    EXPECT_EQ(texts, (std::vector<std::string>{"O2=region:0,3", "U=region:0"}));
    Dataset zero = cell(); // a field that is 0 everywhere says nothing, nor one that is 0 only at some times
    zero.read = [inner = zero.read](int p, int c, int t) {
        Field field = inner(p, c, t);
        for (std::size_t i = 0; i < 12; ++i)
            if (p == 0 || (p == 2 && t == 0)) field.as<float>()[i] = p == 0 ? 0.0f : 1.0f;
        return field;
    };
    EXPECT_TRUE(suggestAbsentRules(zero).empty());
    Dataset holes = cell(); // what is not a number is as good as 0
    holes.read = [inner = holes.read](int p, int c, int t) {
        Field field = inner(p, c, t);
        for (std::size_t i = 0; i < 4; ++i)
            if (p == 0) field.as<float>()[i] = std::nanf("");
        return field;
    };
    EXPECT_EQ(toText(suggestAbsentRules(holes).at(0)), "O2=region:0,3");
}

TEST(Absent, LabelNames) {
    for (const char* name : {"region", "Region", "regionId", "material_id", "cellZone.id", "id", "mat", "Labels"})
        EXPECT_TRUE(isLabelName(name)) << name;
    for (const char* name : {"O2", "U", "pid", "fluid", "T", "identity", "kid"})
        EXPECT_FALSE(isLabelName(name)) << name;
    Dataset dataset = cell();
    dataset.info.parameters[3].labels.clear();
    findLabels(dataset);
    EXPECT_EQ(dataset.info.parameters[3].labels,
              (std::vector<Label>{{0, "region 0"}, {1, "region 1"}, {3, "region 3"}}));
}

} // namespace
} // namespace tessera::volume
