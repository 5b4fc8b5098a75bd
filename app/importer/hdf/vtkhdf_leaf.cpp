#include "app/importer/hdf/vtkhdf_leaf.h"

#include "app/importer/hdf/mesh_cells.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

namespace tessera::importer {

namespace {

constexpr std::int64_t kMostSteps = 1'000'000;

std::int64_t atOr(const std::vector<std::int64_t>& list, std::size_t index, std::int64_t other) {
    return index < list.size() ? list[index] : other;
}

std::size_t asSize(std::int64_t number, const char* what) {
    if (number < 0 || number > std::int64_t(1) << 40)
        throw std::runtime_error(std::string("is damaged: it has ") + std::to_string(number) + " " + what);
    return std::size_t(number);
}

/// Numbers of the parts [first, first + count) of a list, and their sum.
std::vector<std::int64_t> ofParts(const std::vector<std::int64_t>& list, std::size_t first, std::size_t count,
                                  std::size_t& sum, const char* what) {
    if (first > list.size() || count > list.size() - first)
        throw std::runtime_error(std::string("is damaged: a step has parts without a number of ") + what);
    std::vector<std::int64_t> own(list.begin() + std::ptrdiff_t(first), list.begin() + std::ptrdiff_t(first + count));
    sum = 0;
    for (const std::int64_t n : own) sum = asSize(std::int64_t(sum) + std::int64_t(asSize(n, what)), what);
    return own;
}

std::vector<VtkHdfMeshStep> meshSteps(const HdfFile& file, const std::string& group, std::size_t steps) {
    const auto list = [&](const std::string& name) { return file.integers(group + "/" + name); };
    const std::vector<std::int64_t> points = list("NumberOfPoints"), cells = list("NumberOfCells"),
                                    corners = list("NumberOfConnectivityIds"), faces = list("NumberOfFaces"),
                                    faceCorners = list("NumberOfFaceConnectivityIds"),
                                    toFaces = list("NumberOfPolyhedronToFaceIds");
    const std::vector<std::int64_t> firstParts = list("Steps/PartOffsets"), parts = list("Steps/NumberOfParts"),
                                    pointBegins = list("Steps/PointOffsets"), cellBegins = list("Steps/CellOffsets"),
                                    cornerBegins = list("Steps/ConnectivityIdOffsets"),
                                    faceBegins = list("Steps/FaceOffsetsOffsets"),
                                    faceCornerBegins = list("Steps/FaceConnectivityOffsets"),
                                    toFaceBegins = list("Steps/PolyhedronToFaceIdOffsets");
    if (points.empty() || cells.size() != points.size() || corners.size() != points.size())
        throw std::runtime_error("is damaged: its numbers of points, cells and corners have different lengths");
    // Without a number of parts, it is the same at all steps.
    const auto usual = std::int64_t(steps > 0 && points.size() % steps == 0 ? points.size() / steps : points.size());
    std::vector<VtkHdfMeshStep> out;
    for (std::size_t t = 0; t < std::max<std::size_t>(steps, 1); ++t) {
        VtkHdfMeshStep step;
        const std::size_t count = asSize(atOr(parts, t, usual), "parts");
        step.firstPart = asSize(atOr(firstParts, t, 0), "as first part");
        step.pointBegin = asSize(atOr(pointBegins, t, 0), "as first point");
        step.cellBegin = asSize(atOr(cellBegins, t, 0), "as first cell");
        step.cornerBegin = asSize(atOr(cornerBegins, t, 0), "as first corner");
        step.points = ofParts(points, step.firstPart, count, step.pointCount, "points");
        step.cells = ofParts(cells, step.firstPart, count, step.cellCount, "cells");
        step.corners = ofParts(corners, step.firstPart, count, step.cornerCount, "corners");
        if (faces.size() == points.size()) {
            std::size_t sum = 0;
            step.faces = ofParts(faces, step.firstPart, count, sum, "faces");
            step.faceCorners = ofParts(faceCorners, step.firstPart, count, sum, "corners of faces");
            step.toFaces = ofParts(toFaces, step.firstPart, count, sum, "faces of polyhedra");
            step.faceBegin = asSize(atOr(faceBegins, t, 0), "as first face");
            step.faceCornerBegin = asSize(atOr(faceCornerBegins, t, 0), "as first corner of a face");
            step.toFaceBegin = asSize(atOr(toFaceBegins, t, 0), "as first face of a polyhedron");
        }
        out.push_back(std::move(step));
    }
    return out;
}

bool sameMesh(const VtkHdfMeshStep& a, const VtkHdfMeshStep& b) {
    return a.firstPart == b.firstPart && a.pointBegin == b.pointBegin && a.cellBegin == b.cellBegin &&
           a.cornerBegin == b.cornerBegin && a.points == b.points && a.cells == b.cells;
}

struct ImageHead {
    std::array<int, 6> extent{};
    std::array<double, 3> origin{}, spacing{};
    std::array<double, 9> direction{1, 0, 0, 0, 1, 0, 0, 0, 1};

