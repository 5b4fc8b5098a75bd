#pragma once

#include "app/importer/arrays/array_file.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// What names and attributes mean by the CF and COARDS conventions, which files of NetCDF and HDF5 follow.
namespace tessera::importer {

struct Attribute {
    std::string text;            ///< of an attribute of text; several are joined by blanks
    std::vector<double> numbers; ///< of one of numbers
    bool floating = false;       ///< its numbers have a fraction: they may be meant as values, not as stored
};
using Attributes = std::map<std::string, Attribute>;

/// The text of an attribute without blanks around it; "" if there is none.
std::string textOf(const Attributes& attributes, const std::string& name);

std::string lowered(std::string_view text);

/// "T" of "fields/T".
std::string leafOf(const std::string& path);

/// The axis that a name means, "lon" or "bottom_top_stag"; Unknown for one that says nothing.
AxisKind kindByName(std::string_view name);

/// The axis that a coordinate stands for, by its attributes alone: axis, standard_name, units, positive.
AxisKind kindByAttributes(const Attributes& attributes);

/// Fills in what the attributes of its coordinate say about an axis, other than its places.
void describeAxis(StoredAxis& axis, const Attributes& attributes);

/// How the stored numbers of a variable become values: scale_factor, add_offset, _FillValue, missing_value, valid_min,
/// valid_max and valid_range. `vtkType` is the type of the stored numbers.
StoredForm formBy(const Attributes& attributes, int vtkType);

/// A unit as shown: "" for "1" and "-", which say that there is none.
std::string shownUnit(const std::string& unit);

/// Values of stored numbers; NaN where there is none.
std::vector<double> valuesBy(const StoredForm& form, std::vector<double> stored);

/// The words of a flag variable: "0 air; 1 solid". "" if it has none.
std::string wordsOfFlags(const Attributes& attributes);

/// "hours since 2000-01-01 06:00".
struct TimeUnit {
    std::string unit;                 ///< "h"
    std::string since;                ///< "2000-01-01 06:00"; "" = not stated
    std::optional<double> epoch = {}; ///< seconds from 1970 to it, in the common calendar; none if it cannot be told
};
TimeUnit timeUnitOf(const std::string& unit);

/// Seconds from 1970-01-01 in the Gregorian calendar to "2000-01-01T06:00:00" (or with "_" or a blank between).
std::optional<double> secondsTo(std::string_view date);

} // namespace tessera::importer
