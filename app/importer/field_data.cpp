#include "app/importer/describe_source.h"
#include "app/importer/readers/vtk_messages.h"

#include <algorithm>
#include <sstream>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

/// What VTK files say in their field data: times, quantities, units, names.
namespace tessera::importer {

namespace {

/// Makes the reader skip the points and cells of a file.
class FieldDataReader : public vtkXMLUnstructuredGridReader {
public:
    static FieldDataReader* New() {
        auto* reader = new FieldDataReader;
        reader->InitializeObjectBase();
        return reader;
    }

protected:
    void ReadXMLData() override { ReadFieldData(); }
};

/// Whether VTK files use this name for a time.
bool isTimeName(const std::string& name) {
    return std::ranges::find(kTimeNames, name) != kTimeNames.end();
}

/// Undoes %20, %2C, %3B and %25 in a listed name.
std::string unlisted(const std::string& text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::string code = text.substr(i, 3);
        const bool known = code == "%20" || code == "%2C" || code == "%3B" || code == "%25";
        out += known ? static_cast<char>(std::stoi(code.substr(1), nullptr, 16)) : text[i];
        if (known) i += 2;
    }
    return out;
}

/// Units, labels and the unit of lengths from the field data, in the form exportDataset writes:
/// "O2,H2 mol/m3; T K; region -" and "region 1 air side; ...".
void readWords(vtkFieldData* data, volume::FileBlock& block, std::vector<ArrayRef>& arrays) {
    const auto text = [&](const char* name) -> std::string {
        auto* words = data != nullptr ? vtkStringArray::SafeDownCast(data->GetAbstractArray(name)) : nullptr;
        return words != nullptr && words->GetNumberOfValues() > 0 ? std::string(words->GetValue(0)) : std::string();
    };
    const auto each = [](const std::string& list, char separator, const auto& body) {
        std::istringstream in(list);
        for (std::string item; std::getline(in, item, separator);) {
            const std::size_t begin = item.find_first_not_of(' ');
            if (begin != std::string::npos) body(item.substr(begin, item.find_last_not_of(' ') - begin + 1));
        }
    };
    each(text("units"), ';', [&](const std::string& item) {
        const std::size_t space = item.find(' ');
        if (space == std::string::npos) return;
        const std::string unit = item.substr(space + 1);
        each(item.substr(0, space), ',', [&](const std::string& listed) {
            const std::string name = unlisted(listed);
            for (ArrayRef& array : arrays)
                if (array.form.name == name && unit != "-") array.form.unit = unit;
            for (volume::Quantity& quantity : block.quantities)
                if (quantity.name == name && unit != "-") quantity.unit = unit;
            if (isTimeName(name) && unit != "-") block.timeUnit = unit;
        });
    });
    each(text("labels"), ';', [&](const std::string& item) {
        std::istringstream in(item);
        std::string name, words;
        int value = 0;
        if (!(in >> name >> value) || !std::getline(in >> std::ws, words)) return;
        for (ArrayRef& array : arrays)
            if (array.form.name == unlisted(name)) array.form.labels.push_back({value, words});
    });
    block.lengthUnit = text("length_unit");
    block.timeName = text("time_name");
    if (const std::string unit = text("time_unit"); !unit.empty()) block.timeUnit = unit;
}

} // namespace

bool isVtkHelper(const std::string& name) {
    return name.empty() || name == "vtkValidPointMask" || name == "vtkGhostType" || name == "vtkGhostLevels" ||
           name == "vtkOriginalPointIds" || name == "vtkOriginalCellIds";
}

void describeFieldData(vtkFieldData* data, volume::FileBlock& block, std::vector<ArrayRef>& arrays) {
    if (data == nullptr) return;
    for (int i = 0; i < data->GetNumberOfArrays(); ++i) {
        vtkDataArray* array = data->GetArray(i);
        if (array == nullptr || array->GetName() == nullptr || array->GetNumberOfValues() != 1) continue;
        const std::string name = array->GetName();
        if (isVtkHelper(name) || isTimeName(name)) continue;
        block.quantities.push_back({name, "", {meantTime(array->GetComponent(0, 0))}});
    }
    readWords(data, block, arrays);
}

vtkSmartPointer<vtkFieldData> fieldDataAlone(const std::string& path) {
    vtkNew<FieldDataReader> reader;
    reader->SetFileName(path.c_str());
    reader->Update();
    throwReported();
    return reader->GetOutput()->GetFieldData();
}

} // namespace tessera::importer
