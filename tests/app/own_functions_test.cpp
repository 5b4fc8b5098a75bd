#include "app/user_files/own_functions.h"
#include "tests/app/randomise.h"
#include "volume/base/error.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <unistd.h>

/// Transfer functions that the user saved.
namespace tessera::app {
namespace {

namespace fs = std::filesystem;

vis::TransferRecipe recipe(const std::string& name, float opacity = 1) {
    vis::TransferRecipe made;
    made.name = name;
    made.opacity = {{{.place = 0}, 0}, {{.place = 0.5, .share = 0.3, .hounsfield = 100}, opacity}};
    return made;
}

class OwnFunctionsTest : public testing::Test {
protected:
    void SetUp() override { fs::create_directories(folder); }
    void TearDown() override { fs::remove_all(folder); }
    std::string text(const std::string& of) const {
        std::ifstream file(of, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    void write(const std::string& words) const { std::ofstream(path, std::ios::binary) << words; }

    const std::string folder =
        (fs::path(testing::TempDir()) / ("own_functions_" + std::to_string(::getpid()))).string();
    const std::string path = folder + "/transfer-functions.json";
};

TEST_F(OwnFunctionsTest, AreSavedReplacedAndDeletedByName) {
    EXPECT_TRUE(loadOwnFunctions(folder).list.empty());
    EXPECT_TRUE(loadOwnFunctions("").list.empty());
    EXPECT_EQ(saveOwnFunction(folder, recipe("one")), "");
    saveOwnFunction(folder, recipe("two \"and\" µ"));
    saveOwnFunction(folder, recipe("one", 0.25f));
    const OwnFunctions known = loadOwnFunctions(folder);
    ASSERT_EQ(known.list.size(), 2u);
    EXPECT_EQ(known.list[0], recipe("one", 0.25f));
    EXPECT_EQ(known.list[1].name, "two \"and\" µ");
    EXPECT_TRUE(known.messages.empty());
    deleteOwnFunction(folder, "one");
    deleteOwnFunction(folder, "nobody");
    EXPECT_EQ(loadOwnFunctions(folder).list.size(), 1u);
    EXPECT_THROW(saveOwnFunction(folder, recipe("  ")), Error);
    EXPECT_THROW(saveOwnFunction("", recipe("one")), Error);
}

TEST_F(OwnFunctionsTest, ABrokenEntryIsSaidAndKept) {
    write(R"({"functions": [{"name": "bad", "opacity": 3}, )" + toJson(recipe("good")).dump() +
          R"(, {"name": "good", "opacity": []}, "what"]})");
    const OwnFunctions known = loadOwnFunctions(folder);
    ASSERT_EQ(known.list.size(), 1u);
    EXPECT_EQ(known.list[0], recipe("good"));
    ASSERT_EQ(known.messages.size(), 3u);
    EXPECT_NE(known.messages[0].find("/functions/0/opacity"), std::string::npos) << known.messages[0];
    saveOwnFunction(folder, recipe("new"));
    EXPECT_NE(text(path).find("\"bad\""), std::string::npos) << "written again";
    EXPECT_EQ(loadOwnFunctions(folder).list.size(), 2u);
    EXPECT_EQ(loadOwnFunctions(folder).unread.size(), 3u);
}

TEST_F(OwnFunctionsTest, ABrokenFileIsSetAside) {
    for (const char* words : {"", "{", "[]", R"({"functions": 3})"}) {
        write(words);
        EXPECT_THROW(loadOwnFunctions(folder), Error) << words;
        EXPECT_THROW(deleteOwnFunction(folder, "one"), Error);
        EXPECT_EQ(text(path), words) << "as it was";
        const std::string kept = saveOwnFunction(folder, recipe("one"));
        EXPECT_TRUE(kept.starts_with(path + ".broken")) << kept;
        EXPECT_EQ(text(kept), words);
        EXPECT_EQ(loadOwnFunctions(folder).list.size(), 1u);
    }
    EXPECT_TRUE(fs::exists(path + ".broken-4")) << "none replaces another";
}

TEST(OwnFunctions, ComeBackUnchangedFromTheirText) {
    std::mt19937 random(3);
    for (int round = 0; round < 300; ++round) {
        OwnFunctions some;
        vis::TransferRecipe made;
        valueOf(made).visitMembers(Randomise{random});
        made.name = "n" + std::to_string(round);
        made.opacity.push_back({});
        made.opacity.push_back({});
        std::ranges::stable_sort(made.opacity, {}, [](const auto& each) { return each.at.place; });
        std::ranges::stable_sort(made.colors, {}, [](const auto& each) { return each.at.place; });
        some.list = {made};
        const OwnFunctions read = parseOwnFunctions(printOwnFunctions(some), "test");
        ASSERT_EQ(read.list, some.list) << (read.messages.empty() ? "" : read.messages.front());
    }
}

} // namespace
} // namespace tessera::app
