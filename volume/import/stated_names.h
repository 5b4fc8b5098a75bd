#pragma once

#include "volume/field/dataset.h"
#include "volume/import/absent.h"
#include "volume/import/files/file_block.h"
#include "volume/import/import_options.h"
#include "volume/import/parts_rules.h"

#include <set>
#include <string>
#include <vector>

/// Names: whether those that import options state are in the data, and those of files as texts that can be shown.
namespace tessera::volume {

/// Throws Error for a name that no parameter has (in units: nor a quantity), with those that there are, and for a unit
/// of lengths or times that is none. Times that are no times (a voltage) may have any unit, parameters too.
void checkStated(const DatasetInfo& info, const ImportOptions& options, const std::vector<AbsentRule>& absent,
                 const std::vector<PartsRule>& parts);

/// "there is no parameter "Tmp" (there are T, U)".
std::string noSuchParameter(const std::string& name, const DatasetInfo& info);

/// The names that options say something about, as they are in the file and as they are renamed.
std::set<std::string> namesIn(const ImportOptions& options);

/// Makes all names, units and notes of a block texts that can be shown and written anywhere, whatever bytes the file
/// has.
void makePrintable(FileBlock& block);

} // namespace tessera::volume
