#include "app/command/command.h"

#include "volume/base/error.h"
#include "volume/system/own_path.h"

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <string>
#include <unistd.h>
#include <vector>

namespace tessera::app {

void addBenchCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "bench", "Measure the tables of docs/benchmarks.md on this machine, by the program tessera-bench, "
                 "which is built on demand: --target tessera-bench");
    command->set_help_flag(); // --help is passed on to tessera-bench
    command->prefix_command();
    command->callback([command] {
        std::string program = programBeside("tessera-bench");
        if (program.empty())
            throw Error("the measurements are a program of their own, tessera-bench, which does not lie beside this "
                        "one: cmake --build --preset release --target tessera-bench");
        std::vector<std::string> words = command->remaining();
        std::vector<char*> arguments{program.data()};
        for (std::string& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        execv(program.c_str(), arguments.data());
        throw MachineError(std::strerror(errno), program);
    });
}

} // namespace tessera::app
