#include "tests/codec/make_dataset.h"
#include "volume/base/error.h"
#include "volume/system/free_memory.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace tessera::volume {
namespace {

/// What the system says, in a folder.
class MadeSystem {
public:
    MadeSystem() { put("processes/meminfo", "MemTotal: 16000 kB\nMemFree: 1000 kB\nMemAvailable:    8000 kB\n"); }
    void put(const std::string& path, const std::string& text) const {
        const std::filesystem::path file = std::filesystem::path(folder_ / path);
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file) << text;
    }
    SystemFiles files() const { return {folder_ / "processes", folder_ / "groups"}; }

private:
    codec::testing::TemporaryFolder folder_;
};

TEST(MachineMemory, WithoutControlGroupsIsThatOfTheMachine) {
    const MadeSystem made;
    EXPECT_EQ(machineMemory(made.files()), 16000u * 1024);
    EXPECT_EQ(availableMemory(made.files()), 8000 * 1024);
}

TEST(MachineMemory, IsWhatTheControlGroupsAllow) {
    const MadeSystem made; // version 2: nested, the outer one is narrower
    made.put("processes/self/cgroup", "0::/users/job 7\n");
    made.put("groups/users/job 7/memory.max", "max\n");
    made.put("groups/users/memory.max", "5000000\n");
    made.put("groups/users/memory.current", "3000000\n");
    made.put("groups/users/memory.stat", "anon 1\ninactive_file 700000\nactive_file 300000\n");
    EXPECT_EQ(machineMemory(made.files()), 5000000u);
    EXPECT_EQ(availableMemory(made.files()), 3000000);
}

TEST(MachineMemory, IsWhatControlGroupsOfTheFirstVersionAllow) {
    const MadeSystem made;
    made.put("processes/self/cgroup", "5:cpu,cpuacct:/a\n4:memory:/batch\n0::/\n");
    made.put("groups/memory/batch/memory.limit_in_bytes", "6000000\n");
    made.put("groups/memory/batch/memory.usage_in_bytes", "7000000\n");
    made.put("groups/memory/batch/memory.stat", "inactive_file 9\ntotal_inactive_file 0\ntotal_active_file 0\n");
    made.put("groups/memory/memory.limit_in_bytes", "9223372036854771712\n");
    EXPECT_EQ(machineMemory(made.files()), 6000000u);
    EXPECT_EQ(availableMemory(made.files()), 0);
}

TEST(MachineMemory, WhatIsNotThereIsRefusedBeforeItIsTaken) {
    EXPECT_NO_THROW(requireMemory(1e6));
    EXPECT_THROW(requireMemory(1e17), MachineError);
    std::vector<std::byte> bytes;
    EXPECT_THROW(reserveLarge(bytes, std::size_t(1) << 50), MachineError);
}

} // namespace
} // namespace tessera::volume
