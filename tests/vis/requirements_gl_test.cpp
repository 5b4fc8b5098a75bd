#include "vis/gl/headless.h"
#include "vis/gl/requirements.h"
#include "volume/base/error.h"

#include <cstdlib>
#include <epoxy/gl.h>
#include <gtest/gtest.h>
#include <string_view>

namespace tessera {
namespace {

TEST(Requirements, NothingIsMissingHere) {
    const vis::HeadlessContext context;
    EXPECT_EQ(vis::missingFeatures(), "");
}

// Mesa can pretend to be an older driver, if it has not been looked at yet in this process.
TEST(Requirements, AnOldDriverIsToldWhatItLacks) {
    GTEST_FLAG_SET(death_test_style, "threadsafe"); // runs in a process of its own
    EXPECT_EXIT(
        {
            setenv("MESA_GL_VERSION_OVERRIDE", "4.1", 1);
            setenv("MESA_EXTENSION_OVERRIDE", "-GL_ARB_direct_state_access -GL_ARB_copy_image", 1);
            try {
                const vis::HeadlessContext context;
                const auto* version = reinterpret_cast<const char*>(glGetString(GL_VERSION));
                if (std::string_view(version).find("Mesa") == std::string_view::npos)
                    std::fprintf(stderr, "not a driver of Mesa");
            } catch (const MachineError& error) {
                std::fprintf(stderr, "%s\n", error.what());
            }
            std::exit(0);
        },
        ::testing::ExitedWithCode(0), "OpenGL 4.1, 4.5 is needed; it lacks.*direct state access|not a driver of Mesa");
}

} // namespace
} // namespace tessera
