#include <cstdlib>
#include <gtest/gtest.h>

namespace {

/// New textures and buffers hold NaN in every test, so that texels are noticed which are read and which nobody wrote:
/// a software renderer happens to hold zeros there.
class NanTextures final : public testing::Environment {
public:
    void SetUp() override { ::setenv("TESSERA_DEBUG_GL", "nan", 0); }
};

const testing::Environment* const kNanTextures = testing::AddGlobalTestEnvironment(new NanTextures);

} // namespace
