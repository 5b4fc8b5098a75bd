#pragma once

#include "app/importer/readers/source.h"

#include <cstdint>
#include <limits>
#include <string>
#include <vtkDataArray.h>

/// Numbers of other widths than those handed over, and names of whole numbers.
namespace tessera::importer {

/// Whether numbers of this type of VTK may be beyond a signed number of 32 bits.
bool isWide(int vtkType);

struct WholeRange {
    double least = std::numeric_limits<double>::infinity(), most = -std::numeric_limits<double>::infinity();
    bool absent = false; ///< some are no values
    bool inexact() const { return least < -16777216 || most > 16777216; }
};
void widen(WholeRange& range, vtkDataArray* stored, const StoredForm& form);

/// How wide whole numbers are handed over: as 32 bits where all values fit, absent ones as the least number.
struct NarrowForm {
    bool fits = false;
    StoredForm form;
};
NarrowForm narrowFor(const WholeRange& range, const StoredForm& form);

vtkSmartPointer<vtkDataArray> narrowed(vtkSmartPointer<vtkDataArray> stored, const StoredForm& form,
                                       const NarrowForm& narrow);

/// A number of 16 bits with a fraction (IEEE 754 binary16).
float floatOfHalf(std::uint16_t bits);

/// "0 air; 1 solid" as field data names it: "name 0 air; name 1 solid; ".
std::string wordsFor(const std::string& name, const std::string& words);

} // namespace tessera::importer
