#include "app/importer/arrays/array_file.h"

#include "app/importer/readers/check_file.h"

namespace tessera::importer {

void refuseHollow(const StoredArray& array) {
    refuseHollow(array.statedBytes, array.storedBytes, "array \"" + array.name + "\"");
}

std::vector<double> numbersOf(const StoredArray& array) {
    const auto values = array.read({Dims(array.dims.size(), 0), array.dims});
    std::vector<double> out(std::size_t(values->GetNumberOfValues()));
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = values->GetComponent(vtkIdType(i), 0);
    return out;
}

} // namespace tessera::importer
