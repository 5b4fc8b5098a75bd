#pragma once

#include "codec/brick/decoded_brick.h"
#include "codec/bytes/bytes.h"

#include <compare>
#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

/// Stepped bricks whose codes are differences from the same brick at the time before, so that a slow series costs what
/// changes. Both writer and reader compute the prediction from what is decoded. (FORMAT.md "Predicted bricks".)
namespace tessera::codec {

/// Longest run of such bricks after one that is coded by itself.
inline constexpr int kMostPredicted = 15;

/// The codes of a brick's numbers, or of those of one of its levels, before `numbers` rounds them.
std::vector<std::uint32_t> predictionFrom(const NumberCoding& numbers, volume::ScalarType type,
                                          std::span<const std::byte> before);

/// Adds it to the decoded codes of a stepped brick at the same level.
void addPrediction(std::span<const std::uint32_t> prediction, DecodedBrick& out);

/// Decoded numbers that later bricks may be predicted from, the most recently used ones. Thread-safe.
class KeptNumbers {
public:
    struct Key {
        std::size_t frame = 0, brick = 0;
        int level = 0;
        auto operator<=>(const Key&) const = default;
    };
    using Numbers = std::shared_ptr<const Bytes>;

    Numbers find(const Key& key); ///< null: not kept
    void keep(const Key& key, Numbers numbers);

private:
    using Entry = std::pair<Key, Numbers>;
    std::mutex mutex_;
    std::list<Entry> entries_; ///< latest first
    std::map<Key, std::list<Entry>::iterator> byKey_;
    std::size_t bytes_ = 0;
};

} // namespace tessera::codec
