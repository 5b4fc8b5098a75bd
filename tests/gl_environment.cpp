#include <cstdlib>
#include <gtest/gtest.h>

namespace {

/// What tests that draw find set, unless they are run with something else.
class GlEnvironment final : public testing::Environment {
public:
    void SetUp() override {
        // New textures and buffers hold NaN, so that texels are noticed which are read and which nobody wrote: a
        // software renderer happens to hold zeros there.
        ::setenv("TESSERA_DEBUG_GL", "nan", 0);
        // Mesa's software GL optimises no machine code: compiling takes longer than drawing small pictures.
        ::setenv("GALLIVM_PERF", "nopt", 0);
        // Nor does it use vectors of more than 16 bytes, which compile in four fifths of the time that wider ones take.
        ::setenv("LP_NATIVE_VECTOR_WIDTH", "128", 0);
    }
};

const testing::Environment* const kGlEnvironment = testing::AddGlobalTestEnvironment(new GlEnvironment);

} // namespace
