// AmiraMesh of Amira and Avizo: lattices with uniform, stacked, rectilinear or curvilinear coordinates.
#include "app/importer/grids/amira_header.h"
#include "app/importer/grids/grid_file.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkRectilinearGrid.h>
#include <vtkStringArray.h>
#include <vtkStructuredGrid.h>
#include <zlib.h>

namespace tessera::importer {

namespace {

/// Type of VTK and bytes of a number; complex ones are two.
struct AmiraType {
    int vtk = 0;
    std::size_t bytes = 0;
    int parts = 1;
};

AmiraType amiraType(const std::string& name) {
    if (name == "byte") return {VTK_UNSIGNED_CHAR, 1};
    if (name == "short") return {VTK_SHORT, 2};
    if (name == "ushort") return {VTK_UNSIGNED_SHORT, 2};
    if (name == "int" || name == "int32") return {VTK_INT, 4};
    if (name == "uint" || name == "uint32") return {VTK_UNSIGNED_INT, 4};
    if (name == "long" || name == "int64") return {VTK_LONG_LONG, 8};
    if (name == "float") return {VTK_FLOAT, 4};
    if (name == "double") return {VTK_DOUBLE, 8};
    if (name == "complex") return {VTK_FLOAT, 4, 2};
    throw std::runtime_error("type " + name.substr(0, 40));
}

struct AmiraForm {
    std::string path;
    AmiraHeader header;
    glm::ivec3 size{1};
    std::vector<AmiraArray> arrays; ///< of the lattice
    std::string coordinates = "uniform", labels;
    std::size_t count() const { return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z); }
};

std::string wordsOf(const AmiraHeader& header, const std::string& key) {
    const auto at = header.parameters.find("Parameters/" + key);
    return at == header.parameters.end() ? "" : at->second;
}

std::vector<double> numbersOf(const AmiraHeader& header, const std::string& key) {
    std::vector<double> numbers;
    const std::string text = wordsOf(header, key);
    GridWords words(text);
    double value = 0;
    for (std::string_view word = words.word(); !word.empty() && parseGridNumber(word, value); word = words.word())
        numbers.push_back(value);
    return numbers;
}

/// How many numbers belong to what an array is of; 0 where that is not known.
std::size_t numbersFor(const AmiraForm& form, const AmiraArray& array) {
    if (array.of == "Lattice") return form.count();
    const auto at = form.header.defines.find(array.of);
    if (at == form.header.defines.end()) return 0;
    double count = 1;
    for (const double n : at->second) count *= n;
    constexpr double kMost = 1e12;
    return count >= 1 && count <= kMost ? std::size_t(count) : 0;
}

std::size_t rawBytesOf(const AmiraForm& form, const AmiraArray& array) {
    const AmiraType type = amiraType(array.type);
    return numbersFor(form, array) * type.bytes * std::size_t(type.parts) * std::size_t(array.components);
}

/// Where the bytes of a section begin. Those before it are stepped over by their sizes.
std::size_t sectionAt(const AmiraForm& form, GridBytes& file, int section) {
    std::size_t at = form.header.end;
    const auto pastLine = [&] { // "\n@2\n"; how many line ends stand before it differs
        constexpr std::size_t kLine = 40;
        const std::string text = file.part(at, kLine);
        const std::size_t sign = text.find('@'), end = text.find('\n', sign == std::string::npos ? 0 : sign);
        if (sign == std::string::npos || end == std::string::npos || text.find_first_not_of(" \r\n\t") != sign)
            throw std::runtime_error("ends early: its section @" + std::to_string(section) +
                                     " is not where it should be");
        at += end + 1;
        return std::atoi(text.c_str() + sign + 1);
    };
    for (std::size_t step = 0; step <= form.header.arrays.size(); ++step) {
        const int found = pastLine();
        if (found == section) return at;
        const auto array = std::ranges::find(form.header.arrays, found, &AmiraArray::section);
        if (array == form.header.arrays.end()) break;
        at += array->encoding.empty() ? rawBytesOf(form, *array) : array->stored;
    }
    throw std::runtime_error("holds no section @" + std::to_string(section));
}

/// Runs of bytes: a count and a byte, or with its highest bit set a count of bytes as they are.
void unpackRuns(const std::string& packed, std::string& to) {
    std::size_t at = 0, out = 0;
    while (out < to.size() && at < packed.size()) {
        const auto head = static_cast<unsigned char>(packed[at++]);
        const std::size_t count = std::min<std::size_t>(head & 0x7f, to.size() - out);
        if ((head & 0x80) != 0) {
            if (count > packed.size() - at) break;
            std::copy_n(packed.begin() + std::ptrdiff_t(at), count, to.begin() + std::ptrdiff_t(out));
            at += count;
        } else {
            if (at >= packed.size()) break;
            std::fill_n(to.begin() + std::ptrdiff_t(out), count, packed[at++]);
        }
        out += count;
    }
    wantBytes(double(out), double(to.size()), {}, "bytes of samples in runs");
}

std::string bytesOfSection(const AmiraForm& form, const AmiraArray& array) {
    GridBytes file(form.path);
    const std::size_t at = sectionAt(form, file, array.section), wanted = rawBytesOf(form, array);
    std::string bytes(wanted, '\0');
    if (array.encoding.empty()) {
        file.read(at, wanted, bytes.data());
        return bytes;
    }
    std::string packed(array.stored, '\0');
    file.read(at, array.stored, packed.data());
    if (array.encoding == "HxByteRLE") {
        unpackRuns(packed, bytes);
        return bytes;
    }
    uLongf got = wanted;
    if (uncompress(reinterpret_cast<Bytef*>(bytes.data()), &got, reinterpret_cast<const Bytef*>(packed.data()),
                   packed.size()) != Z_OK ||
        got != wanted)
        throw std::runtime_error("its compressed samples end early: truncated or damaged");
    return bytes;
}

/// The numbers of a section written as text.
void readTextSection(const AmiraForm& form, const AmiraArray& array, vtkDataArray& to) {
    const std::string all = wholeGridText(form.path);
    checkLastNumber(all);
    const std::string sign = "\n@" + std::to_string(array.section);
    std::size_t at = form.header.end - 1;
    while ((at = all.find(sign, at)) != std::string::npos && at + sign.size() < all.size() &&
           std::isspace(static_cast<unsigned char>(all[at + sign.size()])) == 0)
        ++at;
    if (at == std::string::npos) throw std::runtime_error("holds no section @" + std::to_string(array.section));
    GridWords words(std::string_view(all).substr(at + sign.size()));
    for (vtkIdType i = 0; i < to.GetNumberOfTuples(); ++i)
        for (int c = 0; c < to.GetNumberOfComponents(); ++c) to.SetComponent(i, c, words.number());
}

vtkSmartPointer<vtkDataArray> readAmiraArray(const AmiraForm& form, const AmiraArray& array) {
    const AmiraType type = amiraType(array.type);
    if (array.components < 1 || array.components > 16) throw std::runtime_error("has impossible coordinates");
    refuseHollow(double(rawBytesOf(form, array)), double(bytesIn(form.path)));
    auto out = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type.vtk));
    out->SetName(array.name.c_str());
    out->SetNumberOfComponents(array.components * type.parts);
    out->SetNumberOfTuples(vtkIdType(numbersFor(form, array)));
    if (form.header.text) {
        readTextSection(form, array, *out);
        return out;
    }
    std::string bytes = bytesOfSection(form, array);
    const bool swap = form.header.bigEndian == (std::endian::native == std::endian::little);
    for (std::size_t at = 0; swap && type.bytes > 1 && at + type.bytes <= bytes.size(); at += type.bytes)
        std::reverse(bytes.begin() + std::ptrdiff_t(at), bytes.begin() + std::ptrdiff_t(at + type.bytes));
    std::memcpy(out->GetVoidPointer(0), bytes.data(), bytes.size());
    return out;
}

