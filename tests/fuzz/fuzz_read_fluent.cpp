#include "app/importer/fluent/fluent_case.h"
#include "tests/fuzz/fuzz_read.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tessera::importer;
    const FuzzedFile file(".cas");
    std::ofstream(file.path, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    try {
        const FluentCase read = readFluentCase(file.path);
        for (const FluentZone& zone : read.zones) cellsOfFaces(read.mesh, read.faces, zone.first, zone.last);
    } catch (const std::exception&) {
    }
    return 0;
}
