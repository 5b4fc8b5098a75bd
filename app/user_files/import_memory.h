#pragma once

#include "volume/import/import.h"

#include <map>
#include <string>
#include <vector>

/// Import options that the user stated before, stored in $XDG_CONFIG_HOME/tessera/units.json (else ~/.config), since
/// files rarely state their units.
namespace tessera::app {

struct ImportMemory {
    std::map<std::string, std::string> units; ///< by parameter name
    /// Rules of ImportOptions::absent and names by data name (DatasetInfo::name, e.g. "small").
    std::map<std::string, std::vector<std::string>> absent;
    std::map<std::string, std::vector<std::string>> parts;  ///< rules of ImportOptions::parts, the same way
    std::map<std::string, std::vector<std::string>> labels; ///< of ImportOptions::labels
    std::map<std::string, std::map<std::string, std::string>> rename;
    std::map<std::string, std::string> lengths; ///< ImportOptions::lengthUnit by data name, for files that state none
    bool operator==(const ImportMemory&) const = default;
};

/// Path of the file; "" when there is neither XDG_CONFIG_HOME nor HOME.
std::string importMemoryPath();

/// Reads the file; a missing one is an empty memory. Throws Error with file and JSON path when it is damaged.
ImportMemory loadImportMemory(const std::string& path = importMemoryPath());

/// Writes the file (atomically, folders made). Throws MachineError.
void saveImportMemory(const ImportMemory& memory, const std::string& path = importMemoryPath());

/// The options with remembered ones added where the user states none now. `info` is the preview of the files with the
/// stated options: its name chooses rules and names, and only what fits its parameters is taken.
volume::ImportOptions withMemory(volume::ImportOptions options, const ImportMemory& memory,
                                 const volume::DatasetInfo& info);

/// Adds remembered options for these files; call before previewFiles or openFiles. For an archive only names of label
/// values are added. Where the file of what is remembered is damaged, a message says so and nothing is added.
volume::ImportOptions recallOptions(const std::vector<std::string>& paths, const volume::ImportOptions& stated,
                                    std::vector<std::string>& messages, const Progress& progress = {});
/// The same for commands: the message is printed.
volume::ImportOptions recallOptions(const std::vector<std::string>& paths, const volume::ImportOptions& stated,
                                    const Progress& progress = {});

/// Saves the stated options, if any. Ignores a file that cannot be read or written, so that opening data does not fail.
void rememberStated(const volume::ImportOptions& stated, const std::string& dataName,
                    const std::string& path = importMemoryPath());

/// Remembers the rules for the labels of a data set as they are now; parameters that only `before` names are forgotten.
void rememberLabels(const std::vector<std::string>& now, const std::vector<std::string>& before,
                    const std::string& dataName, const std::string& path = importMemoryPath());

/// Remembers what was stated. True when something is new.
bool remember(ImportMemory& memory, const volume::ImportOptions& stated, const std::string& dataName);

} // namespace tessera::app
