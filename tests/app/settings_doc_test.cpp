#include "app/session/describe_markdown.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>

// docs/settings.md is written by this test when TESSERA_UPDATE_DOCS is set, and compared otherwise.
TEST(ParameterReference, PageIsUpToDate) {
    const std::filesystem::path path = std::filesystem::path(TESSERA_SOURCE_DIR) / "docs/settings.md";
    const std::string wanted = tessera::app::parameterReference();
    if (std::getenv("TESSERA_UPDATE_DOCS") != nullptr) std::ofstream(path, std::ios::binary) << wanted;
    std::ifstream in(path, std::ios::binary);
    const std::string found{std::istreambuf_iterator<char>(in), {}};
    EXPECT_EQ(found, wanted) << "run app_tests with TESSERA_UPDATE_DOCS=1 and commit docs/settings.md";
}
