#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// The compressors of Zarr version 2, by their names in numcodecs.
namespace tessera::importer {

/// Whether `decompressed` knows a compressor ("" = none).
bool knowsCompressor(const std::string& name);

/// Exactly `wanted` bytes from a compressed chunk. Throws std::runtime_error with one line of reason if it holds fewer,
/// more, or is damaged; takes no more memory than `wanted`.
std::vector<char> decompressed(const std::string& compressor, const std::vector<char>& chunk, std::size_t wanted);

} // namespace tessera::importer
