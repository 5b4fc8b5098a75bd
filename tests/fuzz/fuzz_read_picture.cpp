#include "tests/fuzz/fuzz_read.h"

/// The first byte chooses the format.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static constexpr const char* kSuffixes[] = {".png", ".jpg", ".bmp", ".pgm"};
    if (size > 0) tessera::importer::readAs(data + 1, size - 1, kSuffixes[data[0] % 4]);
    return 0;
}
