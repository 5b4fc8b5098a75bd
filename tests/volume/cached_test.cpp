#include "volume/base/cached.h"

#include <gtest/gtest.h>
#include <stdexcept>
#include <string>

namespace tessera::volume {
namespace {

struct Key {
    int number = 0;
    std::string name;
    bool operator==(const Key&) const = default;
};

TEST(Cached, MakesAValueOnceForAKey) {
    Cached<Key, std::string> cached;
    int made = 0;
    const auto make = [&](const Key& key) {
        ++made;
        return key.name + std::to_string(key.number);
    };
    EXPECT_EQ(cached.value(), "");
    EXPECT_EQ(cached.get({1, "a"}, make), "a1");
    EXPECT_EQ(cached.get({1, "a"}, make), "a1");
    EXPECT_EQ(made, 1);
    EXPECT_TRUE(cached.holds({1, "a"}));
    EXPECT_EQ(cached.get({1, "b"}, make), "b1") << "every member of the key counts";
    EXPECT_EQ(cached.get({2, "b"}, make), "b2");
    EXPECT_EQ(made, 3);
    cached.clear();
    EXPECT_EQ(cached.value(), "b2");
    EXPECT_EQ(cached.get({2, "b"}, make), "b2");
    EXPECT_EQ(made, 4);
}

TEST(Cached, HoldsNothingWhereMakingFailed) {
    Cached<Key, int> cached;
    EXPECT_EQ(cached.get({1, ""}, [](const Key&) { return 7; }), 7);
    EXPECT_THROW(cached.get({2, ""}, [](const Key&) -> int { throw std::runtime_error("no"); }), std::runtime_error);
    EXPECT_FALSE(cached.holds({1, ""}));
    EXPECT_FALSE(cached.holds({2, ""}));
    EXPECT_EQ(cached.get({2, ""}, [](const Key&) { return 8; }), 8);
}

} // namespace
} // namespace tessera::volume
