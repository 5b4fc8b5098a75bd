#pragma once

#include "app/importer/readers/source.h"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// COMSOL writes one array for each time, or for each value of a parameter that a study sweeps: "T @ t=0.1",
/// "Temperature_@_t=0.1", "V @ 2: I0=0.4[A], T0=300". They are one array at several times.
namespace tessera::importer {

struct SweptName {
    std::string base; ///< the array's name without conditions that are numbers
    struct Value {
        double number = 0;
        std::string unit;
    };
    std::vector<std::pair<std::string, Value>> values; ///< by parameter, in their order
    const Value* find(const std::string& parameter) const;
};

/// Takes a name apart; nothing if it has no "@" with a parameter and its number.
std::optional<SweptName> sweptName(std::string_view name);

/// What the arrays of a file become.
struct SweptArrays {
    std::string axis, axisUnit; ///< the parameter whose numbers are the times; "" = the arrays show one state
    std::vector<double> times;  ///< rising; empty where the axis is ""
    std::vector<volume::Quantity> quantities; ///< other parameters, one value for each time
    struct Place {
        std::string name; ///< of the array
        std::size_t time = 0;
    };
    std::map<std::string, Place> places; ///< by the name in the file; other arrays are the same at all times
};

/// Parameters with one number are quantities. The axis is the time if that varies, else the first that does; others
/// that vary with it are quantities over it, and those that vary by themselves stay in the names: "T, I0=0.4".
SweptArrays sortSwept(const std::vector<std::string>& names);

/// Whether the header of VTK's reader of a file names swept arrays.
bool namesSweptArrays(const Source& source);

/// Gives a source with one time, or none, whose arrays are swept the times of their names. `data`: all of it (null does
/// nothing).
void foldSweptNames(Source& source, vtkSmartPointer<vtkDataObject> data);

} // namespace tessera::importer
