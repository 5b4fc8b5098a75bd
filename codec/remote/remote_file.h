#pragma once

#include "codec/container/container.h"
#include "codec/remote/block_cache.h"
#include "codec/remote/fetch_queue.h"
#include "codec/remote/remote_options.h"
#include "volume/system/file_bytes.h"

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

namespace tessera::codec {

/// An archive on another machine. It is read in blocks, neighbouring ones by one request, and blocks are kept on disk.
///
/// On opening, only the headers are read. They name the last page of the index, whose checksum stands for the contents
/// in the cache, wherever the archive lies: an archive that has been replaced is another one. That of one that has
/// grown takes over what was kept of it before.
class RemoteFile final : public FileBytes {
public:
    static constexpr std::uint64_t kBlockBytes = 1 << 16;

    /// Throws NotAllowed; Error when the file cannot be reached, or is no file that can be read in ranges.
    RemoteFile(const std::string& address, const RemoteOptions& options);

    std::uint64_t size() const override { return size_; }
    FilePart part(FileRange range) const override;
    std::optional<FilePart> freshPart(FileRange range) const override;
    void readAhead(std::span<const FileRange> ranges) const override;
    void goesOn(std::uint64_t end, std::uint64_t checksum) const override;
    bool hasChanged() const override { return changed_; }
    /// Removes what the cache holds of it.
    void forget() { cache_->clear(); }

private:
    using Blocks = std::vector<std::uint64_t>;
    std::size_t blockBytes(std::uint64_t block) const;
    Blocks blocksOf(FileRange range) const;
    /// Fetches blocks and calls `take(block, bytes)` for each, also for those between them; not thread-safe.
    template <class Take> void fetch(const Blocks& blocks, Take&& take) const;
    /// Takes blocks that no other thread fetches; waits for the others if there is none.
    Blocks claim(const Blocks& blocks) const;
    void release(const Blocks& blocks) const;
    void note(const Reply& reply) const;
    /// The bytes of a range from `read(range, bytes)` of pieces.
    template <class Read> FilePart inPieces(FileRange range, const Read& read) const;
    /// Copies what a block and a range share to its place in `out`, the bytes of the range.
    static void copyBlock(FileRange range, std::uint64_t block, std::span<const std::byte> bytes,
                          std::vector<std::byte>& out);

    std::string address_;
    std::uint64_t size_ = 0;
    std::string state_;
    std::vector<std::byte> head_;
    mutable std::atomic<bool> changed_ = false;
    mutable std::unique_ptr<BlockCache> cache_;
    mutable std::mutex mutex_;
    mutable std::condition_variable released_;
    mutable std::set<std::uint64_t> underway_; ///< blocks that a thread fetches
    mutable FetchQueue queue_;                 ///< last: its threads end first
};

/// The headers of an archive on another machine, asked for again and again over one connection.
class RemoteHeaders {
public:
    explicit RemoteHeaders(std::string address) : address_(std::move(address)) {}
    /// The valid header; none if the file cannot be read now or is no archive. Throws Cancelled when a stop is
    /// requested meanwhile.
    std::optional<Header> read(const std::stop_token& stop);

private:
    std::string address_;
    std::unique_ptr<Connection> connection_;
};

/// Removes what the cache holds of an archive on another machine, so that all of it is read from there again; does
/// nothing for other files. Throws Error.
void forgetRemote(const std::string& path, const RemoteOptions& options);

/// The bytes of a file by path or address. Throws Error.
std::unique_ptr<FileBytes> openBytes(const std::string& path, const RemoteOptions& options);

} // namespace tessera::codec
