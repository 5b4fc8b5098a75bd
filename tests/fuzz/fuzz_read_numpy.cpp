// Arrays alone, and archives of them, which begin as every zip file does.
#include "tests/fuzz/fuzz_read.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const bool zip = size > 1 && data[0] == 'P' && data[1] == 'K';
    tessera::importer::readAs(data, size, zip ? ".npz" : ".npy");
    return 0;
}
