#include "app/importer/readers/source.h"

#include "app/importer/readers/check_file.h"
#include "volume/base/trimmed.h"
#include "volume/base/unit_conversion.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkFieldData.h>
#include <vtkNIFTIImageHeader.h>
#include <vtkNIFTIImageReader.h>

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

namespace {

/// VTK says "um" of a MetaImage that states no unit.
std::string lengthUnitOfMeta(const std::string& path) {
    std::istringstream head(readPart(path, 0, 1 << 16));
    for (std::string line; std::getline(head, line);) {
        const std::size_t equals = line.find('=');
        if (equals == std::string::npos) break; // samples
        const std::string_view key = volume::trimmed(std::string_view(line).substr(0, equals));
        if (key == "DistanceUnits") return volume::lengthUnitNamed(volume::trimmed(line.substr(equals + 1)));
        if (key == "ElementDataFile") break;
    }
    return {};
}

} // namespace

std::string lengthUnitInHeader(const Source& source) {
    if (source.format == "MetaImage") return lengthUnitOfMeta(source.path);
    auto* nifti = vtkNIFTIImageReader::SafeDownCast(source.reader);
    vtkNIFTIImageHeader* header = nifti != nullptr ? nifti->GetNIFTIHeader() : nullptr;
    if (header == nullptr) return {};
    switch (header->GetXYZTUnits() & vtkNIFTIImageHeader::UnitsSpace) { // VTK leaves the numbers as they are
    case vtkNIFTIImageHeader::UnitsMeter:
        return "m";
    case vtkNIFTIImageHeader::UnitsMM:
        return "mm";
    case vtkNIFTIImageHeader::UnitsMicron:
        return "um";
    default:
        return {};
    }
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
