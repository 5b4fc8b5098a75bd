#include "app/importer/readers/source.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkFieldData.h>

namespace tessera::importer {

double meantTime(double time) {
    if (time != double(float(time))) return time;
    char text[32];
    std::snprintf(text, sizeof text, "%.7g", time);
    const double meant = std::stod(text);
    return float(meant) == float(time) ? meant : time;
}

bool StoredForm::isValue(double stored) const {
    return stored >= lowest && stored <= highest && std::ranges::find(fill, stored) == fill.end(); // not of NaN
}

void findTime(vtkDataObject* data, std::vector<double>& times) {
    if (data == nullptr || data->GetFieldData() == nullptr) return;
    for (const std::string_view name : kTimeNames) {
        vtkDataArray* value = data->GetFieldData()->GetArray(std::string(name).c_str());
        if (value == nullptr || value->GetNumberOfValues() != 1 || !std::isfinite(value->GetComponent(0, 0))) continue;
        times.push_back(meantTime(value->GetComponent(0, 0)));
        return;
    }
}

} // namespace tessera::importer
