#include "app/importer/ensight/ensight_parts.h"
#include "tests/fuzz/fuzz_read.h"

/// A geometry of EnSight, then the same bytes as values on it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tessera::importer;
    const FuzzedFile file(".geo");
    std::ofstream(file.path, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    try {
        EnSightBytes geometry(file.path, 0);
        const std::vector<EnSightPart> parts = readEnSightParts(geometry);
        for (const EnSightPart& part : parts) gridOfPart(part);
        EnSightBytes values(file.path, 0, geometry.form());
        readEnSightValues(values, parts, 3, true);
    } catch (const std::exception&) {
    }
    return 0;
}
