#include "app/importer/describe_source.h"

#include "app/importer/present.h"
#include "app/importer/readers/vtk_messages.h"
#include "volume/import/files/upright.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
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

/// The lattice of an image: of its points, or of the middles of its cells, which `box` then encloses. An axis with a
/// single layer of points has no cells, and one layer of samples. Gives a note on its axes.
std::string setLattice(BlockRef& ref, const int extent[6], const glm::dmat3& steps, const double origin[3],
                       bool cells) {
    volume::StoredGrid grid{glm::ivec3(1), {origin[0], origin[1], origin[2]}, steps};
    bool inside[3] = {}; // samples lie between points
    for (int axis = 0; axis < 3; ++axis) {
        const int points = extent[2 * axis + 1] - extent[2 * axis] + 1;
        if (points < 1) throw std::runtime_error("has an empty extent");
        inside[axis] = cells && points > 1;
        grid.size[axis] = inside[axis] ? points - 1 : points;
        if (std::isfinite(glm::length(steps[axis])))
            grid.origin += steps[axis] * (extent[2 * axis] + (inside[axis] ? 0.5 : 0.0));
    }
    const volume::UprightGrid turned = volume::upright(grid);
    const volume::Lattice& lattice = ref.block.lattice = turned.lattice;
    ref.block.cellData = cells;
    ref.block.box = {lattice.origin, lattice.position(lattice.size - 1)};
    for (int axis = 0; axis < 3; ++axis)
        if (inside[turned.from[std::size_t(axis)]]) {
            ref.block.box.lo[axis] -= lattice.spacing[axis] / 2;
            ref.block.box.hi[axis] += lattice.spacing[axis] / 2;
        }
    return turned.note;
}

/// Steps along the axes of an image by VTK's numbers.
glm::dmat3 stepsOf(const double spacing[3], const double* direction) {
    glm::dmat3 steps(1);
    for (int row = 0; row < 3; ++row)
        for (int axis = 0; axis < 3; ++axis) {
            const double step = spacing[axis] != 0 && std::isfinite(spacing[axis]) ? spacing[axis] : 1;
            steps[axis][row] = step * (direction != nullptr ? direction[3 * row + axis] : row == axis ? 1.0 : 0.0);
        }
    return steps;
}

void addNote(BlockRef& ref, const std::string& note) {
    if (!note.empty()) ref.block.notes.push_back(note);
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
    if (!source.timeName.empty()) ref.block.timeName = source.timeName;
    for (const std::string& note : source.notes) addNote(ref, note);
    for (const volume::Quantity& quantity : source.quantities) ref.block.quantities.push_back(quantity);
    for (ArrayRef& array : ref.arrays) {
        if (const auto form = source.stored.find(array.vtkName); form != source.stored.end())
            array.stored = form->second;
        if (auto* nifti = vtkNIFTIImageReader::SafeDownCast(source.reader))
            if (nifti->GetRescaleSlope() != 0)
                array.stored = {nifti->GetRescaleSlope(), nifti->GetRescaleIntercept(), {}};
        if (array.stored.scales()) array.form.type = ScalarType::F32;
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
    double spacing[3] = {1, 1, 1}, origin[3] = {0, 0, 0}, direction[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    information->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent);
    if (information->Has(vtkDataObject::SPACING()) != 0) information->Get(vtkDataObject::SPACING(), spacing);
    if (information->Has(vtkDataObject::ORIGIN()) != 0) information->Get(vtkDataObject::ORIGIN(), origin);
    if (information->Has(vtkDataObject::DIRECTION()) != 0) information->Get(vtkDataObject::DIRECTION(), direction);
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
    addNote(ref, setLattice(ref, extent, stepsOf(spacing, direction), origin,
                            !ref.arrays.empty() && ref.arrays.front().ofCells));

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
            setLattice(ref, image->GetExtent(), stepsOf(image->GetSpacing(), nullptr), image->GetOrigin(),
                       !pointData && !ref.arrays.empty());
            addNote(ref, block.note);
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

void mergeBlocks(std::vector<BlockRef>& blocks, const std::vector<BlockRef>& more) {
    for (const BlockRef& ref : more) {
        const auto known =
            std::ranges::find_if(blocks, [&](const BlockRef& block) { return block.block.name == ref.block.name; });
        if (known == blocks.end()) {
            blocks.push_back(ref);
            continue;
        }
        for (const ArrayRef& array : ref.arrays)
            if (std::ranges::none_of(known->arrays,
                                     [&](const ArrayRef& own) { return own.form.name == array.form.name; }))
                known->arrays.push_back(array);
        for (const std::string& note : ref.block.notes)
            if (std::ranges::find(known->block.notes, note) == known->block.notes.end())
                known->block.notes.push_back(note);
        known->block.box.lo = glm::min(known->block.box.lo, ref.block.box.lo);
        known->block.box.hi = glm::max(known->block.box.hi, ref.block.box.hi);
    }
}

std::string meshHead(const Source& source) {
    if (source.format != "vtu") return {};
    std::ifstream in(source.path, std::ios::binary);
    std::string text(std::size_t(1) << 16, '\0');
    in.read(text.data(), std::streamsize(text.size()));
    text.resize(std::size_t(in.gcount()));
    const std::size_t begin = text.find("<Piece"), points = text.find("<Points");
    if (begin == std::string::npos || points == std::string::npos) return {};
    const std::size_t point = text.find("RangeMin", points), end = text.find('>', point);
    if (point == std::string::npos || end == std::string::npos) return {};
    std::string head = text.substr(begin, text.find('>', begin) - begin) + text.substr(point, end - point);
    head.resize(std::min(head.size(), head.find("offset", head.find("RangeMin"))));
    auto* reader = vtkXMLReader::SafeDownCast(source.reader);
    for (int i = 0; i < reader->GetNumberOfPointArrays(); ++i) head += std::string(";") + reader->GetPointArrayName(i);
    for (int i = 0; i < reader->GetNumberOfCellArrays(); ++i) head += std::string("|") + reader->GetCellArrayName(i);
    return head;
}

vtkDataArray* findArray(vtkDataSet* data, const ArrayRef& array) {
    vtkDataSetAttributes* from = data->GetPointData();
    if (array.ofCells) from = data->GetCellData();
    if (vtkDataArray* named = from->GetArray(array.vtkName.c_str())) return named;
    return array.vtkName == "value" && from->GetNumberOfArrays() == 1 ? from->GetArray(0) : nullptr;
}

} // namespace tessera::importer