    /// Samples along x, y, z of points or cells.
    std::array<std::size_t, 3> size(bool cells) const {
        std::array<std::size_t, 3> n{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            n[axis] = std::size_t(std::int64_t(extent[2 * axis + 1]) - extent[2 * axis] + 1);
            if (cells && n[axis] > 1) --n[axis];
        }
        return n;
    }
};

ImageHead imageHead(const HdfFile& file, const std::string& group) {
    ImageHead head;
    const std::vector<double> extent = file.attribute(group, "WholeExtent"), origin = file.attribute(group, "Origin"),
                              spacing = file.attribute(group, "Spacing"),
                              direction = file.attribute(group, "Direction");
    if (extent.size() != 6) throw std::runtime_error("holds an image without WholeExtent");
    double count = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double low = extent[2 * axis], high = extent[2 * axis + 1];
        if (!(low >= -1e9 && high <= 1e9 && low <= high)) throw std::runtime_error("has an empty or damaged extent");
        head.extent[2 * axis] = int(low);
        head.extent[2 * axis + 1] = int(high);
        count *= high - low + 1;
        head.origin[axis] = axis < origin.size() ? origin[axis] : 0;
        head.spacing[axis] = axis < spacing.size() ? spacing[axis] : 1;
    }
    if (count > 1e11) throw std::runtime_error("states an image of more samples than memory can hold");
    if (direction.size() == 9) std::copy(direction.begin(), direction.end(), head.direction.begin());
    return head;
}

/// The part of an array of an image that one step shows, and its components; none where it does not fit.
struct ImagePart {
    HdfSlab slab;
    std::size_t components = 1;
};
std::optional<ImagePart> imagePart(const HdfShape& shape, const std::array<std::size_t, 3>& size, std::size_t steps,
                                   std::int64_t begin) {
    const std::vector<std::size_t>& dims = shape.dims;
    const auto components = [&](std::size_t first) -> std::size_t { // of an array whose grid begins at this axis
        std::size_t at = dims.size() - std::min(first, dims.size());
        if (at < 3 || at > 4) return 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (dims[first + axis] != size[2 - axis]) return 0;
        return at == 4 ? dims.back() : 1;
    };
    ImagePart part{{std::vector<std::size_t>(dims.size(), 0), {}, dims}, 0};
    if (dims.empty()) return std::nullopt;
    if (steps > 0 && components(1) > 0) { // a step is a first axis more, but for arrays that are the same at all steps
        if (dims[0] == 1) begin = 0;
        if (begin < 0 || std::size_t(begin) >= dims[0]) return std::nullopt;
        part.components = components(1);
        part.slab.begin[0] = std::size_t(begin);
        part.slab.count[0] = 1;
        return part;
    }
    part.components = components(0);
    const std::size_t tuples = size[0] * size[1] * size[2];
    if (part.components == 0 && dims.size() < 3) { // a flat grid, or one list
        const std::size_t count = shape.count();
        part.components = tuples > 0 && count == tuples ? 1 : count == tuples * dims.back() ? dims.back() : 0;
    }
    return part.components > 0 ? std::optional(part) : std::nullopt;
}

/// First row of an array at a step.
std::int64_t arrayRow(const VtkHdfArray& array, const VtkHdfLeaf& leaf, std::size_t step) {
    if (step < array.begins.size()) return array.begins[step];
    if (leaf.steps.empty()) return std::int64_t(step);
    const VtkHdfMeshStep& mesh = leaf.steps[std::min(step, leaf.steps.size() - 1)];
    return std::int64_t(array.ofCells ? mesh.cellBegin : mesh.pointBegin);
}

std::size_t arrayRows(const VtkHdfArray& array, const VtkHdfLeaf& leaf, std::size_t step) {
    const VtkHdfMeshStep& mesh = leaf.steps[std::min(step, leaf.steps.size() - 1)];
    return array.ofCells ? mesh.cellCount : mesh.pointCount;
}

/// Why an array cannot be read; "" = it can.
std::string arrayFault(const HdfFile& file, const VtkHdfLeaf& leaf, const VtkHdfArray& array) {
    try {
        const std::optional<HdfShape> shape = file.shape(array.path);
        if (!shape || !shape->numbers) return "holds no numbers";
        if (shape->dims.empty()) return "is a single number";
        if (leaf.type == "ImageData") {
            const ImageHead head = imageHead(file, leaf.group);
            const std::array<std::size_t, 3> size = head.size(array.ofCells);
            for (std::size_t t = 0; t < std::max<std::size_t>(leaf.times.size(), 1); ++t)
                if (!imagePart(*shape, size, leaf.times.size(), arrayRow(array, leaf, t)))
                    return "has another size than its grid";
        } else {
            for (std::size_t t = 0; t < leaf.steps.size(); ++t) {
                const std::int64_t row = arrayRow(array, leaf, t);
                if (row < 0 || std::size_t(row) > shape->dims[0] ||
                    arrayRows(array, leaf, t) > shape->dims[0] - std::size_t(row))
                    return "has fewer values than its mesh";
            }
        }
        HdfSlab one{
            std::vector<std::size_t>(shape->dims.size(), 0), {}, std::vector<std::size_t>(shape->dims.size(), 1)};
        if (shape->count() > 0) file.array(array.path, one);
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

/// Lists of one value per part become one list: positions in a list of a part become positions in that of all.
/// `perPart` numbers belong to each part, and one more that ends it.
std::vector<std::int64_t> joinedBegins(const HdfFile& file, const std::string& path, std::size_t begin,
                                       const std::vector<std::int64_t>& perPart,
                                       const std::vector<std::int64_t>& sizes) {
    const std::size_t all = std::size_t(std::accumulate(perPart.begin(), perPart.end(), std::int64_t(0)));
    const std::vector<std::int64_t> stored = file.integers(path, begin, all + perPart.size());
    std::vector<std::int64_t> out{0};
    std::size_t at = 0;
    std::int64_t base = 0;
    for (std::size_t part = 0; part < perPart.size(); ++part) {
        for (std::int64_t i = 1; i <= perPart[part]; ++i)
            out.push_back(base + stored[at + std::size_t(i)] - stored[at]);
        at += std::size_t(perPart[part]) + 1;
        base += sizes[part];
    }
    return out;
}

/// Adds to the numbers of each part how many things the parts before it have.
void shiftByPart(std::vector<std::int64_t>& list, const std::vector<std::int64_t>& perPart,
                 const std::vector<std::int64_t>& things) {
    std::size_t at = 0;
    std::int64_t before = 0;
    for (std::size_t part = 0; part < perPart.size(); ++part) {
        for (std::int64_t i = 0; i < perPart[part]; ++i) list[at++] += before;
        before += things[part];
    }
}

PolyhedronFaces facesAt(const HdfFile& file, const std::string& group, const VtkHdfMeshStep& step) {
    const auto sum = [](const std::vector<std::int64_t>& list) {
        return std::size_t(std::accumulate(list.begin(), list.end(), std::int64_t(0)));
    };
    PolyhedronFaces faces;
    faces.begins =
        joinedBegins(file, group + "/PolyhedronOffsets", step.cellBegin + step.firstPart, step.cells, step.toFaces);
    faces.toFaces = file.integers(group + "/PolyhedronToFaces", step.toFaceBegin, sum(step.toFaces));
    shiftByPart(faces.toFaces, step.toFaces, step.faces);
    faces.faceBegins =
        joinedBegins(file, group + "/FaceOffsets", step.faceBegin + step.firstPart, step.faces, step.faceCorners);
    faces.points = file.integers(group + "/FaceConnectivity", step.faceCornerBegin, sum(step.faceCorners));
    shiftByPart(faces.points, step.faceCorners, step.points);
    return faces;
}

vtkSmartPointer<vtkDataSet> meshAt(const HdfFile& file, const VtkHdfLeaf& leaf, const VtkHdfMeshStep& step) {
    const auto points = pointsOf(file.rows(leaf.group + "/Points", step.pointBegin, step.pointCount));
    MeshCells cells;
    const std::vector<std::int64_t> types = file.integers(leaf.group + "/Types", step.cellBegin, step.cellCount);
    for (const std::int64_t type : types) cells.types.push_back(std::uint8_t(type < 0 || type > 255 ? 255 : type));
    cells.begins =
        joinedBegins(file, leaf.group + "/Offsets", step.cellBegin + step.firstPart, step.cells, step.corners);
    cells.points = file.integers(leaf.group + "/Connectivity", step.cornerBegin, step.cornerCount);
    shiftByPart(cells.points, step.corners, step.points);
    if (!step.faces.empty()) cells.faces = facesAt(file, leaf.group, step);
    return meshOf(points, cells);
}

} // namespace

VtkHdfLeaf openVtkHdfLeaf(const HdfFile& file, const std::string& group, const std::string& name,
                          std::vector<std::string>& notes) {
    VtkHdfLeaf leaf{name, group, file.word(group, "Type"), {}, {}, {}, false};
    const std::string label = name.empty() ? "" : "block \"" + name + "\": ";
    const std::vector<double> steps = file.attribute(group + "/Steps", "NSteps");
    const std::int64_t count = steps.empty() ? 0 : std::int64_t(std::clamp(steps[0], 0.0, double(kMostSteps)));
    if (count > 0) {
        leaf.times = file.doubles(group + "/Steps/Values");
        if (std::int64_t(leaf.times.size()) < count)
            throw std::runtime_error("is damaged: it has steps without a time");
        leaf.times.resize(std::size_t(count));
    }
    if (leaf.type == "UnstructuredGrid") {
        leaf.steps = meshSteps(file, group, leaf.times.size());
        for (const VtkHdfMeshStep& step : leaf.steps) leaf.moves = leaf.moves || !sameMesh(step, leaf.steps.front());
    } else if (leaf.type == "ImageData") {
        imageHead(file, group);
    } else {
        throw std::runtime_error("holds data of the type " + leaf.type + ", which is not read");
    }
    for (const char* kind : {"PointData", "CellData", "FieldData"})
        for (const std::string& member : file.members(group + "/" + kind)) {
            VtkHdfArray array{member, group + "/" + kind + "/" + member, kind[0] == 'C', kind[0] == 'F', {}, {}};
            const std::string steady = group + "/Steps/" + kind;
            array.begins = file.integers(steady + "Offsets/" + member);
            if (array.ofField) array.sizes = file.integers(steady + "Sizes/" + member);
            const std::string fault = array.ofField ? "" : arrayFault(file, leaf, array);
            if (fault.empty())
                leaf.arrays.push_back(std::move(array));
            else
                notes.push_back(label + "array \"" + member + "\" left out: it " + fault);
        }
    return leaf;
}

std::vector<volume::Quantity> vtkHdfQuantities(const HdfFile& file, const VtkHdfLeaf& leaf) {
    std::vector<volume::Quantity> quantities;
    for (const VtkHdfArray& array : leaf.arrays) {
        const std::optional<HdfShape> shape = array.ofField ? file.shape(array.path) : std::nullopt;
        if (!shape || !shape->numbers || shape->count() > std::size_t(kMostSteps)) continue;
        const std::vector<double> stored = file.doubles(array.path);
        const bool one = shape->dims.size() == 1 || (shape->dims.size() == 2 && shape->dims[1] == 1);
        volume::Quantity quantity{array.name, "", {}};
        for (std::size_t step = 0; one && step < leaf.times.size(); ++step) {
            const bool several = atOr(array.sizes, 2 * step, 1) != 1 || atOr(array.sizes, 2 * step + 1, 1) != 1;
            const std::int64_t begin =
                atOr(array.begins, step, stored.size() == leaf.times.size() ? std::int64_t(step) : -1);
            if (several || begin < 0 || std::size_t(begin) >= stored.size()) break;
            quantity.values.push_back(stored[std::size_t(begin)]);
        }
        if (!leaf.times.empty() && quantity.values.size() == leaf.times.size())
            quantities.push_back(std::move(quantity));
    }
    return quantities;
}

void addVtkHdfFields(const HdfFile& file, const VtkHdfLeaf& leaf, std::size_t step, vtkDataSet& data) {
    constexpr std::size_t kMostRows = 1000; // more are no quantities
    for (const VtkHdfArray& array : leaf.arrays) {
        const std::optional<HdfShape> shape = array.ofField ? file.shape(array.path) : std::nullopt;
        if (!shape) continue;
        if (shape->words) {
            vtkNew<vtkStringArray> words;
            words->SetName(array.name.c_str());
            for (const std::string& text : file.texts(array.path)) words->InsertNextValue(text.c_str());
            data.GetFieldData()->AddArray(words);
        }
        if (!shape->numbers || shape->dims.empty()) continue;
        std::size_t first = 0, count = shape->dims[0];
        if (!leaf.times.empty() && (!array.begins.empty() || count == leaf.times.size())) {
            const std::int64_t begin = atOr(array.begins, step, std::int64_t(step));
            const std::int64_t tuples = atOr(array.sizes, 2 * step + 1, 1);
            if (begin < 0 || tuples < 1 || std::size_t(begin) >= count) continue;
            first = std::size_t(begin);
            count = std::min<std::size_t>(std::size_t(tuples), count - first);
        }
        if (count > kMostRows) continue;
        const auto values = file.rows(array.path, first, count);
        values->SetName(array.name.c_str());
        data.GetFieldData()->AddArray(values);
    }
}

vtkSmartPointer<vtkDataSet> readVtkHdfLeaf(const HdfFile& file, const VtkHdfLeaf& leaf, std::size_t step) {
    vtkSmartPointer<vtkDataSet> data;
    ImageHead head;
    if (leaf.type == "ImageData") {
        head = imageHead(file, leaf.group);
        vtkNew<vtkImageData> image;
        image->SetExtent(head.extent.data());
        image->SetOrigin(head.origin.data());
        image->SetSpacing(head.spacing.data());
        image->GetDirectionMatrix()->DeepCopy(head.direction.data());
        data = image;
    } else {
        data = meshAt(file, leaf, leaf.steps[std::min(step, leaf.steps.size() - 1)]);
    }
    for (const VtkHdfArray& array : leaf.arrays) {
        if (array.ofField) continue;
        vtkSmartPointer<vtkDataArray> values;
        std::size_t components = 1;
        const std::optional<HdfShape> shape = file.shape(array.path);
        if (!shape) throw std::runtime_error("array \"" + array.name + "\" is gone");
        if (leaf.type == "ImageData") {
            const std::optional<ImagePart> part =
                imagePart(*shape, head.size(array.ofCells), leaf.times.size(), arrayRow(array, leaf, step));
            if (!part) continue;
            values = file.array(array.path, part->slab);
            components = part->components;
        } else {
            values = file.rows(array.path, std::size_t(arrayRow(array, leaf, step)), arrayRows(array, leaf, step));
            for (std::size_t axis = 1; axis < shape->dims.size(); ++axis) components *= shape->dims[axis];
        }
        values->SetNumberOfComponents(int(std::min<std::size_t>(components, std::numeric_limits<int>::max())));
        values->SetName(array.name.c_str());
        if (array.ofCells)
            data->GetCellData()->AddArray(values);
        else
            data->GetPointData()->AddArray(values);
    }
    addVtkHdfFields(file, leaf, step, *data);
    return data;
}

} // namespace tessera::importer
