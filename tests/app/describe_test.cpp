#include "app/session/picture_form.h"
#include "app/session/session_json.h"
#include "randomise.h"
#include "vis/transfer/transfer_recipe.h"
#include "volume/base/error.h"
#include "volume/bricks/brick_layout.h"
#include "volume/synthetic/branching.h"
#include "volume/synthetic/bubbles.h"
#include "volume/synthetic/casting.h"
#include "volume/synthetic/fuel_cell.h"
#include "volume/synthetic/marschner_lobb.h"
#include "volume/synthetic/membrane.h"

#include <cstdlib>
#include <cxxabi.h>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <memory>
#include <regex>
#include <set>
#include <typeinfo>

namespace tessera::app {
namespace {

const FieldInfo kWhole{"", ""};

/// One described struct; `name` as the compiler gives it.
struct DescribedStruct {
    std::string name;
    const ValueType* type = nullptr;
    std::shared_ptr<void> (*make)() = nullptr; ///< with its defaults
    bool (*equal)(const void* a, const void* b) = nullptr;
};
void PrintTo(const DescribedStruct& each, std::ostream* out) {
    *out << each.name;
}

template <Described T> DescribedStruct describedStruct(const std::string& name) {
    return {name, &valueType<T>(), [] { return std::shared_ptr<void>(std::make_shared<T>()); },
            [](const void* a, const void* b) { return *static_cast<const T*>(a) == *static_cast<const T*>(b); }};
}

/// "VolumeLayer", without its namespaces.
template <class T> std::string nameOf() {
    const std::unique_ptr<char, void (*)(void*)> text(abi::__cxa_demangle(typeid(T).name(), nullptr, nullptr, nullptr),
                                                      std::free);
    const std::string name = text.get();
    return name.substr(name.rfind(':') + 1);
}

/// Lists a described struct and all those inside of it: members, elements, alternatives.
struct Lister {
    std::map<std::string, DescribedStruct>& found;

