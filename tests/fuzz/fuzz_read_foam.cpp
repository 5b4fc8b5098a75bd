// Cases of OpenFOAM: the input is their files, each "== name", a line end, and what stands in it.
#include "tests/fuzz/fuzz_read.h"

#include <string_view>

namespace {

namespace fs = std::filesystem;

/// A folder of this process that goes with it.
struct FuzzedFolder {
    fs::path path = fs::temp_directory_path() / ("tessera_fuzz_foam_" + std::to_string(getpid()));
    FuzzedFolder() { fs::create_directories(path / "constant/polyMesh"); }
    ~FuzzedFolder() { fs::remove_all(path); }
    FuzzedFolder(const FuzzedFolder&) = delete;
    FuzzedFolder& operator=(const FuzzedFolder&) = delete;
};

/// The only files that are written: names may be hostile, too.
constexpr std::string_view kNames[] = {"constant/polyMesh/points",
                                       "constant/polyMesh/faces",
                                       "constant/polyMesh/owner",
                                       "constant/polyMesh/neighbour",
                                       "constant/polyMesh/boundary",
                                       "constant/polyMesh/cellZones",
                                       "constant/air/polyMesh/points",
                                       "system/fvSchemes",
                                       "0/T",
                                       "0/U",
                                       "1/T",
                                       "1/polyMesh/points",
                                       "processors1/0/T",
                                       "processors1/constant/polyMesh/points"};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const FuzzedFolder folder;
    const std::string_view all(reinterpret_cast<const char*>(data), size);
    for (std::size_t at = all.find("== "); at != std::string_view::npos;) {
        const std::size_t line = std::min(all.find('\n', at), all.size());
        const std::string_view name = all.substr(at + 3, line - at - 3);
        const std::size_t next = all.find("\n== ", line);
        const std::string_view text =
            line < all.size() ? all.substr(line + 1, next == std::string_view::npos ? next : next - line) : "";
        for (const std::string_view known : kNames)
            if (name == known) {
                fs::create_directories((folder.path / known).parent_path());
                std::ofstream(folder.path / known, std::ios::binary) << text;
            }
        at = next == std::string_view::npos ? next : next + 1;
    }
    tessera::importer::readPath(folder.path.string());
    return 0;
}
