#pragma once

#include "codec/archive/archive.h"
#include "codec/container/pack_options.h"
#include "volume/import/growing_series.h"
#include "volume/import/import_options.h"

#include <cstddef>
#include <optional>
#include <string>

namespace tessera::app {

/// What times of an unfinished series become: an archive that grows, and a line on stdout for each time.
struct GrowingRequest {
    std::string output; ///< archive
    volume::ImportOptions import;
    codec::PackOptions options;
    bool json = false; ///< one JSON object for each time
};

/// What a file of the series does not say of itself.
struct StatedFrame {
    std::size_t number = 0; ///< of the frame on standard input
    double time = 0;
};

/// Appends files of one series to an archive. The first file that is appended decides for all others (GrowingSeries).
class GrowingOutput {
public:
    /// An archive that is there is continued, or with `replaces` replaced by the first time. Throws Error for options
    /// that need the whole series.
    explicit GrowingOutput(GrowingRequest request, bool replaces = false);

    /// Whether there is an archive to continue.
    bool continues() const;
    /// Takes `path` for the first file of the series; false if it cannot be opened. Throws Error if the archive to
    /// continue is of another series.
    bool begin(const std::string& path);
    /// The series, once it has begun.
    const std::optional<volume::GrowingSeries>& series() const { return series_; }
    /// Appends the times of one file that are later than those of the archive. Throws Error if the file cannot be read
    /// or does not fit, MachineError if the archive cannot be written.
    void append(const std::string& path, const std::optional<StatedFrame>& stated = {});

private:
    volume::GrowingSeries openFirst(const std::string& path) const;
    void requireSameSeries(const codec::Archive& archive, const volume::GrowingSeries& series) const;

    GrowingRequest request_;
    bool replaces_;
    std::optional<volume::GrowingSeries> series_; ///< once a file of it is in the archive
};

/// Says on stderr which rules for absent samples and names are used because they were stated before.
void sayRemembered(const volume::ImportOptions& stated, const volume::ImportOptions& used);

/// "1 time", "3 times".
std::string timesCounted(std::size_t times);

} // namespace tessera::app
