#include "tests/fuzz/fuzz_read.h"

#include <algorithm>
#include <string_view>

/// A folder from bytes: the attributes of the image, the description of its array, and two chunks, separated by 0x1e.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    namespace fs = std::filesystem;
    const fs::path folder = fs::temp_directory_path() / ("tessera_fuzz_" + std::to_string(getpid()) + ".zarr");
    fs::create_directories(folder / "0");
    std::string_view rest(reinterpret_cast<const char*>(data), size);
    for (const char* name : {".zattrs", "0/.zarray", "0/0.0.0", "0/1.0.0"}) {
        const std::size_t end = std::min(rest.find('\x1e'), rest.size());
        std::ofstream(folder / name, std::ios::binary).write(rest.data(), std::streamsize(end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    tessera::importer::readPath(folder.string());
    fs::remove_all(folder);
    return 0;
}
