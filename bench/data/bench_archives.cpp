#include "bench/data/bench_archives.h"

#include "volume/import/import.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <unistd.h>

namespace tessera::app {

namespace fs = std::filesystem;

BenchFile::BenchFile(const std::string& ending) {
    static int number = 0;
    const std::string name = "tessera-bench-" + std::to_string(::getpid()) + "-" + std::to_string(number++) + ending;
    path = (fs::temp_directory_path() / name).string();
}

BenchFile::~BenchFile() {
    std::remove(path.c_str());
}

std::vector<std::pair<std::string, volume::Dataset>> volumeFiles() {
    std::vector<std::pair<std::string, volume::Dataset>> found;
    const char* data = std::getenv("TESSERA_DATA");
    std::vector<fs::path> sidecars;
    std::error_code missing;
    if (data)
        for (const auto& entry : fs::directory_iterator(fs::path(data) / "volumes", missing))
            if (entry.path().extension() == ".json") sidecars.push_back(entry.path());
    if (sidecars.empty()) std::fprintf(stderr, "bench: no volumes found in $TESSERA_DATA/volumes\n");
    std::sort(sidecars.begin(), sidecars.end());
    for (const fs::path& sidecar : sidecars)
        found.emplace_back(sidecar.stem().string(), volume::openFiles({sidecar.string()}, {}));
    return found;
}

std::vector<std::pair<std::string, volume::Dataset>> thesisVolumes() {
    auto found = volumeFiles();
    std::erase_if(found, [](const auto& entry) {
        const volume::ScalarType type = entry.second.info.parameters[0].type;
        return type == volume::ScalarType::F32 || type == volume::ScalarType::I32;
    });
    return found;
}

} // namespace tessera::app
