#include "app/importer/describe_source.h"

#include "app/importer/readers/vtk_messages.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <vtkCellData.h>
#include <vtkDataArraySelection.h>
#include <vtkDataObject.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNetCDFReader.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLReader.h>
#include <vtkXMLUnstructuredGridReader.h>

namespace tessera::importer {

namespace {

using volume::ScalarType;

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

ScalarType typeOf(int vtkType) {
    switch (vtkType) {
    case VTK_UNSIGNED_CHAR:
        return ScalarType::U8;
    case VTK_CHAR:
    case VTK_SIGNED_CHAR:
    case VTK_SHORT:
        return ScalarType::I16;
    case VTK_UNSIGNED_SHORT:
        return ScalarType::U16;
    case VTK_INT:
        return ScalarType::I32;
    default:
        return ScalarType::F32;
    }
}

bool isHelper(const std::string& name) {
    return name.empty() || name == "vtkValidPointMask" || name == "vtkGhostType" || name == "vtkGhostLevels" ||
           name == "vtkOriginalPointIds" || name == "vtkOriginalCellIds";
}

void addArray(BlockRef& ref, const std::string& name, int vtkType, int components, bool ofCells) {
    if (isHelper(name) || components < 1 || components > 16) return;
    for (const ArrayRef& other : ref.arrays)
        if (other.vtkName == name) return;
    const std::string shown =
        name == "ImageFile" || name == "MetaImage" || name == "NIFTI" || name == "scalars" || name == "ImageScalars"
            ? "value"
            : name;
    const auto add = [&](const std::string& label, int count, int first) {
        ref.arrays.push_back({{label, "", count, typeOf(vtkType), false, {}}, ofCells, name, first});
    };
    if (components == 1 || components == 3) {
        add(shown, components, 0);
        return;
    }
    for (int c = 0; c < components; ++c) add(shown + "." + std::to_string(c), 1, c);
}

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

void setLattice(BlockRef& ref, const int extent[6], const double spacing[3], const double origin[3], bool cells) {
    for (int axis = 0; axis < 3; ++axis) {
        const int points = extent[2 * axis + 1] - extent[2 * axis] + 1;
        const double step = spacing[axis] != 0 && std::isfinite(spacing[axis]) ? std::abs(spacing[axis]) : 1;
        const bool shift = cells && points > 1;
        ref.block.lattice.size[axis] = shift ? points - 1 : points;
        ref.block.lattice.spacing[axis] = step;
        ref.block.lattice.origin[axis] =
            (std::isfinite(origin[axis]) ? origin[axis] : 0) + step * (extent[2 * axis] + (shift ? 0.5 : 0.0));
        if (points < 1) throw std::runtime_error("has an empty extent");
    }
}

void finish(Source& source, BlockRef& ref) {
    ref.block.times = source.times;
    if (source.format == "OpenFOAM") ref.block.timeUnit = "s";
    for (ArrayRef& array : ref.arrays)
        if (const auto unit = source.units.find(array.vtkName); unit != source.units.end())
            array.form.unit = unit->second;
    const std::string unit = source.lengthUnit.empty() ? lengthUnitInHeader(source) : source.lengthUnit;
    if (!unit.empty()) ref.block.lengthUnit = unit;
    if (!source.timeUnit.empty()) ref.block.timeUnit = source.timeUnit;
    ref.block.note = source.note;
    if (auto* nifti = vtkNIFTIImageReader::SafeDownCast(source.reader)) {
        ref.scale = nifti->GetRescaleSlope();
        ref.offset = nifti->GetRescaleIntercept();
        if (ref.scale == 0) ref.scale = 1;
        if (ref.scale != 1 || ref.offset != 0)
            for (ArrayRef& array : ref.arrays) array.form.type = ScalarType::F32;
    }
    if (auto* netCdf = vtkNetCDFReader::SafeDownCast(source.reader)) {
        for (ArrayRef& array : ref.arrays) array.form.unit = netCdf->QueryArrayUnits(array.vtkName.c_str());
        if (netCdf->GetTimeUnits() != nullptr) ref.block.timeUnit = netCdf->GetTimeUnits();
    }
}

/// Harmonic mean of the extents of the cells per axis.
glm::dvec3 meanCellSize(vtkDataSet* mesh) {
    glm::dvec3 inverse(0);
    double largest = 0;
    const double* box = mesh->GetBounds();
    for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, box[2 * axis + 1] - box[2 * axis]);
    const vtkIdType count = mesh->GetNumberOfCells();
    for (vtkIdType c = 0; c < count; ++c) {
        double bounds[6];
        mesh->GetCellBounds(c, bounds);
        for (int axis = 0; axis < 3; ++axis)
            inverse[axis] += 1 / std::max(bounds[2 * axis + 1] - bounds[2 * axis], 1e-7 * largest);
    }
    return glm::dvec3(double(count)) / inverse;
}

} // namespace

