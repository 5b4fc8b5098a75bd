#include "app/workbench/idle_moment.h"

#include <gtest/gtest.h>

namespace tessera::app {
namespace {

TEST(IdleMoment, ComesAfterWorkAndNotTooOften) {
    IdleMoment moment;
    EXPECT_FALSE(moment.due(false, 0)) << "nothing was done";
    EXPECT_FALSE(moment.due(true, 1));
    EXPECT_TRUE(moment.due(false, 2));
    EXPECT_FALSE(moment.due(false, 100)) << "once for each stretch of work";
    EXPECT_FALSE(moment.due(true, 101));
    EXPECT_TRUE(moment.due(false, 102));
    EXPECT_FALSE(moment.due(true, 103));
    EXPECT_FALSE(moment.due(false, 104)) << "too soon";
    EXPECT_TRUE(moment.due(false, 125)) << "the work is not forgotten";
}

} // namespace
} // namespace tessera::app
