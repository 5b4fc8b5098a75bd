#include "codec/container/mask_hash.h"

#include <algorithm>
#include <xxhash.h>

namespace tessera::codec {

MaskHash::MaskHash() : state_(XXH3_createState()) {
    XXH3_128bits_reset(state_);
}

MaskHash::~MaskHash() {
    XXH3_freeState(state_);
}

void MaskHash::add(const volume::Mask& part) {
    gaps_ = gaps_ || std::find(part.begin(), part.end(), std::uint8_t(0)) != part.end();
    XXH3_128bits_update(state_, part.data(), part.size());
}

void MaskHash::add(const volume::Field& part) {
    add(part.mask ? *part.mask : volume::Mask(part.count(), 1));
}

MaskHash::Value MaskHash::value() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_);
    return {hash.low64, hash.high64};
}

} // namespace tessera::codec
