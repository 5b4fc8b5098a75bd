#include "tests/fuzz/fuzz_read.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    tessera::importer::readAs(data, size, ".xdmf");
    return 0;
}
