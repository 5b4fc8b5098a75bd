#include "codec/remote/remote_file.h"

#include "codec/container/container.h"
#include "codec/remote/block_runs.h"
#include "codec/remote/consent.h"
#include "volume/system/mapped_file.h"

#include <algorithm>
#include <cstdio>

namespace tessera::codec {

namespace {

constexpr std::uint64_t kGap = 1; ///< blocks between two wanted ones that are fetched along
/// Bytes that are asked for and kept in memory at once: what a server only states costs no memory.
constexpr std::uint64_t kAtOnce = std::uint64_t(16) << 20;
constexpr std::uint64_t kMost = 16; ///< blocks of a request: several connections share a long range

std::string nameOf(std::uint64_t checksum, std::uint64_t bytes) {
    char name[40];
    std::snprintf(name, sizeof name, "%016llx-%llx", static_cast<unsigned long long>(checksum),
                  static_cast<unsigned long long>(bytes));
    return name;
}

std::optional<Header> headerIn(std::span<const std::byte> head, std::uint64_t size) {
    try {
        return parseHeaders(head, size, {}).header;
    } catch (const Error&) {
        return std::nullopt; // of what is no archive, or one that is being written
    }
}

/// The name of a state of an archive in the cache: that of its last page, which ends with the archive.
std::string cacheName(std::span<const std::byte> head, std::uint64_t size) {
    const std::optional<Header> header = headerIn(head, size);
    return header ? nameOf(header->index.checksum, header->fileSize) : nameOf(checksum(head), size);
}

/// Throws NotAllowed: the only way to another machine asks first.
FetchQueue::Connect connectTo(const Address& address) {
    requireAllowed(address);
    return [address] { return address.scheme == Address::Scheme::Sftp ? connectSsh(address) : connectWeb(address); };
}

} // namespace

RemoteFile::RemoteFile(const std::string& address, const RemoteOptions& options)
    : address_(address),
      queue_(connectTo(parseAddress(address)), options.connections, std::chrono::duration<double>(options.patience)) {
    const FileRange headers{0, kFirstChunk};
    Reply reply = std::move(queue_.fetch({&headers, 1}).front());
    size_ = reply.fileBytes;
    state_ = reply.state;
    head_ = std::move(reply.bytes);
    cache_ =
        std::make_unique<BlockCache>(remoteCacheFolder(), cacheName(head_, size_), std::uint64_t(options.cache) << 20);
}

void RemoteFile::goesOn(std::uint64_t end, std::uint64_t checksum) const {
    cache_->takeOver(nameOf(checksum, end));
}

std::size_t RemoteFile::blockBytes(std::uint64_t block) const {
    return static_cast<std::size_t>(std::min(kBlockBytes, size_ - block * kBlockBytes));
}

RemoteFile::Blocks RemoteFile::blocksOf(FileRange range) const {
    Blocks blocks;
    if (range.length == 0 || range.offset + range.length <= head_.size()) return blocks;
    for (std::uint64_t b = range.offset / kBlockBytes; b <= (range.offset + range.length - 1) / kBlockBytes; ++b)
        blocks.push_back(b);
    return blocks;
}

void RemoteFile::note(const Reply& reply) const {
    if (reply.fileBytes != size_ || reply.state != state_) changed_ = true;
}

template <class Take> void RemoteFile::fetch(const Blocks& blocks, Take&& take) const {
    std::vector<FileRange> ranges;
    for (const BlockRun& run : blockRuns(blocks, kGap, kMost)) {
        const std::uint64_t begin = run.first * kBlockBytes, end = (run.first + run.count) * kBlockBytes;
        ranges.push_back({begin, std::min(end, size_) - begin});
    }
    const std::vector<Reply> replies = queue_.fetch(ranges);
    for (std::size_t r = 0; r < ranges.size(); ++r) {
        note(replies[r]);
        if (replies[r].bytes.size() != ranges[r].length)
            throw ReadError("the file on the server is shorter than it was when it was opened: open it again",
                            address_);
        for (std::uint64_t at = 0; at < ranges[r].length; at += kBlockBytes) {
            const std::uint64_t block = (ranges[r].offset + at) / kBlockBytes;
            take(block, std::span(replies[r].bytes).subspan(at, blockBytes(block)));
        }
    }
}

RemoteFile::Blocks RemoteFile::claim(const Blocks& blocks) const {
    std::unique_lock lock(mutex_);
    Blocks mine;
    for (const std::uint64_t block : blocks)
        if (underway_.insert(block).second) mine.push_back(block);
    if (mine.empty())
        released_.wait(lock, [&] {
            return std::ranges::none_of(blocks, [&](std::uint64_t block) { return underway_.contains(block); });
        });
    return mine;
}

void RemoteFile::release(const Blocks& blocks) const {
    const std::lock_guard lock(mutex_);
    for (const std::uint64_t block : blocks) underway_.erase(block);
    released_.notify_all();
}

void RemoteFile::readAhead(std::span<const FileRange> ranges) const {
    Blocks wanted;
    for (FileRange range : ranges) {
        range.length = std::min(range.length, kAtOnce); // what follows is asked for once it is read
        for (const std::uint64_t block : blocksOf(range)) wanted.push_back(block);
    }
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    const auto isHere = [&](std::uint64_t block) { return cache_->has(block, blockBytes(block)); };
    // Twice: first those that no other thread fetches, then, after these threads, what they failed to get.
    for (int pass = 0; pass < 2; ++pass) {
        std::erase_if(wanted, isHere);
        if (wanted.empty()) return;
        const Blocks mine = claim(wanted);
        struct Release {
            const RemoteFile& file;
            const Blocks& blocks;
            ~Release() { file.release(blocks); }
        } const releasing{*this, mine};
        if (!mine.empty()) fetch(mine, [&](std::uint64_t block, auto bytes) { cache_->write(block, bytes); });
    }
}

void RemoteFile::copyBlock(FileRange range, std::uint64_t block, std::span<const std::byte> bytes,
                           std::vector<std::byte>& out) {
    const std::uint64_t at = block * kBlockBytes, begin = std::max(at, range.offset),
                        end = std::min(at + bytes.size(), range.offset + range.length);
    if (begin < end)
        std::copy_n(bytes.begin() + std::ptrdiff_t(begin - at), end - begin,
                    out.begin() + std::ptrdiff_t(begin - range.offset));
}

template <class Read> FilePart RemoteFile::inPieces(FileRange range, const Read& read) const {
    std::vector<std::byte> all;
    for (const std::uint64_t end = range.offset + range.length; range.offset < end;) {
        const std::uint64_t next = std::min((range.offset / kAtOnce + 1) * kAtOnce, end);
        std::vector<std::byte> piece(next - range.offset);
        read({range.offset, piece.size()}, piece);
        if (piece.size() == range.length) return FilePart(std::move(piece));
        all.insert(all.end(), piece.begin(), piece.end());
        range.offset = next;
    }
    return FilePart(std::move(all));
}

FilePart RemoteFile::part(FileRange range) const {
    if (range.offset + range.length <= head_.size())
        return FilePart(std::span(head_).subspan(range.offset, range.length));
    return inPieces(range, [&](FileRange piece, std::vector<std::byte>& out) {
        readAhead({&piece, 1});
        std::vector<std::byte> whole;
        Blocks missing;
        for (const std::uint64_t block : blocksOf(piece)) {
            whole.resize(blockBytes(block));
            if (cache_->read(block, whole))
                copyBlock(piece, block, whole, out);
            else
                missing.push_back(block);
        }
        if (!missing.empty()) // removed meanwhile, or the disk keeps nothing
            fetch(missing, [&](std::uint64_t block, auto bytes) { copyBlock(piece, block, bytes, out); });
    });
}

std::optional<FilePart> RemoteFile::freshPart(FileRange range) const {
    return inPieces(range, [&](FileRange piece, std::vector<std::byte>& out) {
        fetch(blocksOf(piece), [&](std::uint64_t block, auto bytes) {
            cache_->write(block, bytes);
            copyBlock(piece, block, bytes, out);
        });
    });
}

std::optional<Header> RemoteHeaders::read(const std::stop_token& stop) {
    try {
        if (!connection_) connection_ = connectTo(parseAddress(address_))();
        connection_->lookAgain();
        const Reply reply = connection_->read({0, kFirstChunk}, stop);
        return headerIn(reply.bytes, reply.fileBytes);
    } catch (const Error&) {
        connection_.reset();
        return std::nullopt;
    }
}

void forgetRemote(const std::string& path, const RemoteOptions& options) {
    if (isRemote(path)) RemoteFile(path, options).forget();
}

std::unique_ptr<FileBytes> openBytes(const std::string& path, const RemoteOptions& options) {
    if (isRemote(path)) return std::make_unique<RemoteFile>(path, options);
    return std::make_unique<MappedFile>(path);
}

} // namespace tessera::codec
