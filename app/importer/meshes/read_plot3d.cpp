// PLOT3D: grids (.xyz), solutions (.q) and functions (.f) with their names (.nam). VTK's reader guesses the form of
// files with several grids wrongly.
#include "app/importer/meshes/plot3d_file.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"
#include "volume/base/trimmed.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <vtkCompositeDataSet.h>
#include <vtkFloatArray.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStructuredGrid.h>
#include <vtkUnsignedCharArray.h>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

/// One array of a solution: its first variable, and how many it has.
struct Plot3dArray {
    std::string name;
    std::size_t first = 0, components = 1;
};

/// A file of values on the blocks of a grid.
struct Plot3dValues {
    std::shared_ptr<const Plot3dBytes> bytes;
    Plot3dForm form;
    std::size_t numbersBefore = 0;   ///< of each block
    std::vector<std::size_t> begins; ///< of the values of each block
    std::vector<Plot3dArray> arrays;
};

struct OpenedPlot3d {
    std::shared_ptr<const Plot3dBytes> bytes;
    Plot3dForm form;
    std::vector<Plot3dValues> values;
};

vtkSmartPointer<vtkStructuredGrid> gridOfBlock(const OpenedPlot3d& opened, std::size_t block, std::size_t begin) {
    const Plot3dForm& form = opened.form;
    const Plot3dSize& size = form.blocks[block];
    const std::size_t points = size.count(), step = opened.bytes->step(form.bytes);
    const auto axes = std::size_t(form.dimensions);
    auto grid = vtkSmartPointer<vtkStructuredGrid>::New();
    grid->SetDimensions(int(size.points[0]), int(size.points[1]), int(size.points[2]));
    vtkNew<vtkPoints> places;
    if (form.bytes == 8 || opened.bytes->text()) places->SetDataTypeToDouble();
    places->SetNumberOfPoints(vtkIdType(points));
    for (std::size_t n = 0; n < points; ++n) {
        double place[3] = {};
        for (std::size_t axis = 0; axis < axes; ++axis)
            place[axis] = opened.bytes->number(begin + (axis * points + n) * step, form.bytes, form.swap);
        places->SetPoint(vtkIdType(n), place);
    }
    grid->SetPoints(places);
    if (!form.blanks) return grid;
    vtkNew<vtkUnsignedCharArray> valid;  // 0: no point; others tell kinds of boundaries and of overlaps
    valid->SetName("vtkValidPointMask"); // which, unlike hidden points, takes no cells away
    for (std::size_t n = 0; n < points; ++n) {
        const std::size_t at = begin + axes * points * step + n * opened.bytes->step(4);
        valid->InsertNextValue(opened.bytes->whole(at, form.swap) == 0 ? 0 : 1);
    }
    grid->GetPointData()->AddArray(valid);
    return grid;
}

void addPlot3dValues(const Plot3dValues& values, std::size_t block, vtkStructuredGrid& grid) {
    const std::size_t points = values.form.blocks[block].count(), step = values.bytes->step(values.form.bytes);
    for (const Plot3dArray& about : values.arrays) {
        if (!values.form.variables.empty() && about.first + about.components > values.form.variables[block]) continue;
        vtkNew<vtkFloatArray> array;
        array->SetName(about.name.c_str());
        const std::size_t shown = about.components == 2 ? 3 : about.components; // of a plane
        array->SetNumberOfComponents(int(shown));
        array->SetNumberOfTuples(vtkIdType(points));
        array->Fill(0);
        for (std::size_t c = 0; c < about.components; ++c)
            for (std::size_t n = 0; n < points; ++n)
                array->SetValue(
                    vtkIdType(n * shown + c),
                    float(values.bytes->number(values.begins[block] + ((about.first + c) * points + n) * step,
                                               values.form.bytes, values.form.swap)));
        grid.GetPointData()->AddArray(array);
    }
}

vtkSmartPointer<vtkDataObject> plot3dData(const OpenedPlot3d& opened) {
    auto out = vtkSmartPointer<vtkMultiBlockDataSet>::New();
    std::size_t at = opened.form.begin;
    for (std::size_t b = 0; b < opened.form.blocks.size(); ++b) {
        const auto grid = gridOfBlock(opened, b, at);
        at += opened.form.blocks[b].count() *
              (std::size_t(opened.form.dimensions) * opened.bytes->step(opened.form.bytes) +
               (opened.form.blanks ? opened.bytes->step(4) : 0));
        for (const Plot3dValues& values : opened.values) addPlot3dValues(values, b, *grid);
        out->SetBlock(unsigned(b), grid);
        out->GetMetaData(unsigned(b))
            ->Set(vtkCompositeDataSet::NAME(),
                  opened.form.blocks.size() == 1 ? std::string() : "grid " + std::to_string(b + 1));
    }
    return out;
}

