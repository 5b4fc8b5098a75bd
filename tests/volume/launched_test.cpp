#include "volume/system/launched.h"

#include <cstdlib>
#include <gtest/gtest.h>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tessera {
namespace {

/// Variables of the environment that are as they were afterwards.
class Variables {
public:
    explicit Variables(const std::vector<std::pair<const char*, const char*>>& values) {
        for (const char* name : {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_LOCAL_SIZE",
                                 "PMIX_NAMESPACE", "PMI_RANK", "PMI_SIZE", "MPI_LOCALNRANKS", "PMI_JOBID",
                                 "SLURM_PROCID", "SLURM_NTASKS", "SLURM_STEP_NUM_TASKS", "SLURM_STEP_TASKS_PER_NODE",
                                 "SLURM_STEP_ID", "SLURM_JOB_ID", "SLURM_RESTART_COUNT"}) {
            const char* const before = std::getenv(name);
            before_.emplace_back(name, before != nullptr ? std::optional<std::string>(before) : std::nullopt);
            ::unsetenv(name);
        }
        for (const auto& [name, value] : values) ::setenv(name, value, 1);
    }
    ~Variables() {
        for (const auto& [name, value] : before_) {
            if (value)
                ::setenv(name, value->c_str(), 1);
            else
                ::unsetenv(name);
        }
    }
    Variables(const Variables&) = delete;
    Variables& operator=(const Variables&) = delete;

private:
    std::vector<std::pair<const char*, std::optional<std::string>>> before_;
};

TEST(Launched, EachLauncherSaysRankAndNumber) {
    {
        const Variables none({});
        EXPECT_EQ(launched(), Launched());
    }
    {
        const Variables openMpi({{"OMPI_COMM_WORLD_RANK", "2"},
                                 {"OMPI_COMM_WORLD_SIZE", "8"},
                                 {"OMPI_COMM_WORLD_LOCAL_SIZE", "4"},
                                 {"PMIX_NAMESPACE", "prterun-node@1/x"}});
        EXPECT_EQ(launched(), (Launched{2, 8, 4, "prterun-node@1x-"}));
    }
    {
        const Variables mpich({{"PMI_RANK", "0"}, {"PMI_SIZE", "3"}, {"MPI_LOCALNRANKS", "3"}});
        EXPECT_EQ(launched(), (Launched{0, 3, 3, "-"}));
    }
    {
        const Variables both({{"PMI_RANK", "1"}, {"PMI_SIZE", "4"}, {"SLURM_STEP_TASKS_PER_NODE", "2(x2)"}});
        EXPECT_EQ(launched(), (Launched{1, 4, 2, "-"}));
    }
    {
        const Variables slurm({{"SLURM_PROCID", "5"},
                               {"SLURM_STEP_NUM_TASKS", "6"},
                               {"SLURM_STEP_TASKS_PER_NODE", "3(x2)"},
                               {"SLURM_STEP_ID", "1"},
                               {"SLURM_JOB_ID", "77"}});
        EXPECT_EQ(launched(), (Launched{5, 6, 3, "1-77"}));
    }
    {
        const Variables requeued({{"SLURM_PROCID", "0"},
                                  {"SLURM_STEP_NUM_TASKS", "2"},
                                  {"SLURM_STEP_TASKS_PER_NODE", "2"},
                                  {"SLURM_STEP_ID", "0"},
                                  {"SLURM_JOB_ID", "77"},
                                  {"SLURM_RESTART_COUNT", "1"}});
        EXPECT_EQ(launched(), (Launched{0, 2, 2, "0-77-1"}));
    }
}

TEST(Launched, OneProcessOfABatchScriptIsAlone) {
    const Variables batch({{"SLURM_PROCID", "0"}, {"SLURM_NTASKS", "64"}, {"SLURM_JOB_ID", "77"}});
    EXPECT_EQ(launched(), Launched());
}

TEST(Launched, NumbersThatMakeNoSenseAreIgnored) {
    for (const auto& [rank, count] : {std::pair("x", "4"), {"4", "4"}, {"-1", "4"}, {"0", "0"}, {"", ""}}) {
        const Variables wrong({{"OMPI_COMM_WORLD_RANK", rank}, {"OMPI_COMM_WORLD_SIZE", count}});
        EXPECT_EQ(launched(), Launched()) << rank << " of " << count;
    }
}

} // namespace
} // namespace tessera
