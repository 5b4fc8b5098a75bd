#include "app/importer/arrays/array_grid.h"

#include "app/importer/arrays/conventions.h"
#include "volume/base/unit_conversion.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkRectilinearGrid.h>
#include <vtkStructuredGrid.h>

namespace tessera::importer {

namespace {

constexpr const char* kLetters[] = {"x", "y", "z"};

/// What is known along one axis of space.
struct Line {
    std::vector<double> at, faces; ///< rising; empty = counted by samples
    std::string unit;
    bool falling = false, stated = false;
};

bool rises(const std::vector<double>& at) {
    for (std::size_t i = 0; i < at.size(); ++i)
        if (!std::isfinite(at[i]) || (i > 0 && !(at[i] > at[i - 1]))) return false;
    return true;
}

/// Places that go once round the globe rise: 350, 355, 0, 5 becomes 350, 355, 360, 365.
bool unwrap(std::vector<double>& at) {
    int turns = 0;
    std::vector<double> out = at;
    for (std::size_t i = 1; i < at.size(); ++i) {
        if (at[i] < at[i - 1] - 180) ++turns;
        out[i] = at[i] + 360 * turns;
    }
    if (turns != 1 || !rises(out) || out.back() - out.front() > 360) return false;
    at = out;
    return true;
}

Line lineOf(const StoredAxis& axis, std::size_t along, std::vector<std::string>& notes) {
    Line line;
    line.unit = axis.unit;
    if (axis.places.size() != axis.length) return line;
    line.at = axis.places;
    line.faces = axis.faces;
    if (axis.down) {
        for (std::vector<double>* list : {&line.at, &line.faces})
            for (double& place : *list) place = -place;
        notes.push_back("\"" + leafOf(axis.name) + "\" counts downwards: " + kLetters[along] + " = -" +
                        leafOf(axis.name));
    }
    if (along == 0 && lowered(axis.unit).starts_with("deg") && !rises(line.at) && unwrap(line.at)) {
        line.faces.clear();
        notes.push_back("\"" + leafOf(axis.name) + "\" passes its end: 360 degrees added from there on");
    } else if (line.at.size() > 1 && line.at.front() > line.at.back()) {
        line.falling = true;
        std::ranges::reverse(line.at);
        std::ranges::reverse(line.faces);
    }
    line.stated = rises(line.at);
    if (!line.stated) {
        notes.push_back("places along " + std::string(kLetters[along]) + " (\"" + leafOf(axis.name) +
                        "\") neither rise nor fall throughout: it counts samples");
        return {};
    }
    const bool around = line.faces.size() == line.at.size() + 1 && rises(line.faces);
    for (std::size_t i = 0; around && i < line.at.size(); ++i)
        if (line.at[i] < line.faces[i] || line.at[i] > line.faces[i + 1]) line.faces.clear();
    if (!around) line.faces.clear();
    return line;
}

/// Converts places to one unit of length where they differ; gives it, "" where there is none.
std::string agreeOnUnit(std::array<Line, 3>& lines, std::vector<std::string>& notes) {
    std::vector<std::string> units;
    std::string finest;
    for (const Line& line : lines) {
        const std::string unit = volume::lengthUnitNamed(line.unit);
        if (!line.stated || (line.at.size() == 1 && unit.empty())) continue;
        units.push_back(unit);
        if (unit.empty()) continue;
        const auto finer = volume::unitConversion(unit, finest.empty() ? unit : finest);
        if (finest.empty() || (finer && finer->factor < 1)) finest = unit;
    }
    if (finest.empty() || std::ranges::find(units, "") != units.end()) return {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Line& line = lines[axis];
        const std::string unit = volume::lengthUnitNamed(line.unit);
        const auto factor = volume::unitConversion(unit, finest);
        if (!line.stated || unit.empty() || unit == finest || !factor) continue;
        for (std::vector<double>* list : {&line.at, &line.faces})
            for (double& place : *list) place *= factor->factor;
        notes.push_back("places along " + std::string(kLetters[axis]) + " converted from " + unit + " to " + finest);
    }
    return finest;
}

struct Steps {
    double first = 0, step = 1;
    bool even = true;
};
/// Even to 0.1 % of a step, or to the precision of float32.
Steps stepsOf(const std::vector<double>& at) {
    Steps out;
    if (at.empty()) return out;
    out.first = at.front();
    if (at.size() < 2) return out;
    out.step = (at.back() - at.front()) / double(at.size() - 1);
    const double precision = 2.4e-7 * std::max(std::abs(at.front()), std::abs(at.back()));
    const double within = std::max(1e-3 * out.step, std::min(precision, 0.05 * out.step));
    for (std::size_t i = 0; i < at.size(); ++i)
        out.even = out.even && std::abs(at[i] - at.front() - out.step * double(i)) <= within;
    return out;
}

vtkSmartPointer<vtkDataSet> gridOfLines(const std::array<Line, 3>& lines, const ArrayGrid& grid) {
    int size[3];
    double origin[3], spacing[3];
    bool even = true;
    std::array<std::vector<double>, 3> places;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Line& line = lines[axis];
        const bool faces = grid.ofCells && !line.faces.empty();
        places[axis] = faces ? line.faces : line.at;
        size[axis] = int(grid.size[axis] + (faces ? 1 : 0));
        const Steps steps = stepsOf(places[axis]);
        origin[axis] = steps.first;
        spacing[axis] = steps.step;
        even = even && steps.even;
    }
    if (even) {
        vtkNew<vtkImageData> image;
        image->SetDimensions(size);
        image->SetOrigin(origin);
        image->SetSpacing(spacing);
        return image;
    }
    vtkNew<vtkRectilinearGrid> uneven;
    uneven->SetDimensions(size);
    vtkSmartPointer<vtkDoubleArray> at[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        at[axis] = vtkSmartPointer<vtkDoubleArray>::New();
        for (int i = 0; i < size[axis]; ++i)
            at[axis]->InsertNextValue(places[axis].empty() ? double(i) : places[axis][std::size_t(i)]);
    }
    uneven->SetXCoordinates(at[0]);
    uneven->SetYCoordinates(at[1]);
    uneven->SetZCoordinates(at[2]);
    return uneven;
}

/// Places of a curved grid by axis of space, of the axes that have no places of their own.
std::array<const CurvedPlaces*, 3> curvedOf(const ArrayFile& file, const ArrayGrid& grid) {
    std::array<const CurvedPlaces*, 3> found{};
    for (const CurvedPlaces& places : file.curved) {
        const bool fits = std::ranges::all_of(places.axes, [&](int axis) {
            return std::ranges::find(grid.axes, axis) != grid.axes.end() && file.axes[axis].places.empty();
        });
        const bool finite = std::ranges::all_of(places.at, [](double at) { return std::abs(at) < 1e30; });
        auto& own = found[std::size_t(int(places.kind) - int(AxisKind::X))];
        if (fits && finite && own == nullptr) own = &places;
    }
    return found;
}

vtkSmartPointer<vtkDataSet> curvedGrid(const ArrayFile& file, const ArrayGrid& grid, const std::array<Line, 3>& lines,
                                       const std::array<const CurvedPlaces*, 3>& curved) {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    const auto& [nx, ny, nz] = grid.size;
    points->SetNumberOfPoints(vtkIdType(nx * ny * nz));
    vtkIdType to = 0;
    std::array<std::size_t, 3> at{};
    for (at[2] = 0; at[2] < nz; ++at[2])
        for (at[1] = 0; at[1] < ny; ++at[1])
            for (at[0] = 0; at[0] < nx; ++at[0], ++to) {
                double place[3];
                for (std::size_t space = 0; space < 3; ++space) {
                    place[space] = lines[space].at.empty() ? double(at[space]) : lines[space].at[at[space]];
                    if (curved[space] == nullptr) continue;
                    std::size_t index = 0;
                    for (const int axis : curved[space]->axes) {
                        const auto along = std::size_t(std::ranges::find(grid.axes, axis) - grid.axes.begin());
                        const bool turned = grid.falling[along];
                        index =
                            index * file.axes[axis].length + (turned ? grid.size[along] - 1 - at[along] : at[along]);
                    }
                    place[space] = curved[space]->at[index];
                }
                points->SetPoint(to, place);
            }
    vtkNew<vtkStructuredGrid> out;
    out->SetDimensions(int(nx), int(ny), int(nz));
    out->SetPoints(points);
    return out;
}

/// Copies samples of so many bytes; strides are in samples.
template <std::size_t kBytes>
void copySamples(const char* from, char* to, const std::array<std::size_t, 4>& count,
                 const std::array<std::ptrdiff_t, 4>& stride) {
    for (std::size_t k = 0; k < count[2]; ++k)
        for (std::size_t j = 0; j < count[1]; ++j) {
            const char* row = from + (std::ptrdiff_t(k) * stride[2] + std::ptrdiff_t(j) * stride[1]) * int(kBytes);
            for (std::size_t i = 0; i < count[0]; ++i, row += stride[0] * int(kBytes))
                for (std::size_t c = 0; c < count[3]; ++c, to += kBytes)
                    std::memcpy(to, row + std::ptrdiff_t(c) * stride[3] * int(kBytes), kBytes);
        }
}

} // namespace

