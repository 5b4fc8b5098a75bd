#include "app/importer/arrays/whole_numbers.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vtkIntArray.h>
#include <vtkType.h>

namespace tessera::importer {

namespace {

constexpr int kNoWhole = std::numeric_limits<int>::min();

} // namespace

bool isWide(int vtkType) {
    return vtkType == VTK_UNSIGNED_INT || vtkType == VTK_LONG_LONG || vtkType == VTK_UNSIGNED_LONG_LONG ||
           vtkType == VTK_LONG || vtkType == VTK_UNSIGNED_LONG;
}

void widen(WholeRange& range, vtkDataArray* stored, const StoredForm& form) {
    const bool masks = form.masks();
    for (vtkIdType i = 0; i < stored->GetNumberOfValues(); ++i) {
        const double value = stored->GetComponent(i, 0);
        if (masks && !form.isValue(value)) {
            range.absent = true;
            continue;
        }
        range.least = std::min(range.least, value);
        range.most = std::max(range.most, value);
    }
}

NarrowForm narrowFor(const WholeRange& range, const StoredForm& form) {
    NarrowForm narrow;
    narrow.fits = range.least > double(kNoWhole) && range.most <= double(std::numeric_limits<int>::max());
    narrow.form.scale = form.scale;
    narrow.form.offset = form.offset;
    if (range.absent) narrow.form.fill = {double(kNoWhole)};
    return narrow;
}

vtkSmartPointer<vtkDataArray> narrowed(vtkSmartPointer<vtkDataArray> stored, const StoredForm& form,
                                       const NarrowForm& narrow) {
    if (!narrow.fits) return stored;
    const bool masks = form.masks();
    auto out = vtkSmartPointer<vtkIntArray>::New();
    out->SetNumberOfTuples(stored->GetNumberOfValues());
    for (vtkIdType i = 0; i < stored->GetNumberOfValues(); ++i) {
        const double value = stored->GetComponent(i, 0);
        out->SetValue(i, masks && !form.isValue(value) ? kNoWhole : int(value));
    }
    return out;
}

float floatOfHalf(std::uint16_t bits) {
    const int exponent = (bits >> 10) & 31, fraction = bits & 1023;
    float value = std::ldexp(float(exponent == 0 ? fraction : fraction + 1024), std::max(exponent, 1) - 25);
    if (exponent == 31)
        value = fraction == 0 ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
    return (bits & 0x8000) != 0 ? -value : value;
}

std::string wordsFor(const std::string& name, const std::string& words) {
    std::string listed, out;
    for (const char c : name) {
        const bool coded = c == ' ' || c == ',' || c == ';' || c == '%';
        constexpr const char* kDigits = "0123456789ABCDEF";
        listed += coded ? std::string("%") + kDigits[c / 16] + kDigits[c % 16] : std::string(1, c);
    }
    std::istringstream in(words);
    for (std::string one; std::getline(in >> std::ws, one, ';');) out += listed + " " + one + "; ";
    return out;
}

} // namespace tessera::importer
