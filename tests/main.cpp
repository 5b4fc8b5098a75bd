#include "volume/system/free_memory.h"

#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <string>
#include <unistd.h>

namespace {

namespace fs = std::filesystem;

/// What the program remembers for its user (units, names, recent files) is not carried from one test to another: every
/// run of a test program has a home of its own.
class OwnHome final : public testing::Environment {
public:
    void SetUp() override {
        fs::create_directories(home_);
        for (const char* name : {"XDG_CONFIG_HOME", "XDG_STATE_HOME", "XDG_DATA_HOME"})
            ::setenv(name, (home_ / name).c_str(), 1);
    }
    void TearDown() override {
        std::error_code ignored;
        fs::remove_all(home_, ignored);
    }

private:
    fs::path home_ = fs::path(testing::TempDir()) / ("tessera_home_" + std::to_string(::getpid()));
};

} // namespace

/// Ends with $TESSERA_SKIPPED where that is set, all passed, and some were skipped; else with 0 or 1 as GoogleTest
/// does.
int main(int argc, char** argv) {
    tessera::volume::keepFreeMemory(); // as the program does
    testing::InitGoogleTest(&argc, argv);
    testing::AddGlobalTestEnvironment(new OwnHome);
    const int status = RUN_ALL_TESTS();
    const char* skipped = std::getenv("TESSERA_SKIPPED");
    return status == 0 && skipped && testing::UnitTest::GetInstance()->skipped_test_count() > 0 ? std::atoi(skipped)
                                                                                                : status;
}