/// The matrix that places the lattice in space, column by column; the identity where it states none.
std::array<double, 16> transformOf(const AmiraHeader& header) {
    std::array<double, 16> matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const std::vector<double> numbers = numbersOf(header, "TransformationMatrix");
    if (numbers.size() == 16) std::ranges::copy(numbers, matrix.begin());
    return matrix;
}

glm::dvec3 turned(const std::array<double, 16>& m, glm::dvec3 v, double isPoint) {
    glm::dvec3 out(0);
    for (std::size_t row = 0; row < 3; ++row)
        out[int(row)] = m[row] * v.x + m[4 + row] * v.y + m[8 + row] * v.z + m[12 + row] * isPoint;
    return out;
}

vtkSmartPointer<vtkDataSet> uniformGrid(const AmiraForm& form) {
    std::vector<double> box = numbersOf(form.header, "BoundingBox");
    const bool stated = box.size() == 6;
    if (!stated) box = {0, double(form.size.x - 1), 0, double(form.size.y - 1), 0, double(form.size.z - 1)};
    const std::array<double, 16> matrix = transformOf(form.header);
    glm::dmat3 steps(1);
    for (int axis = 0; axis < 3; ++axis) { // the box reaches from the first sample to the last
        const double length = box[std::size_t(2 * axis + 1)] - box[std::size_t(2 * axis)];
        const double step = form.size[axis] > 1 ? length / (form.size[axis] - 1) : length;
        glm::dvec3 along(0);
        along[axis] = step != 0 && std::isfinite(step) ? step : 1;
        steps[axis] = turned(matrix, along, 0);
    }
    return gridImage(form.size, turned(matrix, {box[0], box[2], box[4]}, 1), steps);
}

