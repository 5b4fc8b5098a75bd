#include "volume/system/launched.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <string_view>

namespace tessera {

namespace {

std::string_view textOf(const char* variable) {
    const char* const text = std::getenv(variable);
    return text != nullptr ? text : "";
}

/// The number that a variable begins with; Slurm writes "4(x2)" for four processes on each of two machines.
std::optional<int> numberOf(const char* variable) {
    const std::string_view text = textOf(variable);
    int number = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (problem != std::errc() || end == text.data()) return std::nullopt;
    return number;
}

struct Variables {
    const char *rank, *count, *onThisMachine, *job;
};

constexpr Variables kLaunchers[] = {
    {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_LOCAL_SIZE", "PMIX_NAMESPACE"},
    {"PMI_RANK", "PMI_SIZE", "MPI_LOCALNRANKS", "PMI_JOBID"},
    // Not SLURM_NTASKS, which the one process of a batch script has, too.
    {"SLURM_PROCID", "SLURM_STEP_NUM_TASKS", "SLURM_STEP_TASKS_PER_NODE", "SLURM_STEP_ID"},
};

} // namespace

Launched launched() {
    for (const Variables& names : kLaunchers) {
        const std::optional<int> rank = numberOf(names.rank), count = numberOf(names.count);
        if (!rank || !count || *count < 1 || *rank < 0 || *rank >= *count) continue;
        std::string job(textOf(names.job));
        job.append("-").append(textOf("SLURM_JOB_ID"));
        if (const std::string_view again = textOf("SLURM_RESTART_COUNT"); !again.empty()) // of a job that was requeued
            job.append("-").append(again);
        std::erase_if(job, [](char c) { return c == '/' || c == '.'; });
        std::optional<int> beside = numberOf(names.onThisMachine);
        if (!beside) beside = numberOf("SLURM_STEP_TASKS_PER_NODE"); // srun --mpi=pmi2
        return {*rank, *count, std::clamp(beside.value_or(1), 1, *count), job};
    }
    return {};
}

} // namespace tessera
