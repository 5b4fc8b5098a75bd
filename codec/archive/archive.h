#pragma once

#include "codec/container/metadata.h"
#include "codec/remote/remote_options.h"
#include "volume/base/error.h"
#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tessera::volume {
struct MergedBrick;
}

namespace tessera::codec {

struct StoredNumbers;

/// Result of verifyArchive.
struct VerifyReport {
    std::uint64_t bricks = 0;        ///< decoded; each counts once for all its levels
    std::uint64_t samples = 0;       ///< at full resolution
    std::uint64_t bytes = 0;         ///< whose checksum was computed
    std::vector<std::string> damage; ///< one line each, the first hundred
    std::uint64_t damaged = 0; ///< damaged items, each counted once: copies of the header, former metadata, models,
                               ///< masks of bricks, bricks with bytes of their own
    std::uint64_t damagedBricks =
        0; ///< unreadable bricks: damaged themselves, or in their mask, their model, or the brick they repeat
    bool damagedHeader = false; ///< one of the two copies, possibly by a crash during a commit; included in `damaged`
};

/// An open .tsr archive: a source of bricks that reads a memory-mapped file, or a file on another machine in ranges.
/// Thread-safe. Nothing in the file is trusted: header, metadata and index are checked on opening, each segment of a
/// brick before it is decoded.
///
/// It has the contents of the file at the time of opening, even while the file grows; reopen it to see more.
class Archive final : public volume::BrickSource {
public:
    /// Throws Error with file, position and reason when the file is not an archive, has another version, or is
    /// truncated or damaged, or when another machine does not answer. `path` may be an address
    /// (codec/remote/address.h).
    explicit Archive(const std::string& path, const RemoteOptions& remote = {});
    ~Archive() override;

    const volume::DatasetInfo& info() const override;
    const volume::BrickGrid& grid() const override;
    volume::BrickStats stats(const volume::BrickKey& key) const override;
    /// Empty for archives without these statistics, and for magnitudes.
    std::optional<volume::BrickDistribution> distribution(const volume::BrickKey& key) const override;
    std::optional<volume::BrickImportance> importance(const volume::BrickKey& key) const override;
    /// On D4*: between frames of the same parity.
    std::optional<volume::BrickChange> change(const volume::BrickKey& key, int toTime) const override;
    /// Coarse levels are clamped to the range of the brick; floats that are not finite become absent. If several parts
    /// of a parameter (volume/field/parts.h) meet in a brick, each coarse sample is computed from one part.
    volume::BrickSamples read(const volume::BrickKey& key) const override;

    const Metadata& metadata() const;
    /// The archives of corrections inside this one, on the grid of its source, each for some parameters and times
    /// (codec/unpack/corrections.h); opened by the first call. Throws Error.
    std::vector<std::shared_ptr<const Archive>> corrections() const;
    /// Numbers of regions as they were computed from the source, where the archive keeps them; null if it has none.
    /// Read by the first call. Throws Error when they are damaged.
    std::shared_ptr<const StoredNumbers> numbers() const;
    const std::string& path() const;
    /// The format version.
    std::uint32_t version() const;
    /// Size of the archive in bytes; the file may be longer because of an append in progress or an interrupted one.
    std::uint64_t fileBytes() const;
    /// A number that tells these contents from others: the checksum of the header, which holds those of all the rest.
    std::uint64_t fingerprint() const;
    /// Number of commits.
    int commits() const;
    /// True when the file has been appended to, or replaced, since it was opened.
    bool outdated() const;
    /// Total bytes of the segments of a level, over all bricks, parameters and times.
    std::uint64_t levelBytes(int level) const;
    std::uint64_t maskBytes() const;
    int maskCount() const;
    /// Number of bricks stored as repeats of an earlier time, and the bytes saved.
    struct Repeats {
        std::uint64_t bricks = 0, bytes = 0;
    };
    Repeats repeats() const;
    /// How many times earlier the stored brick lies; 0 if the brick has its own bytes. For stored components only.
    int repeats(const volume::BrickKey& key) const;
    /// Bytes of all levels of a brick or of the brick it repeats. For stored components only.
    std::uint64_t brickBytes(const volume::BrickKey& key) const;

private:
    friend volume::Field readLayers(const Archive&, int, int, int, int, int);
    friend VerifyReport verifyArchive(const Archive&, const Progress&);
    friend struct Verifier;
    friend std::vector<struct MergedBytes> bytesOfMerged(const Archive&, std::span<const volume::MergedBrick>,
                                                         const Progress&);
    friend struct ArchiveState stateOf(const Archive&, bool);
    friend std::array<std::uint64_t, 2> maskHashOf(const Archive&, const struct FrameRecord&);
    friend bool codedAlike(const Archive&, const Archive&);
    friend std::uint64_t appendFrames(const Archive&, const Archive&, const Metadata&, std::span<const std::size_t>);
    friend class ArchiveWriter;
    struct Impl;
    explicit Archive(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// Opens an archive as a source of bricks; a D4* archive provides BCC fields (volume/sources/alternating_source.h).
/// Throws Error.
std::shared_ptr<const volume::BrickSource> openArchive(const std::string& path, const RemoteOptions& remote = {});

/// Decodes the stored samples of one component of a parameter at a time index in their type: bit for bit as packed if
/// the archive is lossless. An odd frame of D4* lies on its shifted grid. Throws Error when the data is damaged.
volume::Field readField(const Archive& archive, int parameter, int component, int time);
/// The same for the slices of the brick layers [layer, end).
volume::Field readLayers(const Archive& archive, int parameter, int component, int time, int layer, int end);

/// Computes every checksum and decodes every brick at every level, on all cores. Throws Cancelled, ReadError.
VerifyReport verifyArchive(const Archive& archive, const Progress& progress = {});

} // namespace tessera::codec
