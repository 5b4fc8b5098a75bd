#pragma once

#include "codec/bytes/bytes.h"
#include "volume/flow/computed_numbers.h"

#include <span>
#include <string>
#include <vector>

/// Numbers of regions as bytes. (FORMAT.md "Numbers".)
namespace tessera::codec {

/// What an archive knows of the numbers of its source.
struct StoredNumbers {
    volume::ComputedNumbers numbers;
    std::string shape; ///< of the last block
};

/// Codes numbers in blocks, each of some of the times. `shape`: what the last block before says of labels, channels and
/// regions, "" = there is none; becomes that of the last one. Counts, volumes, least and most keep every bit, other
/// numbers are rounded by less than 1e-12 of themselves.
std::vector<Bytes> encodeNumbers(const volume::ComputedNumbers& numbers, std::string& shape);

/// The numbers of both, by rising time.
void addNumbers(volume::ComputedNumbers more, volume::ComputedNumbers& numbers);

/// The numbers of one block. `shape`: as above. Throws Error with the reason when it is damaged.
volume::ComputedNumbers decodeNumbers(std::span<const std::byte> block, std::string& shape);

} // namespace tessera::codec