/// Places along each axis, of stacked and rectilinear coordinates.
vtkSmartPointer<vtkDataSet> unevenGrid(const AmiraForm& form, const AmiraArray& array) {
    const vtkSmartPointer<vtkDataArray> places = readAmiraArray(form, array);
    const bool stacked = form.coordinates == "stacked";
    const auto wanted = stacked ? form.size.z : form.size.x + form.size.y + form.size.z;
    if (places->GetNumberOfTuples() * places->GetNumberOfComponents() < wanted)
        throw std::runtime_error("has too few coordinates");
    std::vector<double> box = numbersOf(form.header, "BoundingBoxXY");
    if (box.size() < 4) box = {0, double(form.size.x - 1), 0, double(form.size.y - 1)};
    vtkNew<vtkRectilinearGrid> grid;
    grid->SetDimensions(form.size.x, form.size.y, form.size.z);
    vtkIdType next = 0;
    for (int axis = 0; axis < 3; ++axis) {
        vtkNew<vtkDoubleArray> along;
        for (int i = 0; i < form.size[axis]; ++i) {
            const double from = box[std::size_t(2 * std::min(axis, 1))],
                         to = box[std::size_t(2 * std::min(axis, 1) + 1)];
            along->InsertNextValue(stacked && axis < 2 ? from + (to - from) * i / std::max(1, form.size[axis] - 1)
                                                       : places->GetVariantValue(next++).ToDouble());
        }
        if (axis == 0) grid->SetXCoordinates(along);
        if (axis == 1) grid->SetYCoordinates(along);
        if (axis == 2) grid->SetZCoordinates(along);
    }
    return grid;
}

vtkSmartPointer<vtkDataSet> curvedGrid(const AmiraForm& form, const AmiraArray& array) {
    const vtkSmartPointer<vtkDataArray> places = readAmiraArray(form, array);
    if (places->GetNumberOfComponents() != 3) throw std::runtime_error("has places without three coordinates");
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->SetData(places);
    vtkNew<vtkStructuredGrid> grid;
    grid->SetDimensions(form.size.x, form.size.y, form.size.z);
    grid->SetPoints(points);
    return grid;
}

/// Labels of a field of materials: the number of a material is its place in the list.
std::string labelsOfMaterials(const AmiraHeader& header) {
    static const std::string kIn = "Parameters/Materials/";
    std::string all;
    int value = 0;
    for (const std::string& block : header.blocks) {
        if (!block.starts_with(kIn) || block.find('/', kIn.size()) != std::string::npos) continue;
        std::string name = block.substr(kIn.size());
        if (name.starts_with('#')) name = wordsOf(header, "Materials/" + name + "/Name");
        std::erase(name, ';');
        if (!name.empty()) all += "NAME " + std::to_string(value) + " " + name + "; ";
        ++value;
    }
    return all;
}

/// The materials name the values of the only array of whole numbers.
void addLabels(const AmiraForm& form, vtkDataSet& grid) {
    const auto isWhole = [](const AmiraArray& array) { return array.type != "float" && array.type != "double"; };
    if (form.labels.empty() || std::ranges::count_if(form.arrays, isWhole) != 1) return;
    std::string text = form.labels, name;
    for (const char c : std::ranges::find_if(form.arrays, isWhole)->name)
        name += c == ' ' ? "%20" : c == ',' ? "%2C" : c == ';' ? "%3B" : c == '%' ? "%25" : std::string(1, c);
    for (std::size_t at = 0; (at = text.find("NAME ", at)) != std::string::npos; at += name.size())
        text.replace(at, 4, name);
    vtkNew<vtkStringArray> labels;
    labels->SetName("labels");
    labels->InsertNextValue(text);
    grid.GetFieldData()->AddArray(labels);
}

