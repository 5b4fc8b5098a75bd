#include "codec/archive/commits.h"

#include "codec/bytes/lzma.h"

#include <algorithm>
#include <utility>

namespace tessera::codec {

bool Commits::waits(const GrowingFile& file) const {
    constexpr std::size_t kWorthwhile = 64, kPage = 256; // multiples of the bytes that a commit costs, including a page
    const std::uint64_t last = std::max(header.fileSize, kFirstChunk);
    return file.position() - last < kWorthwhile * (textBytes + kPage);
}

std::optional<IndexPage> Commits::commit(GrowingFile& file, IndexPage& page, const Metadata& now,
                                         std::size_t wholeTimes, bool always) {
    Bytes text = serialise(now, header.features);
    textBytes = text.size();
    if (!always && waits(file)) return std::nullopt;
    if (page.frames.empty() && text == metadata) return std::nullopt;
    const std::vector<double>& all = now.info.times;
    page.times.assign(all.begin() + std::ptrdiff_t(times), all.begin() + std::ptrdiff_t(wholeTimes));
    page.previousPage = header.index;
    page.previousMetadata = {};
    if (text != metadata) {
        page.previousMetadata = header.metadata;
        header.metadata = {file.position(), text.size(), checksum(text)};
        file.append(text);
        metadata = std::move(text);
    }
    Bytes index = serialise(page, header.features);
    pageBytes += index.size();
    if ((header.features & kCompact) != 0) index = encodeBlock(index, pageBytes > mostPageBytes(file.position()));
    header.index = {file.position(), index.size(), checksum(index)};
    file.append(index);
    header.fileSize = file.position();
    file.commit(header);
    times = wholeTimes;
    return std::exchange(page, {});
}

Commits commitsOf(const Archive& archive, const ArchiveState& state) {
    return {state.header, serialise(archive.metadata(), state.header.features), state.times, state.pageBytes};
}

} // namespace tessera::codec
