#pragma once

#include "volume/field/dataset.h"

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>
#include <vtkAlgorithm.h>
#include <vtkDataObject.h>
#include <vtkSmartPointer.h>

/// The result of a reader: an opened file.
namespace tessera::importer {

/// How the stored numbers of an array become values, and which of them are none. Stored numbers are compared before
/// they are scaled; NaN is never a value.
struct StoredForm {
    double scale = 1, offset = 0; ///< value = offset + scale * stored
    std::vector<double> fill;     ///< stored numbers that mean "no value"
    double lowest = -std::numeric_limits<double>::infinity();
    double highest = std::numeric_limits<double>::infinity(); ///< stored numbers beyond these are no values
    bool operator==(const StoredForm&) const = default;

    bool scales() const { return scale != 1 || offset != 0; }
    bool masks() const { return *this != StoredForm{scale, offset, {}}; }
    bool isValue(double stored) const;
};

/// An opened file, of which only the header has been read.
struct Source {
    std::string path, format;
    std::vector<std::string> files;       ///< slices of one volume, `path` first; else empty
    vtkSmartPointer<vtkAlgorithm> reader; ///< VTK's reader; null if `read` is set instead
    std::function<vtkSmartPointer<vtkDataObject>(std::size_t time)> read;
    /// Throws if the files of a time are shorter than their headers state; called before they are read.
    std::function<void(const Source& self, std::size_t time)> check;
    std::function<void(vtkDataObject*)> mark; ///< marks in what VTK read the points and cells that no file holds
    std::vector<double> times;                ///< empty: not stated
    std::vector<double> readerTimes;          ///< the same, as VTK's reader has them (float32 converted to double)
    std::map<std::string, std::string> units; ///< stated by the file, by array
    std::map<std::string, StoredForm> stored; ///< by array; others are values as they stand
    std::map<std::string, std::vector<volume::Label>> labels; ///< stated by the file, by array
    std::string lengthUnit, timeUnit;                         ///< stated by the file
    std::string timeName; ///< what the times count, where it is no time (a voltage); "" = not stated
    std::vector<volume::Quantity> quantities; ///< stated by the file: one number for each time
    /// For the user: how the samples were obtained, what is guessed, what was left out, each in one sentence.
    std::vector<std::string> notes;
    /// The same, found while times are read: by `read`, which sees no source.
    std::shared_ptr<std::vector<std::string>> found = std::make_shared<std::vector<std::string>>();
    /// Indices of times that together show every block and array: those where fields begin later, too.
    std::vector<std::size_t> shownAt{0};
};

/// Names of time values in VTK files.
inline constexpr std::array<std::string_view, 3> kTimeNames = {"TimeValue", "TIME", "Time"};

/// Undoes float32 rounding of a time: 0.1 for the double of the float32 nearest to 0.1.
double meantTime(double time);

/// Time stated in the field data (TimeValue), appended to `times`.
void findTime(vtkDataObject* data, std::vector<double>& times);

} // namespace tessera::importer