vtkSmartPointer<vtkDataObject> readAmira(const AmiraForm& form) {
    vtkSmartPointer<vtkDataSet> grid;
    const auto places = std::ranges::find(form.header.arrays, "Coordinates", &AmiraArray::of);
    const auto curved = std::ranges::find_if(form.header.arrays, [](const AmiraArray& array) {
        return array.of == "Lattice" && array.name == "Coordinates";
    });
    if (form.coordinates == "curvilinear" && curved != form.header.arrays.end())
        grid = curvedGrid(form, *curved);
    else if (form.coordinates != "uniform" && places != form.header.arrays.end())
        grid = unevenGrid(form, *places);
    else
        grid = uniformGrid(form);
    for (const AmiraArray& array : form.arrays) grid->GetPointData()->AddArray(readAmiraArray(form, array));
    addLabels(form, *grid);
    return grid;
}

/// The arrays of the lattice that are read; others are named.
void chooseArrays(AmiraForm& form, Source& source) {
    for (const AmiraArray& array : form.header.arrays) {
        if (array.of != "Lattice" || (form.coordinates == "curvilinear" && array.name == "Coordinates")) continue;
        std::string why;
        try {
            amiraType(array.type);
        } catch (const std::runtime_error& error) {
            why = error.what();
        }
        if (!array.encoding.empty() && array.encoding != "HxZip" &&
            !(array.encoding == "HxByteRLE" && array.type == "byte"))
            why = "packed by " + array.encoding;
        if (array.components < 1 || array.components > 16) why = std::to_string(array.components) + " components";
        if (array.type == "complex")
            source.notes.push_back("The complex numbers of " + array.name +
                                   " are read as real (.0) and imaginary part (.1).");
        if (why.empty())
            form.arrays.push_back(array);
        else
            source.notes.push_back("Its array " + array.name + " (" + why + ") is not read.");
    }
    if (form.arrays.empty()) throw std::runtime_error("holds no array on a lattice that is read");
}

} // namespace

void openAmira(Source& source) {
    constexpr std::size_t kMostHeader = 16 << 20;
    auto form = std::make_shared<AmiraForm>();
    form->path = source.path;
    form->header = parseAmira(GridBytes(source.path).part(0, kMostHeader));
    const auto lattice = form->header.defines.find("Lattice");
    if (lattice == form->header.defines.end() || lattice->second.empty() || lattice->second.size() > 3)
        throw std::runtime_error("defines no lattice of three axes: meshes and surfaces of Amira are not read");
    for (std::size_t axis = 0; axis < lattice->second.size(); ++axis) {
        const double n = lattice->second[axis];
        if (!(n >= 1) || n > 1e9 || n != std::floor(n)) throw std::runtime_error("states an impossible size");
        form->size[int(axis)] = int(n);
    }
    if (const std::string word = wordsOf(form->header, "CoordType"); !word.empty()) form->coordinates = word;
    chooseArrays(*form, source);
    for (const AmiraArray& array : form->arrays) {
        const double bytes = double(form->size.x) * form->size.y * form->size.z * double(amiraType(array.type).bytes) *
                             amiraType(array.type).parts * array.components;
        refuseHollow(bytes, double(bytesIn(source.path)));
        if (array.encoding.empty() && !form->header.text && readPart(source.path, 0, 2) != "\x1f\x8b")
            wantBytes(double(bytesIn(source.path)), double(form->header.end) + bytes, {}, "bytes");
        if (!array.encoding.empty()) wantBytes(double(bytesIn(source.path)), double(array.stored), {}, "bytes");
    }
    const std::string unit = wordsOf(form->header, "Units/Coordinates");
    source.lengthUnit = lengthUnitOfPicture(unit);
    if (source.lengthUnit.empty() && !unit.empty() && !unit.starts_with("pixel"))
        source.notes.push_back("Its unit of lengths \"" + unit.substr(0, 40) + "\" is not known and left out.");
    if (form->coordinates != "uniform" && !numbersOf(form->header, "TransformationMatrix").empty())
        source.notes.emplace_back("Its transformation is not applied to its coordinates.");
    form->labels = labelsOfMaterials(form->header);
    source.read = [form](std::size_t) { return readAmira(*form); };
}

} // namespace tessera::importer
