#include "app/importer/describe_source.h"

#include "app/importer/even_grid.h"
#include "app/importer/mesh_events.h"
#include "app/importer/present_cells.h"
#include "app/importer/readers/vtk_messages.h"
#include "volume/import/files/upright.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
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
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLReader.h>
#include <vtkXMLUnstructuredGridReader.h>

namespace tessera::importer {

namespace {

using volume::ScalarType;

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

void addArray(BlockRef& ref, const std::string& name, int vtkType, int components, bool ofCells) {
    if (isVtkHelper(name) || components < 1 || components > 16) return;
    for (const ArrayRef& other : ref.arrays)
        if (other.vtkName == name) return;
    const std::string shown = name == "ImageFile" || name == "scalars" || name == "ImageScalars" ? "value" : name;
    const auto add = [&](const std::string& label, int count, int first) {
        ref.arrays.push_back({{label, "", count, typeOf(vtkType), false, {}}, ofCells, name, first});
    };
    if (components == 1 || components == 3) {
        add(shown, components, 0);
        return;
    }
    for (int c = 0; c < components; ++c) add(shown + "." + std::to_string(c), 1, c);
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

/// Notes stand in lists: a sentence loses its capital and its point.
void addNote(BlockRef& ref, std::string note) {
    if (note.empty()) return;
    if (note.size() > 1 && note.ends_with('.')) {
        note.pop_back();
        if (std::islower(static_cast<unsigned char>(note[1])) != 0 || note[1] == ' ')
            note[0] = char(std::tolower(static_cast<unsigned char>(note[0])));
    }
    ref.block.notes.push_back(std::move(note));
}

/// Says that an array of cells is left out of an image: it would need another grid than those of points.
void addNoteOfCells(BlockRef& ref, const std::string& name) {
    if (!isVtkHelper(name)) addNote(ref, "values of cells are left out, beside values of points: " + name);
}

void finish(Source& source, BlockRef& ref) {
    ref.block.times = source.times;
    ref.block.quantities.insert(ref.block.quantities.end(), source.quantities.begin(), source.quantities.end());
    for (ArrayRef& array : ref.arrays)
        if (const auto unit = source.units.find(array.vtkName); unit != source.units.end())
            array.form.unit = unit->second;
    if (!source.lengthUnit.empty()) ref.block.lengthUnit = source.lengthUnit;
    if (!source.timeUnit.empty()) ref.block.timeUnit = source.timeUnit;
    if (!source.timeName.empty()) ref.block.timeName = source.timeName;
    for (const std::string& note : source.notes) addNote(ref, note);
    for (const std::string& note : *source.found) addNote(ref, note);
    for (ArrayRef& array : ref.arrays) {
        if (const auto form = source.stored.find(array.vtkName); form != source.stored.end())
            array.stored = form->second;
        if (array.stored.scales()) array.form.type = ScalarType::F32;
        if (const auto labels = source.labels.find(array.vtkName); labels != source.labels.end())
            array.form.labels = labels->second;
    }
}

/// Whether reading the numbers as 32-bit floating point changes one of them.
bool losesDigits(vtkDataArray* from) {
    const int type = from->GetDataType();
    if (typeOf(type) != ScalarType::F32 || type == VTK_FLOAT) return false;
    for (vtkIdType i = 0; i < from->GetNumberOfTuples(); ++i)
        for (int c = 0; c < from->GetNumberOfComponents(); ++c)
            if (const double value = from->GetComponent(i, c); std::isfinite(value) && double(float(value)) != value)
                return true;
    return false;
}

/// Names the arrays whose numbers are rounded.
void noteRounded(BlockRef& ref, vtkDataSet* data) {
    std::string names;
    for (const ArrayRef& array : ref.arrays) {
        vtkDataArray* from = findArray(data, array);
        if (from != nullptr && losesDigits(from)) names += (names.empty() ? "" : ", ") + array.form.name;
    }
    if (!names.empty()) addNote(ref, "64-bit numbers are read as 32-bit ones, with 7 digits: " + names);
}

/// The lattice of an uneven grid, whose axes rise: of its points, or of the middles of its cells. An axis with a single
/// layer of points has one layer of samples.
void setAxes(BlockRef& ref, vtkRectilinearGrid* grid, bool cells) {
    vtkDataArray* const places[] = {grid->GetXCoordinates(), grid->GetYCoordinates(), grid->GetZCoordinates()};
    volume::Lattice even;
    volume::AxisMaps axes;
    ref.block.cellData = cells;
    ref.block.cells = 1;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> planes;
        for (vtkIdType i = 0; i < places[axis]->GetNumberOfTuples(); ++i)
            planes.push_back(places[axis]->GetComponent(i, 0));
        even.origin[axis] = planes.front();
        if (planes.size() < 2) continue;
        const auto count = double(planes.size() - 1);
        double perLength = 0;
        for (std::size_t i = 1; i < planes.size(); ++i) perLength += 1 / (planes[i] - planes[i - 1]);
        ref.block.cells *= count;
        ref.block.cellSize[axis] = count / perLength;
        even.spacing[axis] = (planes.back() - planes.front()) / count;
        even.size[axis] = int(planes.size()) - (cells ? 1 : 0);
        if (cells) even.origin[axis] += 0.5 * even.spacing[axis];
        if (!isEven(planes))
            axes.of[std::size_t(axis)] = std::make_shared<const volume::AxisMap>(
                cells ? volume::AxisMap::Of::Cells : volume::AxisMap::Of::Points, std::move(planes));
    }
    ref.block.lattice = volume::withAxes(even, std::move(axes));
    const double* box = grid->GetBounds();
    ref.block.box = {{box[0], box[2], box[4]}, {box[1], box[3], box[5]}};
}

/// Where places of cells are listed one block has less room with others beside it.
std::size_t mostEventsOf(std::size_t blocks) {
    return std::clamp<std::size_t>(60'000 / std::max<std::size_t>(blocks, 1), 200, 3000);
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
    if (ref.arrays.empty())
        add(vtkDataObject::CELL_DATA_VECTOR(), true);
    else
        for (int i = 0; i < xml->GetNumberOfCellArrays(); ++i) addNoteOfCells(ref, xml->GetCellArrayName(i));
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
        std::string both; // of a mesh: fields of cells that are stored at points, too, interpolated
        for (int i = 0; i < data->GetPointData()->GetNumberOfArrays(); ++i)
            if (vtkDataArray* array = data->GetPointData()->GetArray(i)) {
                const std::string name = array->GetName() != nullptr ? array->GetName() : "value";
                if (vtkImageData::SafeDownCast(data) == nullptr && !isVtkHelper(name) &&
                    data->GetCellData()->HasArray(name.c_str()) != 0)
                    both += (both.empty() ? "" : ", ") + name;
                else
                    addArray(ref, name, array->GetDataType(), array->GetNumberOfComponents(), false);
            }
        if (!both.empty()) addNote(ref, "Stored in cells and at points, shown as in cells: " + both + ".");
        const bool pointData = !ref.arrays.empty();
        for (int i = 0; i < data->GetCellData()->GetNumberOfArrays(); ++i)
            if (vtkDataArray* array = data->GetCellData()->GetArray(i))
                addArray(ref, array->GetName() != nullptr ? array->GetName() : "value", array->GetDataType(),
                         array->GetNumberOfComponents(), true);
        if (auto* image = vtkImageData::SafeDownCast(data)) {
            setLattice(ref, image->GetExtent(), stepsOf(image->GetSpacing(), nullptr), image->GetOrigin(),
                       !pointData && !ref.arrays.empty());
            addNote(ref, block.note);
            if (pointData) {
                for (const ArrayRef& array : ref.arrays)
                    if (array.ofCells) addNoteOfCells(ref, array.form.name);
                std::erase_if(ref.arrays, [](const ArrayRef& array) { return array.ofCells; });
            }
        } else if (auto* grid = vtkRectilinearGrid::SafeDownCast(data); grid != nullptr && isAligned(grid)) {
            setAxes(ref, grid, !pointData);
        } else {
            ref.block.mesh = true;
            // OpenFOAM's values are of cells, beside which there may be the motion of points.
            ref.block.cellData = !pointData || source.format == "OpenFOAM";
            describeCells(data, mostEventsOf(blocks.size()), ref.block);
        }
        noteRounded(ref, data);
        describeFieldData(data->GetFieldData(), ref.block, ref.arrays);
        if (source.times.size() > 1) ref.block.quantities.clear(); // they belong to one time only
        finish(source, ref);
        described.push_back(std::move(ref));
    }
    return described;
}

void mergeBlocks(std::vector<BlockRef>& blocks, const std::vector<BlockRef>& more) {
    std::map<std::string, int> seen; // blocks of one name follow in the same order
    for (const BlockRef& ref : more) {
        int before = seen[ref.block.name]++;
        const auto known = std::ranges::find_if(
            blocks, [&](const BlockRef& block) { return block.block.name == ref.block.name && before-- == 0; });
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
        const double tolerance = 1e-6 * glm::length(ref.block.box.size());
        const bool moves = glm::length(known->block.box.lo - ref.block.box.lo) > tolerance ||
                           glm::length(known->block.box.hi - ref.block.box.hi) > tolerance;
        if (known->block.mesh && moves) known->block.cellData = true; // then as many samples as cells at each time
        if (moves) known->block.events = {};                          // its planes lie elsewhere at each time
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
    if (reader == nullptr) return {}; // its arrays are read by names (app/importer/swept_names.h)
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
