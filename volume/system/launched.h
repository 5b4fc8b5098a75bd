#pragma once

#include <string>

namespace tessera {

/// How a launcher of parallel programs started this process: mpirun (Open MPI, MPICH) or srun (Slurm). They say so in
/// the environment, so that no library of theirs is needed.
struct Launched {
    int rank = 0;          ///< 0 .. count - 1
    int count = 1;         ///< processes of the job; 1: started alone
    int onThisMachine = 1; ///< of them
    std::string job;       ///< a name that differs from one run of the launcher to the next, but for some of MPICH
    bool operator==(const Launched&) const = default;
};

Launched launched();

} // namespace tessera
