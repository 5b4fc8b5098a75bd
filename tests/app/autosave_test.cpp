#include "app/history/session_file.h"
#include "app/user_files/state_dir.h"
#include "tests/app/open_fixture.h"

#include <algorithm>
#include <sys/wait.h>

namespace tessera::app {
namespace {

namespace fs = std::filesystem;

class AutosaveTest : public OpenTest {
protected:
    std::vector<std::string> names() const {
        std::vector<std::string> all;
        for (const auto& entry : fs::directory_iterator(folder)) all.push_back(entry.path().filename().string());
        std::ranges::sort(all);
        return all;
    }
    std::string own(const std::string& ending = {}) const {
        return "autosave-" + std::to_string(getpid()) + ending + ".tessera.json";
    }
    /// Does something as a process that is killed then.
    template <class Act> static void inKilled(const Act& act) {
        const pid_t child = ::fork();
        if (child == 0) {
            act();
            ::kill(::getpid(), SIGKILL);
        }
        ::waitpid(child, nullptr, 0);
    }
};

// As of two containers with one home, whose processes have the same numbers.
TEST_F(AutosaveTest, RunsOfTheSameNumberDoNotTouchEachOther) {
    {
        Autosave first(folder.string()), second(folder.string());
        EXPECT_EQ(first.problem() + second.problem(), "");
        EXPECT_EQ(first.save("one") + second.save("two"), "");
        EXPECT_EQ(readText(in(own())), "one");
        EXPECT_EQ(readText(in(own("-1"))), "two");
        EXPECT_TRUE(first.abandoned().empty());
        EXPECT_TRUE(second.abandoned().empty());
        Autosave::discard({in(own()), ""});
        EXPECT_EQ(readText(in(own())), "one") << "it is in use";
        second.remove();
        EXPECT_EQ(readText(in(own())), "one");
    }
    EXPECT_TRUE(names().empty()) << names().front();
}

TEST_F(AutosaveTest, WhatAKilledRunLeftIsNeitherReplacedNorKeptForEver) {
    inKilled([&] {
        auto* const left = new Autosave(folder.string());
        (void)left->save("left");
    });
    ASSERT_EQ(names().size(), 2u);
    const std::string session = names()[0];
    fs::rename(folder / session, in(own())); // as if it had had the number of this run
    fs::remove(folder / names()[1]);
    Autosave now(folder.string());
    EXPECT_EQ(now.save("now"), "");
    EXPECT_EQ(readText(in(own())), "left");
    ASSERT_EQ(now.abandoned().size(), 1u);
    EXPECT_EQ(now.abandoned()[0].path, in(own()));
    Autosave::discard(now.abandoned()[0]);
    EXPECT_EQ(names(), (std::vector<std::string>{own("-1"), own("-1") + ".lock"}));
}

TEST_F(AutosaveTest, LocksThatWereLeftAreRemoved) {
    inKilled([&] { (void)new Autosave(folder.string()); }); // it saved nothing
    ASSERT_EQ(names().size(), 1u);
    Autosave now(folder.string());
    EXPECT_TRUE(now.abandoned().empty());
    EXPECT_EQ(names(), (std::vector<std::string>{own() + ".lock"}));
}

TEST_F(AutosaveTest, IsTakenUpAgainWhereSomebodyRemovedItsLock) {
    Autosave autosave(folder.string());
    EXPECT_EQ(autosave.save("one"), "");
    fs::remove(in(own() + ".lock"));
    EXPECT_EQ(autosave.save("two"), "");
    EXPECT_EQ(readText(in(own())), "one") << "others may have taken it for abandoned";
    EXPECT_EQ(readText(in(own("-1"))), "two");
}

TEST_F(AutosaveTest, SaysWhyItIsOff) {
    fs::create_directory(in(own() + ".lock")); // what is no file cannot be locked
    Autosave off(folder.string());
    EXPECT_NE(off.problem().find(own()), std::string::npos) << off.problem();
    EXPECT_EQ(off.save("text"), "");
    EXPECT_TRUE(off.abandoned().empty());
    EXPECT_EQ(names(), (std::vector<std::string>{own() + ".lock"}));
    EXPECT_EQ(Autosave("").problem(), "") << "nobody asked for one";
    EXPECT_NE(Autosave(in("missing")).problem(), "");
}

} // namespace
} // namespace tessera::app
