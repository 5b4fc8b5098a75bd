// NetCDF in all its forms, by libnetcdf and the conventions of CF and COARDS.
#include "app/importer/arrays/netcdf_file.h"
#include "app/importer/arrays/open_arrays.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>

namespace tessera::importer {

namespace {

bool isNumeric(const NetCdfVariable& variable) {
    return variable.vtkType != VTK_VOID && variable.vtkType != VTK_CHAR;
}

/// What is being made of a file.
struct Reading {
    std::shared_ptr<const NetCdfFile> nc;
    double bytes = 0; ///< of the whole file
    ArrayFile file;
    std::set<std::string> used; ///< paths of variables that are places, bounds, or no data
};

/// The variable that an attribute of another names: in its own group, or in one around it.
const NetCdfVariable* named(const NetCdfFile& nc, const NetCdfVariable& by, std::string name) {
    if (name.starts_with("/")) name.erase(0, 1);
    std::string group = by.path;
    while (!group.empty()) {
        const std::size_t slash = group.rfind('/');
        group = slash == std::string::npos ? std::string() : group.substr(0, slash);
        const std::string path = group.empty() ? name : group + "/" + name;
        const auto at = std::ranges::find(nc.variables, path, &NetCdfVariable::path);
        if (at != nc.variables.end()) return &*at;
    }
    return nullptr;
}

std::vector<const NetCdfVariable*> allNamed(const NetCdfFile& nc, const NetCdfVariable& by, const char* attribute) {
    std::vector<const NetCdfVariable*> out;
    std::istringstream names(textOf(by.attributes, attribute));
    for (std::string name; names >> name;)
        if (const NetCdfVariable* variable = named(nc, by, name)) out.push_back(variable);
    return out;
}

/// Sizes of coordinates: they are read whole.
void refuseLarge(const Reading& reading, const NetCdfVariable& variable) {
    StoredArray array;
    array.name = variable.path;
    array.statedBytes = double(vtkDataArray::GetDataTypeSize(variable.vtkType));
    for (const std::size_t n : variable.dims) array.statedBytes *= double(n);
    array.storedBytes = reading.bytes;
    refuseHollow(array);
}

/// All values of a variable, NaN where there is none; float32 as the decimal number that was meant.
std::vector<double> allValues(const Reading& reading, const NetCdfVariable& variable) {
    refuseLarge(reading, variable);
    const auto stored = reading.nc->read(variable, {Dims(variable.dims.size(), 0), variable.dims});
    const StoredForm form = formBy(variable.attributes, variable.vtkType);
    std::vector<double> out(std::size_t(stored->GetNumberOfValues()));
    for (std::size_t i = 0; i < out.size(); ++i) {
        const double number = stored->GetComponent(vtkIdType(i), 0);
        out[i] = variable.vtkType == VTK_FLOAT && !form.masks() ? meantTime(number) : number;
    }
    return valuesBy(form, std::move(out));
}

/// How well a one-dimensional variable gives the places of its dimension; 0 = not at all.
int fitness(const Reading& reading, const NetCdfVariable& variable, const std::set<std::string>& listed) {
    const NetCdfDimension& dimension = reading.nc->dimensions[std::size_t(variable.dimensions[0])];
    if (variable.path == dimension.path) return 5;
    if (leafOf(variable.path) == leafOf(dimension.path)) return 4;
    const bool stated = !textOf(variable.attributes, "axis").empty();
    if (stated) return 3;
    const AxisKind kind = kindByAttributes(variable.attributes);
    const std::string standard = textOf(variable.attributes, "standard_name");
    if (standard.starts_with("forecast_")) return 0;
    if (listed.contains(variable.path) && kind != AxisKind::Unknown) return 2;
    if (kind != AxisKind::Unknown && (kind != AxisKind::Z || variable.attributes.contains("positive"))) return 1;
    static const std::set<std::string> kPlain{"x",     "y",     "z",         "t",        "time",
                                              "times", "lon",   "longitude", "lat",      "latitude",
                                              "lev",   "level", "height",    "altitude", "depth"};
    return kPlain.contains(lowered(leafOf(variable.path))) ? 1 : 0;
}

/// The faces of cells by the bounds of their places, if each cell begins where the one before ends.
std::vector<double> facesBy(const Reading& reading, const NetCdfVariable& bounds, const std::vector<double>& at) {
    if (!isNumeric(bounds) || bounds.dims.size() != 2 || bounds.dims[0] != at.size() || bounds.dims[1] != 2) return {};
    const std::vector<double> both = allValues(reading, bounds);
    std::vector<double> faces;
    const bool rising = at.size() < 2 || at.front() < at.back();
    for (std::size_t i = 0; i < at.size(); ++i) {
        double begin = both[2 * i], end = both[2 * i + 1];
        if (rising != (begin < end)) std::swap(begin, end);
        if (!faces.empty() && !(std::abs(faces.back() - begin) <= 1e-6 * std::abs(end - begin))) return {};
        if (faces.empty()) faces.push_back(begin);
        faces.push_back(end);
    }
    return faces;
}

/// Times written as text: "2000-01-24_12:00:00".
bool timesOfText(const Reading& reading, const NetCdfVariable& variable, StoredAxis& axis) {
    const std::vector<std::string> lines = reading.nc->lines(variable);
    std::vector<double> times;
    for (const std::string& line : lines) {
        const auto seconds = secondsTo(line);
        if (!seconds) return false;
        times.push_back(*seconds);
    }
    if (times.empty()) return false;
    const double first = times.front();
    for (double& time : times) time -= first;
    axis.kind = AxisKind::Time;
    axis.places = std::move(times);
    axis.unit = "s since " + lines.front();
    return true;
}

void makeAxes(Reading& reading, const std::set<std::string>& listed) {
    const NetCdfFile& nc = *reading.nc;
    for (std::size_t d = 0; d < nc.dimensions.size(); ++d) {
        const NetCdfDimension& dimension = nc.dimensions[d];
        StoredAxis axis{dimension.path, dimension.length};
        const NetCdfVariable* best = nullptr;
        int most = 0;
        for (const NetCdfVariable& variable : nc.variables)
            if (isNumeric(variable) && variable.dimensions == std::vector<int>{int(d)})
                if (const int fits = fitness(reading, variable, listed); fits > most) {
                    most = fits;
                    best = &variable;
                }
        if (best != nullptr && dimension.length > 0) {
            axis.name = best->path;
            describeAxis(axis, best->attributes);
            if (axis.kind == AxisKind::Unknown) axis.kind = kindByName(dimension.path);
            axis.places = allValues(reading, *best);
            reading.used.insert(best->path);
            for (const NetCdfVariable* bounds : allNamed(nc, *best, "bounds"))
                axis.faces = facesBy(reading, *bounds, axis.places);
        } else {
            axis.kind = kindByName(dimension.path);
            if (axis.kind == AxisKind::Unknown && dimension.grows) axis.kind = AxisKind::Time;
        }
        for (const NetCdfVariable& variable : nc.variables)
            if (best == nullptr && variable.vtkType == VTK_CHAR && variable.dims.size() == 2 &&
                variable.dimensions[0] == int(d) && timesOfText(reading, variable, axis))
                reading.used.insert(variable.path);
        reading.file.axes.push_back(std::move(axis));
    }
}

/// Places that need more than one dimension: longitude(y, x).
void makeCurved(Reading& reading, const std::set<std::string>& listed) {
    const NetCdfFile& nc = *reading.nc;
    for (const NetCdfVariable& variable : nc.variables) {
        if (!listed.contains(variable.path) || reading.used.contains(variable.path) || !isNumeric(variable)) continue;
        AxisKind kind = kindByAttributes(variable.attributes);
        if (kind == AxisKind::Unknown) kind = kindByName(leafOf(variable.path));
        const bool space = kind == AxisKind::X || kind == AxisKind::Y || kind == AxisKind::Z;
        if (!space || variable.dims.size() < 2 || variable.dims.size() > 3) continue;
        CurvedPlaces places{kind, variable.dimensions, allValues(reading, variable),
                            textOf(variable.attributes, "units"), variable.path};
        if (lowered(textOf(variable.attributes, "positive")) == "down")
            for (double& at : places.at) at = -at;
        reading.file.curved.push_back(std::move(places));
        reading.used.insert(variable.path);
    }
}

StoredArray arrayOf(const Reading& reading, const NetCdfVariable& variable) {
    StoredArray array;
    array.name = variable.path;
    array.unit = textOf(variable.attributes, "units");
    array.dims = variable.dims;
    array.axes = variable.dimensions;
    array.vtkType = variable.vtkType;
    array.form = formBy(variable.attributes, variable.vtkType);
    for (const double number : variable.unwritten) array.form.fill.push_back(number);
    array.statedBytes = double(vtkDataArray::GetDataTypeSize(variable.vtkType));
    for (const std::size_t n : variable.dims) array.statedBytes *= double(n);
    array.storedBytes = reading.bytes;
    array.words = variable.words.empty() ? wordsOfFlags(variable.attributes) : variable.words;
    array.read = [nc = reading.nc, variable](const Slab& part) { return nc->read(variable, part); };
    return array;
}

/// A single number that is the time of the whole file.
bool isTimeOfFile(const NetCdfVariable& variable) {
    if (!variable.dims.empty() || textOf(variable.attributes, "standard_name").starts_with("forecast_")) return false;
    const std::string word = lowered(leafOf(variable.path));
    return kindByAttributes(variable.attributes) == AxisKind::Time || word == "time";
}

} // namespace

void openNetCdf(Source& source) {
    checkNetCdf(source.path);
    Reading reading;
    reading.nc = std::make_shared<const NetCdfFile>(source.path);
    reading.bytes = double(bytesIn(source.path));
    std::set<std::string> listed;
    for (const NetCdfVariable& variable : reading.nc->variables) {
        for (const NetCdfVariable* place : allNamed(*reading.nc, variable, "coordinates")) listed.insert(place->path);
        for (const char* name : {"bounds", "climatology", "grid_mapping"})
            for (const NetCdfVariable* other : allNamed(*reading.nc, variable, name)) reading.used.insert(other->path);
        if (variable.attributes.contains("grid_mapping_name")) reading.used.insert(variable.path);
    }
    makeAxes(reading, listed);
    makeCurved(reading, listed);
    for (const NetCdfVariable& variable : reading.nc->variables) {
        if (reading.used.contains(variable.path)) continue;
        if (!isNumeric(variable)) {
            reading.file.unread.push_back("\"" + variable.path + "\" (" + variable.kind + ")");
            continue;
        }
        if (isTimeOfFile(variable) && !reading.file.onlyTime) {
            StoredAxis time{variable.path, 1, AxisKind::Time, allValues(reading, variable)};
            time.unit = textOf(variable.attributes, "units");
            reading.file.onlyTime = std::move(time);
            continue;
        }
        reading.file.arrays.push_back(arrayOf(reading, variable));
    }
    if (reading.file.arrays.empty()) throw std::runtime_error("holds no array of numbers");
    openArrays(std::move(reading.file), source);
}

} // namespace tessera::importer