ArrayGrid makeGrid(const ArrayFile& file, const GridAxes& axes, std::vector<std::string>& notes) {
    ArrayGrid grid;
    grid.axes = axes;
    std::array<Line, 3> lines;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (axes[axis] < 0) continue;
        grid.size[axis] = file.axes[axes[axis]].length;
        lines[axis] = lineOf(file.axes[axes[axis]], axis, notes);
        grid.falling[axis] = lines[axis].falling;
    }
    const std::array<const CurvedPlaces*, 3> curved = curvedOf(file, grid);
    if (curved[0] != nullptr && curved[1] != nullptr) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (curved[axis] != nullptr) {
                lines[axis].stated = true;
                lines[axis].unit = curved[axis]->unit;
            }
        std::vector<std::string> units;
        for (const Line& line : lines)
            if (line.stated) units.push_back(line.unit);
        grid.lengthUnit = volume::lengthUnitOfAxes(units);
        grid.data = curvedGrid(file, grid, lines, curved);
        return grid;
    }
    grid.lengthUnit = agreeOnUnit(lines, notes);
    grid.ofCells = true;
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (grid.size[axis] > 1 && lines[axis].faces.empty()) grid.ofCells = false;
    grid.data = gridOfLines(lines, grid);
    return grid;
}

vtkSmartPointer<vtkDataArray> inGridOrder(vtkSmartPointer<vtkDataArray> values, const std::vector<Along>& axes,
                                          const ArrayGrid& grid, int components) {
    std::array<std::size_t, 4> count{1, 1, 1, std::size_t(components)};
    std::array<std::ptrdiff_t, 4> stride{0, 0, 0, 0};
    std::ptrdiff_t step = 1, first = 0;
    std::size_t all = 1;
    for (std::size_t a = axes.size(); a-- > 0;) {
        if (axes[a].to >= 0) {
            count[std::size_t(axes[a].to)] = axes[a].count;
            stride[std::size_t(axes[a].to)] = step;
        }
        step *= std::ptrdiff_t(axes[a].count);
        all *= axes[a].count;
    }
    if (std::size_t(values->GetNumberOfValues()) != all || count[3] != std::size_t(components))
        throw std::runtime_error("has an array of invalid size");
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (grid.falling[axis]) {
            first += stride[axis] * std::ptrdiff_t(count[axis] - 1);
            stride[axis] = -stride[axis];
        }
    bool same = first == 0;
    std::ptrdiff_t wanted = 1;
    for (const std::size_t axis : {3u, 0u, 1u, 2u}) {
        same = same && (count[axis] == 1 || stride[axis] == wanted);
        wanted *= std::ptrdiff_t(count[axis]);
    }
    if (same) {
        values->SetNumberOfComponents(components);
        return values;
    }
    auto out = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(values->GetDataType()));
    out->SetNumberOfComponents(components);
    out->SetNumberOfTuples(vtkIdType(all) / components);
    const int bytes = values->GetDataTypeSize();
    const char* from = static_cast<const char*>(values->GetVoidPointer(0)) + first * bytes;
    char* to = static_cast<char*>(out->GetVoidPointer(0));
    if (bytes == 1) copySamples<1>(from, to, count, stride);
    if (bytes == 2) copySamples<2>(from, to, count, stride);
    if (bytes == 4) copySamples<4>(from, to, count, stride);
    if (bytes == 8) copySamples<8>(from, to, count, stride);
    return out;
}

} // namespace tessera::importer
