#pragma once

#include "codec/lifting.h"
#include "codec/metadata.h"
#include "codec/numbers.h"
#include "volume/progress.h"

#include <memory>
#include <optional>
#include <string>

namespace tessera::codec {

/// How one frame is coded.
struct FrameOptions {
    std::optional<Wavelet> wavelet = Wavelet::W22; ///< none: the best of some, by trial
    double maxError = 0;                           ///< absolute, in stored units; 0: every sample exactly
    bool keepsAbsent = false;                      ///< also the stored numbers of absent samples
    int zstdLevel = 3;
};

/// Writes an archive frame by frame into a temporary file beside `path`, which takes its name in finish() and
/// disappears if that is not reached. One frame and its coded bytes are in memory at a time.
class ArchiveWriter {
public:
    /// `metadata` gives the shape (lattice, grid, parameters, times); throws MachineError when the file cannot be made.
    ArchiveWriter(const std::string& path, const Metadata& metadata);
    ~ArchiveWriter();
    ArchiveWriter(const ArchiveWriter&) = delete;
    ArchiveWriter& operator=(const ArchiveWriter&) = delete;

    /// Codes and writes one component of a parameter at a time index; each once, in any order. The field must lie on
    /// the lattice of the metadata and have the parameter's type. Bricks are coded on all cores; the bytes do not
    /// depend on how many there are.
    void addFrame(int parameter, int component, int time, const volume::Field& field, const FrameOptions& options,
                  const Progress& progress = {});

    /// Writes metadata (now with ranges) and index and gives the file its name. Returns its bytes.
    std::uint64_t finish(const Metadata& metadata);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace tessera::codec
