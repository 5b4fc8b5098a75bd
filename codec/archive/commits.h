#pragma once

#include "codec/archive/archive_state.h"
#include "codec/container/growing_file.h"
#include "codec/container/index.h"
#include "codec/container/metadata.h"

#include <optional>

namespace tessera::codec {

/// What the last commit of an archive wrote, on which the next one depends.
struct Commits {
    Header header;
    Bytes metadata;              ///< serialised
    std::size_t times = 0;       ///< that are readable
    std::uint64_t pageBytes = 0; ///< of all pages so far, decompressed
    std::size_t textBytes = 0;   ///< of the metadata when they were last serialised

    /// Whether the additions to `file` are too small for a commit, unless the metadata have become shorter: so that
    /// these need be neither gathered nor serialised after every time.
    bool waits(const GrowingFile& file) const;

    /// Makes the additions in `page`, whose chunks have been appended to `file`, readable: appends the metadata if it
    /// has changed and the page, and writes the headers. `wholeTimes`: number of times of the metadata that are
    /// complete. Unless `always`, it waits until the additions are 64 times as large as what a commit costs. Returns
    /// the page if it was written; `page` is empty then.
    std::optional<IndexPage> commit(GrowingFile& file, IndexPage& page, const Metadata& now, std::size_t wholeTimes,
                                    bool always);
};

/// The last commit of an existing archive.
Commits commitsOf(const Archive& archive, const ArchiveState& state);

} // namespace tessera::codec
