// More names of files than a command line has room for.
#include "tests/import/foreign_files.h"

#include <sys/resource.h>

namespace tessera::volume {
namespace {

class ManyFiles : public ForeignFiles {};

TEST_F(ManyFiles, NamesNeedNoRoomOnACommandLine) {
    constexpr int kSlices = 900;
    std::string around; // so that few files have long names: the system allows 4096 bytes each, and 2 MiB for all
    for (int n = 0; n < 1900; ++n) around += "./";
    std::vector<std::string> paths;
    std::size_t bytes = 0;
    for (int n = 0; n < kSlices; ++n) {
        const std::string name = "s_" + std::to_string(1000 + n) + ".pgm";
        write(name, "P5\n2 2\n255\n" + std::string(4, char(n % 251)));
        paths.push_back(folder_.string() + "/" + around + name);
        bytes += paths.back().size() + 1;
    }
    rlimit stack{};
    ASSERT_EQ(getrlimit(RLIMIT_STACK, &stack), 0);
    if (stack.rlim_cur == RLIM_INFINITY || bytes <= stack.rlim_cur / 4) GTEST_SKIP() << "a command line may be longer";
    const Dataset data = openFiles(paths, {});
    EXPECT_EQ(data.info.lattice.size, glm::ivec3(2, 2, kSlices));
    const Field field = data.read(0, 0, 0);
    for (int n = 0; n < kSlices; ++n) ASSERT_EQ(field.value(std::size_t(4 * n)), n % 251);
}

} // namespace
} // namespace tessera::volume
