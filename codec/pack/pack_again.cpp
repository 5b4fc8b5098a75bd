#include "codec/pack/pack_again.h"

namespace tessera::codec {

PackSummary pack(volume::Dataset& source, const PackOptions& options, const std::string& path, const Progress& progress,
                 const SlabInput& slabs, const PackedBefore& before) {
    return pack(source, options, path, progress, slabs, PackedAgain{before});
}

PackSummary append(volume::Dataset& source, const std::string& path, double memoryMb, const Progress& progress,
                   const SlabInput& slabs, const PackedBefore& before) {
    return append(source, path, memoryMb, progress, slabs, PackedAgain{before});
}

} // namespace tessera::codec
