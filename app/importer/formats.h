#pragma once

#include "app/importer/readers/source.h"

#include <span>
#include <string_view>

namespace tessera::importer {

/// The reader of a row of volume/import/files/format_rows.inc: `open` reads the header of `source.path` (and
/// `source.files`) and fills in the rest of the source. Throws std::runtime_error with one line of reason.
struct Reader {
    std::string_view format;
    void (*open)(Source& source);
};

std::span<const Reader> readers();

} // namespace tessera::importer
