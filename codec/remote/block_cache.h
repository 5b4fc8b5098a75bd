#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace tessera::codec {

/// Blocks of remote files, kept on disk between runs: one file a block, FOLDER/NAME/NUMBER, where NAME stands for a
/// file and its contents. Its time is that of the last use. Several programs may share a folder: blocks appear whole,
/// and one that another program has removed is merely absent. Nothing here is trusted: a block may hold any bytes.
///
/// Thread-safe. Nothing throws but the constructor: what cannot be stored is not stored.
class BlockCache {
public:
    /// All files below `folder` together take at most `limit` bytes. "": a temporary folder, removed with this object.
    /// Throws MachineError when that cannot be made.
    BlockCache(const std::string& folder, const std::string& name, std::uint64_t limit);
    ~BlockCache();
    BlockCache(const BlockCache&) = delete;
    BlockCache& operator=(const BlockCache&) = delete;

    bool has(std::uint64_t block, std::size_t bytes) const;
    /// Fills `bytes`, the whole block; false if there is none of exactly this size.
    bool read(std::uint64_t block, std::span<std::byte> bytes) const;
    /// Removes all blocks of this file.
    void clear();
    void write(std::uint64_t block, std::span<const std::byte> bytes);
    /// Moves blocks of another file here, where there are none yet. They are missing there afterwards.
    void takeOver(const std::string& name);

private:
    std::string pathOf(std::uint64_t block) const;
    std::string folder_, files_;
    bool temporary_ = false;
    std::uint64_t limit_;
    std::atomic<std::uint64_t> written_ = 0; ///< bytes since the last call of trimCache
    std::atomic<unsigned> parts_ = 0;
    std::mutex trimming_;
};

/// Removes the files below `folder` that were used least recently until the others take at most `limit` bytes.
void trimCache(const std::string& folder, std::uint64_t limit);

/// The folder for blocks of remote files in the user's cache folder; "" when there is none.
std::string remoteCacheFolder();

} // namespace tessera::codec