std::vector<BlockRef> describeImageHeader(Source& source) {
    auto* xml = vtkXMLReader::SafeDownCast(source.reader);
    if (xml == nullptr || source.format != "vti") return {};
    vtkInformation* information = source.reader->GetOutputInformation(0);
    int extent[6] = {};
    double spacing[3] = {1, 1, 1}, origin[3] = {0, 0, 0};
    information->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent);
    if (information->Has(vtkDataObject::SPACING()) != 0) information->Get(vtkDataObject::SPACING(), spacing);
    if (information->Has(vtkDataObject::ORIGIN()) != 0) information->Get(vtkDataObject::ORIGIN(), origin);
    BlockRef ref;
    const auto add = [&](vtkInformationInformationVectorKey* key, bool ofCells) {
        vtkInformationVector* arrays = information->Get(key);
        for (int i = 0; arrays != nullptr && i < arrays->GetNumberOfInformationObjects(); ++i) {
            vtkInformation* array = arrays->GetInformationObject(i);
            const char* name = array->Get(vtkDataObject::FIELD_NAME());
            if (name == nullptr || array->Has(vtkDataObject::FIELD_ARRAY_TYPE()) == 0) continue;
            const int components = array->Has(vtkDataObject::FIELD_NUMBER_OF_COMPONENTS()) != 0
                                       ? array->Get(vtkDataObject::FIELD_NUMBER_OF_COMPONENTS())
                                       : 1;
            addArray(ref, name, array->Get(vtkDataObject::FIELD_ARRAY_TYPE()), components, ofCells);
        }
    };
    add(vtkDataObject::POINT_DATA_VECTOR(), false);
    if (ref.arrays.empty()) add(vtkDataObject::CELL_DATA_VECTOR(), true);
    const int named = xml->GetNumberOfPointArrays() > 0 ? xml->GetNumberOfPointArrays() : xml->GetNumberOfCellArrays();
    if (ref.arrays.empty() && named > 0) return {}; // the header does not state the types
    setLattice(ref, extent, spacing, origin, !ref.arrays.empty() && ref.arrays.front().ofCells);

    // With all arrays disabled, an update reads only the field data.
    xml->GetPointDataArraySelection()->DisableAllArrays();
    xml->GetCellDataArraySelection()->DisableAllArrays();
    xml->Update();
    throwReported();
    vtkDataObject* output = xml->GetOutputDataObject(0);
    describeFieldData(output->GetFieldData(), ref.block, ref.arrays);
    if (source.times.empty()) findTime(output, source.times);
    xml->GetPointDataArraySelection()->EnableAllArrays();
    xml->GetCellDataArraySelection()->EnableAllArrays();
    finish(source, ref);
    return {ref};
}

std::vector<BlockRef> describeBlocks(const Source& given, const std::vector<Block>& blocks) {
    Source source = given;
    if (source.times.empty()) findTime(blocks.front().data, source.times);
    std::vector<BlockRef> described;
    for (const Block& block : blocks) {
        vtkDataSet* data = block.data;
        BlockRef ref;
        ref.block.name = block.name;
        for (int i = 0; i < data->GetPointData()->GetNumberOfArrays(); ++i)
            if (vtkDataArray* array = data->GetPointData()->GetArray(i))
                addArray(ref, array->GetName() != nullptr ? array->GetName() : "value", array->GetDataType(),
                         array->GetNumberOfComponents(), false);
        const bool pointData = !ref.arrays.empty();
        for (int i = 0; i < data->GetCellData()->GetNumberOfArrays(); ++i)
            if (vtkDataArray* array = data->GetCellData()->GetArray(i))
                addArray(ref, array->GetName() != nullptr ? array->GetName() : "value", array->GetDataType(),
                         array->GetNumberOfComponents(), true);
        if (auto* image = vtkImageData::SafeDownCast(data)) {
            setLattice(ref, image->GetExtent(), image->GetSpacing(), image->GetOrigin(),
                       !pointData && !ref.arrays.empty());
            if (pointData) // cell values would need another grid
                std::erase_if(ref.arrays, [](const ArrayRef& array) { return array.ofCells; });
        } else {
            ref.block.mesh = true;
            ref.block.cellData = !pointData;
            ref.block.cells = double(data->GetNumberOfCells());
            const double* box = data->GetBounds();
            ref.block.box = {{box[0], box[2], box[4]}, {box[1], box[3], box[5]}};
            ref.block.cellSize = meanCellSize(data);
        }
        describeFieldData(data->GetFieldData(), ref.block, ref.arrays);
        if (source.times.size() > 1) ref.block.quantities.clear(); // they belong to one time only
        finish(source, ref);
        described.push_back(std::move(ref));
    }
    return described;
}

