#pragma once

#include "codec/remote/remote_options.h"
#include "volume/import/import.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace tessera::app {

/// Adds the options of every command that opens foreign files: --grid, --raw, --absent, --no-auto-absent, --rename,
/// --unit, --length-unit, --times, --parameters. `options` must outlive the parsing.
void addImportOptions(CLI::App& command, volume::ImportOptions& options);

/// Adds the options of every command that opens archives: --remote.cache and so on. `options` must outlive the parsing.
void addRemoteOptions(CLI::App& command, codec::RemoteOptions& options);
/// Adds --allow-remote to a command that opens sessions, which may name other machines.
void addAllowRemoteOption(CLI::App& command);

/// What `tessera info DATAFILE` prints: dims, spacing, parameters with type and unit, times, bytes, notes.
std::string describePreview(const volume::ImportPreview& preview);
/// How many times there are, and which: "6: 0 .. 50 min".
std::string timesText(const volume::DatasetInfo& info);
/// Quantities over time as lines of text, and as JSON: [{name, unit, values}].
std::string quantityLines(const volume::DatasetInfo& info);
nlohmann::json quantitiesJson(const volume::DatasetInfo& info);

/// The same with stable keys, as JSON text.
std::string describePreviewJson(const volume::ImportPreview& preview);

/// The options that state `options` again on another command line of the program.
std::vector<std::string> importArguments(const volume::ImportOptions& options);

} // namespace tessera::app
