#include "bench/bench.h"
#include "volume/system/own_path.h"

#include <cstdio>
#include <cstdlib>

namespace tessera::app {

namespace {

std::vector<std::string> cellsOf(std::string line) {
    while (!line.empty() && line.back() == '\n') line.pop_back();
    std::vector<std::string> cells;
    for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
        end = line.find('\t', begin);
        cells.push_back(line.substr(begin, end - begin));
    }
    return cells;
}

} // namespace

BenchTable benchPeers() {
    BenchTable table;
    table.name = "codec: lossless and within bounds beside other coders, one thread";
    table.columns = {"data", "coder", "ratio", "encode MB/CPU s", "decode MB/CPU s", "over zstd -3", "error of range"};
    const std::string program = programBeside("tessera-codec-peers");
    const char* data = std::getenv("TESSERA_DATA");
    if (data == nullptr || program.empty()) {
        std::fprintf(stderr, "bench codec: other coders need tessera-codec-peers beside this program, and volumes in "
                             "$TESSERA_DATA/volumes\n");
        return table;
    }
    const std::string command = "'" + program + "' '" + data + "/volumes'";
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return table;
    char line[512];
    while (std::fgets(line, sizeof line, pipe) != nullptr) {
        std::vector<std::string> cells = cellsOf(line);
        if (cells[0] != "absent") {
            if (cells.size() == table.columns.size()) table.rows.push_back(std::move(cells));
            continue;
        }
        std::string names;
        for (std::size_t i = 1; i < cells.size(); ++i) names += (i > 1 ? ", " : "") + cells[i];
        if (!names.empty()) std::fprintf(stderr, "bench codec: not installed when this was built: %s\n", names.c_str());
    }
    pclose(pipe);
    return table;
}

} // namespace tessera::app