void setBegins(Plot3dValues& values, std::size_t variables) {
    std::size_t at = values.form.begin;
    const std::size_t step = values.bytes->step(values.form.bytes);
    for (std::size_t b = 0; b < values.form.blocks.size(); ++b) {
        at += values.numbersBefore * step;
        values.begins.push_back(at);
        const std::size_t own = values.form.variables.empty() ? variables : values.form.variables[b];
        at += own * values.form.blocks[b].count() * step;
    }
}

/// Names of functions, one a line; "u-velocity ; velocity" begins a vector of that name.
std::vector<Plot3dArray> namedFunctions(const std::string& path, std::size_t count, std::size_t axes) {
    std::vector<std::string> names, vectors;
    if (fs::exists(path)) {
        std::istringstream in(readWhole(path));
        for (std::string line; std::getline(in, line);) {
            const std::size_t mark = line.find(';');
            names.emplace_back(volume::trimmed(std::string_view(line).substr(0, mark)));
            vectors.emplace_back(mark == std::string::npos ? ""
                                                           : volume::trimmed(std::string_view(line).substr(mark + 1)));
        }
    }
    names.resize(count);
    vectors.resize(count);
    std::vector<Plot3dArray> arrays;
    for (std::size_t n = 0; n < count; ++n) {
        if (!vectors[n].empty() && n + axes <= count) {
            arrays.push_back({vectors[n], n, axes});
            n += axes - 1;
            continue;
        }
        arrays.push_back({names[n].empty() ? "function " + std::to_string(n + 1) : names[n], n, 1});
    }
    return arrays;
}

/// The first of the endings with which a file lies beside the grid; "" if none does.
std::string valuesBeside(const std::string& path, std::initializer_list<const char*> endings) {
    for (const char* ending : endings)
        if (const fs::path file = fs::path(path).replace_extension(ending); fs::exists(file)) return file.string();
    return {};
}

template <class Body> void inPlot3dFile(const std::string& path, Body&& body) {
    try {
        body();
    } catch (const std::runtime_error& error) {
        throw std::runtime_error("its file " + fs::path(path).filename().string() + " " + error.what());
    }
}

void addSolution(const std::string& path, OpenedPlot3d& opened, Source& source) {
    Plot3dValues values;
    values.bytes = std::make_shared<const Plot3dBytes>(path);
    values.form = formOfSolution(*values.bytes, opened.form);
    values.numbersBefore = 4;
    const auto axes = std::size_t(opened.form.dimensions);
    values.arrays = {{"Density", 0, 1}, {"Momentum", 1, axes}, {"StagnationEnergy", 1 + axes, 1}};
    setBegins(values, axes + 2);
    const std::size_t step = values.bytes->step(values.form.bytes);
    static constexpr const char* kNames[] = {"Mach", "alpha", "Re"};
    for (std::size_t n = 0; n < 3; ++n) // conditions of the first block
        source.quantities.push_back(
            {kNames[n], "", {values.bytes->number(values.form.begin + n * step, values.form.bytes, values.form.swap)}});
    const double time = values.bytes->number(values.form.begin + 3 * step, values.form.bytes, values.form.swap);
    if (time != 0) source.times = {meantTime(time)};
    opened.values.push_back(std::move(values));
}

void addFunctions(const std::string& path, OpenedPlot3d& opened) {
    Plot3dValues values;
    values.bytes = std::make_shared<const Plot3dBytes>(path);
    values.form = formOfFunctions(*values.bytes, opened.form);
    values.arrays =
        namedFunctions(fs::path(path).replace_extension(".nam").string(),
                       *std::ranges::max_element(values.form.variables), std::size_t(opened.form.dimensions));
    setBegins(values, 0);
    opened.values.push_back(std::move(values));
}

} // namespace

void openPlot3d(Source& source) {
    const auto opened = std::make_shared<OpenedPlot3d>();
    const std::string solution = valuesBeside(source.path, {".q", ".Q", ".qst"});
    const std::string functions = valuesBeside(source.path, {".f", ".fun", ".F"});
    if (solution.empty() && functions.empty())
        throw std::runtime_error(
            "holds a grid without values: these are expected in a file of the same name with the ending .q or .f");
    opened->bytes = std::make_shared<const Plot3dBytes>(source.path);
    opened->form = formOfGrid(*opened->bytes);
    if (!solution.empty()) inPlot3dFile(solution, [&] { addSolution(solution, *opened, source); });
    if (!functions.empty()) inPlot3dFile(functions, [&] { addFunctions(functions, *opened); });
    source.read = [opened](std::size_t) { return plot3dData(*opened); };
}

} // namespace tessera::importer
