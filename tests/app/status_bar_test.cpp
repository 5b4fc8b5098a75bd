#include "app/workbench/status_bar.h"

#include <gtest/gtest.h>

namespace tessera::app {
namespace {

TEST(StatusBar, SaysWhatCastsRays) {
    EXPECT_EQ(engineText({.byProcessor = true, .instructions = "AVX2", .refusal = {}}),
              "   rays by the processor (AVX2)");
    EXPECT_EQ(engineText({.byProcessor = false, .instructions = {}, .refusal = "brushes"}),
              "   rays by OpenGL: the processor cannot draw brushes");
    EXPECT_EQ(engineText({}), "");
}

} // namespace
} // namespace tessera::app
