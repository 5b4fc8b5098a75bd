#pragma once

#include "volume/import/import.h"

#include <map>
#include <string>
#include <vector>

/// What the user once stated about foreign files, kept in $XDG_CONFIG_HOME/tessera/units.json (else ~/.config): files
/// rarely say their units, and nobody wants to state them twice.
namespace tessera::app {

struct ImportMemory {
    std::map<std::string, std::string> units; ///< by parameter name
    /// Rules of ImportOptions::absent and names by data name (DatasetInfo::name, e.g. "small").
    std::map<std::string, std::vector<std::string>> absent;
    std::map<std::string, std::vector<std::string>> parts;  ///< rules of ImportOptions::parts, the same way
    std::map<std::string, std::vector<std::string>> labels; ///< of ImportOptions::labels
    std::map<std::string, std::map<std::string, std::string>> rename;
    bool operator==(const ImportMemory&) const = default;
};

/// Path of the file; "" when there is neither XDG_CONFIG_HOME nor HOME.
std::string importMemoryPath();

/// Reads the file; a missing one is an empty memory. Throws Error with file and JSON path when it is damaged.
ImportMemory loadImportMemory(const std::string& path = importMemoryPath());

/// Writes the file (atomically, folders made). Throws MachineError.
void saveImportMemory(const ImportMemory& memory, const std::string& path = importMemoryPath());

/// Options with what is remembered for parameters and rules the user does not state now. `info` is the preview of the
/// files with the stated options: its name chooses rules and names, and only what fits its parameters is taken.
volume::ImportOptions withMemory(volume::ImportOptions options, const ImportMemory& memory,
                                 const volume::DatasetInfo& info);

/// Looks at the files and adds what is remembered for them; the one call before previewFiles or openFiles. Of what an
/// archive says only the names of label values are added to.
volume::ImportOptions recallOptions(const std::vector<std::string>& paths, const volume::ImportOptions& stated,
                                    const Progress& progress = {});

/// Adds what was stated to the file, if anything was. A file that cannot be read or written is left: opening data does
/// not fail for it.
void rememberStated(const volume::ImportOptions& stated, const std::string& dataName,
                    const std::string& path = importMemoryPath());

/// Remembers the rules for the labels of a data set as they are now; parameters that only `before` names are forgotten.
void rememberLabels(const std::vector<std::string>& now, const std::vector<std::string>& before,
                    const std::string& dataName, const std::string& path = importMemoryPath());

/// Remembers what was stated. True when something is new.
bool remember(ImportMemory& memory, const volume::ImportOptions& stated, const std::string& dataName);

} // namespace tessera::app
