#include "codec/unpack/packed_before.h"

#include "codec/container/exactness.h"
#include "codec/unpack/unpack.h"

namespace tessera::codec {

PackedBefore packedBefore(const std::shared_ptr<const Archive>& archive) {
    const Metadata& metadata = archive->metadata();
    PackedBefore before{metadata.source, metadata.lossless, metadata.maxError, metadata.resampled};
    const bool corrected = !metadata.corrections.empty();
    if (isResampled(metadata) && (!corrected || !metadata.resampled.empty()))
        before.resampled.resize(metadata.info.parameters.size());
    if (corrected) before.source = gridDataset(archive, 0);
    try {
        before.numbers = archive->numbers();
    } catch (const ReadError&) {
        throw;
    } catch (const Error&) { // damaged ones say nothing of samples: they are left out
    }
    return before;
}

} // namespace tessera::codec
