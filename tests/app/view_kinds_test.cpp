#include "app/session/session.h"

#include <gtest/gtest.h>
#include <set>

namespace tessera::app {
namespace {

TEST(ViewKinds, HaveNamesOfTheirOwnAndSayWhatTheyShow) {
    std::set<std::string_view> types, titles;
    forEachViewKind([&]<class Kind>(const Kind& kind) {
        EXPECT_TRUE(types.insert(Kind::State::kType).second) << Kind::State::kType;
        EXPECT_TRUE(titles.insert(kind.traits.title).second) << kind.traits.title;
        EXPECT_FALSE(kind.traits.help.empty()) << kind.traits.title;
        EXPECT_EQ(kind.preset.prepare == nullptr, kind.preset.title.empty());
        EXPECT_EQ(kind.preset.title.empty(), kind.preset.help.empty());
        EXPECT_TRUE(!kind.preset.prepare || titles.insert(kind.preset.title).second) << kind.preset.title;
    });
    EXPECT_EQ(types.size(), std::variant_size_v<ViewState>);
}

TEST(ViewKinds, AreFoundByNameAndByState) {
    forEachViewKind([]<class Kind>(const Kind& kind) {
        const std::optional<ViewState> view = viewOfKind(Kind::State::kType);
        ASSERT_TRUE(view);
        EXPECT_TRUE(std::holds_alternative<typename Kind::State>(*view));
        EXPECT_EQ(traitsOf(*view).title, kind.traits.title);
        if (!kind.preset.prepare) return;
        typename Kind::State changed;
        kind.preset.prepare(changed);
        EXPECT_FALSE(changed == typename Kind::State{}) << kind.preset.title;
    });
    EXPECT_FALSE(viewOfKind("hologram"));
}

} // namespace
} // namespace tessera::app
