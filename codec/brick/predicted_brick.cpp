#include "codec/brick/predicted_brick.h"

namespace tessera::codec {

std::vector<std::uint32_t> predictionFrom(const NumberCoding& numbers, volume::ScalarType type,
                                          std::span<const std::byte> before) {
    std::vector<std::uint32_t> codes(before.size() / volume::byteSize(type));
    codesOf(numbers, type, before, codes.data());
    return codes;
}

void addPrediction(std::span<const std::uint32_t> prediction, DecodedBrick& out) {
    std::size_t next = 0;
    for (int z = 0; z < out.size.z; ++z)
        for (int y = 0; y < out.size.y; ++y) {
            auto& samples = out.boxes32.samples[std::size_t(z % out.sublattices)];
            std::int32_t* const row = samples.box().row(y, z / out.sublattices);
            for (int x = 0; x < out.size.x; ++x)
                row[x] = static_cast<std::int32_t>(static_cast<std::uint32_t>(row[x]) + prediction[next++]);
        }
}

KeptNumbers::Numbers KeptNumbers::find(const Key& key) {
    const std::lock_guard lock(mutex_);
    const auto found = byKey_.find(key);
    if (found == byKey_.end()) return nullptr;
    entries_.splice(entries_.begin(), entries_, found->second);
    return found->second->second;
}

void KeptNumbers::keep(const Key& key, Numbers numbers) {
    constexpr std::size_t kMostBytes = std::size_t(32) << 20;
    const std::lock_guard lock(mutex_);
    if (byKey_.contains(key)) return;
    bytes_ += numbers->size();
    entries_.emplace_front(key, std::move(numbers));
    byKey_[key] = entries_.begin();
    while (bytes_ > kMostBytes) {
        bytes_ -= entries_.back().second->size();
        byKey_.erase(entries_.back().first);
        entries_.pop_back();
    }
}

} // namespace tessera::codec