    template <class T> void add() const {
        if constexpr (Described<T>) {
            const std::string name = nameOf<T>();
            if (!found.try_emplace(name, describedStruct<T>(name)).second) return;
            const T value{};
            T::describe(value, [&]<class Member>(const Member&, const FieldInfo&) { add<Member>(); });
        } else if constexpr (detail::IsVector<T>::value || detail::IsOptional<T>::value) {
            add<typename T::value_type>();
        } else if constexpr (detail::IsMap<T>::value) {
            add<typename T::mapped_type>();
        } else if constexpr (detail::IsVariant<T>::value) {
            [&]<class... Ts>(std::type_identity<std::variant<Ts...>>) { (add<Ts>(), ...); }(std::type_identity<T>{});
        }
    }
};

/// Every described struct that a file may hold: those of a session, of pictures, of archives and of built-in models.
std::vector<DescribedStruct> everyStruct() {
    std::map<std::string, DescribedStruct> found;
    const Lister list{found};
    list.add<Session>();
    list.add<ContourSettings>(); // without a section of its own in views of slices
    list.add<PictureForm>();
    list.add<vis::TransferRecipe>();
    list.add<volume::MergeOptions>();
    list.add<volume::FuelCellSettings>();
    list.add<volume::MarschnerLobbSettings>();
    list.add<volume::BubblesSettings>();
    list.add<volume::CastingSettings>();
    list.add<volume::BranchingSettings>();
    list.add<volume::MembraneSettings>();
    std::vector<DescribedStruct> all;
    for (const auto& [name, each] : found) all.push_back(each);
    return all;
}

class DescribeTest : public testing::TestWithParam<DescribedStruct> {
protected:
    std::shared_ptr<void> made() const { return GetParam().make(); }
    std::shared_ptr<void> randomised(std::mt19937& random) const {
        std::shared_ptr<void> value = made();
        Randomise{random}({GetParam().type, value.get()}, kWhole);
        return value;
    }
    Json json(const std::shared_ptr<void>& value) const {
        return detail::valueToJson({GetParam().type, value.get()}, kWhole);
    }
    std::vector<JsonIssue> read(const std::shared_ptr<void>& value, const Json& document) const {
        std::vector<JsonIssue> issues;
        detail::valueFromJson({GetParam().type, value.get()}, document, kWhole, issues, "");
        return issues;
    }
    bool equal(const std::shared_ptr<void>& a, const std::shared_ptr<void>& b) const {
        return GetParam().equal(a.get(), b.get());
    }
};

TEST_P(DescribeTest, RoundTripsRandomValues) {
    std::mt19937 random(7);
    for (int i = 0; i < 1000; ++i) {
        const auto value = randomised(random), back = made();
        const std::string text = printJson(json(value));
        const auto issues = read(back, parseJson(text, "test"));
        ASSERT_TRUE(issues.empty()) << issues.front().path << ": " << issues.front().reason << "\n" << text;
        ASSERT_TRUE(equal(back, value)) << text;
        ASSERT_EQ(printJson(json(back)), text);
    }
}

TEST_P(DescribeTest, DefaultsAreValidKeysUniqueAndDocumented) {
    const auto value = made();
    const auto issues = read(value, json(made()));
    EXPECT_TRUE(issues.empty()) << issues.front().path << ": " << issues.front().reason;
    std::set<std::string> keys;
    GetParam().type->visitMembers(value.get(), [&](Value, const FieldInfo& info) {
        EXPECT_TRUE(keys.insert(std::string(info.key)).second) << "key used twice: " << info.key;
        EXPECT_NE(info.key, "type") << "taken by variants";
        EXPECT_FALSE(info.doc.empty()) << info.key;
    });
}

TEST_P(DescribeTest, MissingKeysKeepTheValue) {
    std::mt19937 random(11), same(11);
    const auto value = randomised(random), back = randomised(same);
    EXPECT_TRUE(read(back, Json::object()).empty());
    EXPECT_TRUE(equal(back, value));
}

/// Every leaf in turn becomes an object nobody knows: an issue at its path, nothing thrown.
TEST_P(DescribeTest, WrongTypesAreReportedAndLeaveTheValue) {
    const Json document = json(made());
    for (const auto& [key, member] : document.items()) {
        Json broken = document;
        broken[key] = member.is_boolean() ? Json(3) : Json(true);
        const auto value = made();
        const auto issues = read(value, broken);
        ASSERT_EQ(issues.size(), 1u) << key;
        EXPECT_EQ(issues[0].path, "/" + key);
        EXPECT_FALSE(issues[0].unknownKey);
        EXPECT_TRUE(equal(value, made())) << key;
    }
}

INSTANTIATE_TEST_SUITE_P(EveryStruct, DescribeTest, testing::ValuesIn(everyStruct()),
                         [](const auto& each) { return each.param.name; });

TEST(DescribedStructs, AreAllOfTheHeaders) {
    namespace fs = std::filesystem;
    std::set<std::string> tested;
    for (const DescribedStruct& each : everyStruct()) tested.insert(each.name);
    const std::regex head("struct (\\w+) \\{");
    std::size_t described = 0;
    for (const char* room : {"volume", "codec", "vis", "app/session"})
        for (const auto& entry : fs::recursive_directory_iterator(fs::path(TESSERA_SOURCE_DIR) / room)) {
            if (entry.path().extension() != ".h") continue;
            std::ifstream in(entry.path());
            std::string last;
            for (std::string line; std::getline(in, line);) {
                std::smatch match;
                if (std::regex_search(line, match, head)) last = match[1];
                if (line.find("static void describe(auto") == std::string::npos || last.empty()) continue;
                ++described;
                EXPECT_TRUE(tested.contains(last)) << entry.path() << ": " << last << " is in no session or archive";
            }
        }
    EXPECT_GT(described, 60u);
}

TEST(DescribeJson, FloatsAreShort) {
    vis::IsoLayer layer;
    layer.opacity = 0.1f;
    EXPECT_EQ(toJson(layer)["opacity"].dump(), "0.1");
}

TEST(DescribeJson, ReportsPlaceAndReason) {
    Session session;
    session.layers.push_back({"a", true, vis::IsoLayer{}});
    Json document = toJson(session);
    document["layers"][0]["technique"]["opacity"] = 1.5;
    document["layers"][0]["technique"]["glow"] = 1;
    document["layers"][0]["visible"] = "yes";
    document["render"]["filter"] = "best";
    std::vector<JsonIssue> issues;
    Session back;
    fromJson(back, document, issues);
    ASSERT_EQ(issues.size(), 4u);
    EXPECT_EQ(issues[0].path, "/layers/0/visible");
    EXPECT_EQ(issues[1].path, "/layers/0/technique/opacity");
    EXPECT_EQ(issues[1].reason, "1.5 is not in 0 .. 1");
    EXPECT_EQ(issues[2].path, "/layers/0/technique/glow");
    EXPECT_TRUE(issues[2].unknownKey);
    EXPECT_EQ(issues[3].path, "/render/filter");
    EXPECT_EQ(back.layers[0].visible, true);
}

TEST(DescribeJson, UnknownVariantTypeNamesTheKnownOnes) {
    Json document = toJson(vis::Layer{});
    document["technique"]["type"] = "hologram";
    std::vector<JsonIssue> issues;
    vis::Layer layer;
    fromJson(layer, document, issues);
    ASSERT_EQ(issues.size(), 1u);
    EXPECT_EQ(issues[0].path, "/technique/type");
    EXPECT_EQ(issues[0].reason, "unknown type \"hologram\"; known are volume, iso, slice, flow, glyphs");
}

TEST(DescribeJson, BrokenTextSaysWhere) {
    try {
        parseJson("{\n  \"a\": 1,\n  \"b\" 2\n}", "x.json");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.file(), "x.json");
        EXPECT_EQ(error.place().substr(0, 6), "line 3");
    }
    EXPECT_THROW(parseJson(std::string(100000, '['), "deep.json"), Error);
    std::string deep;
    for (int i = 0; i < 1000; ++i) deep += "{\"children\":[";
    EXPECT_THROW(parseJson(deep, "deep.json"), Error);
}

} // namespace
} // namespace tessera::app