void describeFieldData(vtkFieldData* data, volume::FileBlock& block, std::vector<ArrayRef>& arrays) {
    if (data == nullptr) return;
    for (int i = 0; i < data->GetNumberOfArrays(); ++i) {
        vtkDataArray* array = data->GetArray(i);
        if (array == nullptr || array->GetName() == nullptr || array->GetNumberOfValues() != 1) continue;
        const std::string name = array->GetName();
        if (isHelper(name) || isTimeName(name)) continue;
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

vtkDataArray* findArray(vtkDataSet* data, const ArrayRef& array) {
    vtkDataSetAttributes* from = data->GetPointData();
    if (array.ofCells) from = data->GetCellData();
    if (vtkDataArray* named = from->GetArray(array.vtkName.c_str())) return named;
    return array.vtkName == "value" && from->GetNumberOfArrays() == 1 ? from->GetArray(0) : nullptr;
}

std::string rangesJson(vtkDataSet* data, vtkDataArray* values, const ArrayRef& array) {
    std::vector<std::uint8_t> used(std::size_t(values->GetNumberOfTuples()), array.ofCells ? 1 : 0);
    if (!array.ofCells) {
        vtkNew<vtkIdList> points;
        for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c) {
            data->GetCellPoints(c, points);
            for (vtkIdType i = 0; i < points->GetNumberOfIds(); ++i) {
                const auto point = std::size_t(points->GetId(i));
                if (point < used.size()) used[point] = 1;
            }
        }
    }
    const int components = array.form.components;
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::vector<double> lo(std::size_t(components > 1 ? components + 1 : 1), kInfinity), hi(lo.size(), -kInfinity);
    const auto widen = [&](std::size_t i, double value) {
        lo[i] = std::min(lo[i], value);
        hi[i] = std::max(hi[i], value);
    };
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (used[i] == 0) continue;
        double square = 0;
        for (int c = 0; c < components; ++c) {
            const double value = values->GetComponent(vtkIdType(i), array.firstComponent + c);
            if (std::isfinite(value)) widen(std::size_t(c), value);
            square += value * value;
        }
        if (components > 1 && std::isfinite(square)) widen(std::size_t(components), std::sqrt(square));
    }
    nlohmann::json ranges = nlohmann::json::array();
    for (std::size_t i = 0; i < lo.size(); ++i)
        ranges.push_back(lo[i] <= hi[i] ? nlohmann::json{lo[i], hi[i]} : nlohmann::json());
    return nlohmann::json{{"ranges", ranges}}.dump();
}

std::string headerJson(const std::vector<BlockRef>& blocks) {
    using json = nlohmann::ordered_json;
    const auto triple = [](const auto& v) { return json::array({v.x, v.y, v.z}); };
    json out;
    out["format"] = blocks.front().block.format;
    out["blocks"] = json::array();
    for (const BlockRef& ref : blocks) {
        const volume::FileBlock& block = ref.block;
        json entry;
        entry["name"] = block.name;
        entry["mesh"] = block.mesh;
        entry["cellData"] = block.cellData;
        entry["dims"] = triple(block.lattice.size);
        entry["spacing"] = triple(block.lattice.spacing);
        entry["origin"] = triple(block.lattice.origin);
        entry["box"] = {block.box.lo.x, block.box.lo.y, block.box.lo.z, block.box.hi.x, block.box.hi.y, block.box.hi.z};
        entry["cells"] = {block.cells};
        entry["cellSize"] = triple(block.cellSize);
        entry["lengthUnit"] = block.lengthUnit;
        entry["timeName"] = block.timeName;
        entry["timeUnit"] = block.timeUnit;
        if (!block.note.empty()) entry["note"] = block.note;
        entry["times"] = block.times;
        entry["quantities"] = json::array();
        for (const volume::Quantity& quantity : block.quantities) {
            json values = json::array();
            for (const double value : quantity.values) values.push_back(std::isfinite(value) ? json(value) : json());
            entry["quantities"].push_back({{"name", quantity.name}, {"unit", quantity.unit}, {"values", values}});
        }
        entry["arrays"] = json::array();
        for (const ArrayRef& array : ref.arrays) {
            json words;
            words["name"] = array.form.name;
            words["unit"] = array.form.unit;
            words["components"] = array.form.components;
            words["type"] = volume::name(array.form.type);
            for (const volume::Label& label : array.form.labels)
                words["labels"][std::to_string(label.value)] = label.name;
            entry["arrays"].push_back(std::move(words));
        }
        out["blocks"].push_back(std::move(entry));
    }
    return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

} // namespace tessera::importer
