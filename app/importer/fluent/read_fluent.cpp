// Fluent's cases (.cas) with their values (.dat), in text, binary, and compressed. VTK's reader knows neither names nor
// units, joins phases, and takes the sections of some writers for damage.
#include "app/importer/fluent/fluent_case.h"
#include "app/importer/fluent/fluent_file.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkFloatArray.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();

/// Values of one variable at all cells, one component after the other.
struct FluentArray {
    std::string name, unit;
    std::size_t components = 1;
    std::vector<float> values;
    std::set<std::int64_t> zones; ///< that have some
    std::set<int> stored;         ///< components that are stored as variables of their own
};

struct FluentValues {
    std::vector<FluentArray> arrays;
    std::optional<double> time;
    std::vector<std::string> notes;

    FluentArray& array(const std::string& name, const std::string& unit, std::size_t components, std::size_t cells) {
        const auto at = std::ranges::find(arrays, name, &FluentArray::name);
        if (at != arrays.end()) return *at;
        arrays.push_back({name, unit, components, std::vector<float>(cells * components, kNoNumber), {}, {}});
        return arrays.back();
    }
};

/// "SV_P, domain 1, cell zone 1, 960 cells:" -> the name SV_P and the domain 1; each phase is a domain.
struct Remark {
    std::string storage;
    int domain = 0;
};
Remark remarkOf(const std::string& text) {
    Remark out;
    const std::size_t begin = text.find("SV_");
    if (begin == std::string::npos) return out;
    out.storage = text.substr(begin, text.find_first_of(", \"", begin) - begin);
    if (const std::size_t domain = text.find("domain ", begin); domain != std::string::npos)
        std::from_chars(text.data() + domain + 7, text.data() + text.size(), out.domain);
    return out;
}

/// The time in the variables of the solver: (flow-time 0.5).
std::optional<double> flowTime(std::string_view text) {
    const std::size_t at = text.find("(flow-time ");
    double value = 0;
    if (at == std::string_view::npos ||
        std::from_chars(text.data() + at + 11, text.data() + text.size(), value).ec != std::errc() ||
        !std::isfinite(value))
        return std::nullopt;
    return value;
}

/// Splits names so that values of several phases do not meet: those beyond the first domain get its number.
std::string nameInDomain(const FluentVariable& variable, int domain, int first) {
    return domain == first || domain == 0 ? variable.name : variable.name + " (domain " + std::to_string(domain) + ")";
}

void takeValues(const FluentFile& file, const FluentSection& section, const FluentCase& mesh, int firstDomain,
                FluentValues& out) {
    const std::int64_t number = headerNumber(section, 0, 10), zoneId = headerNumber(section, 1, 10),
                       size = headerNumber(section, 2, 10), first = headerNumber(section, 5, 10),
                       last = headerNumber(section, 6, 10);
    const auto zone = std::ranges::find(mesh.zones, zoneId, &FluentZone::id);
    if (number < 0 || size < 1 || size > 100 || last < first) return;
    if (first < 1) throw std::runtime_error("is damaged in the header of a section");
    const std::size_t count = std::size_t(last - first + 1) * std::size_t(size);
    std::size_t at = section.begin;
    const std::vector<double> numbers = file.numbers(section, at, count);
    if (!file.atEnd(section, at)) throw std::runtime_error("has more values than a section announces");
    const Remark remark = remarkOf(section.comment);
    if (zone == mesh.zones.end() || remark.storage == "SV_FLUX" || number == 18) return; // of a boundary, of faces
    if (std::size_t(last) > mesh.mesh.cells) throw std::runtime_error("has values of cells that its case lacks");
    if (isOfEarlierStep(number, remark.storage)) {
        static const std::string kNote = "values of earlier time steps (of the solver) are left out";
        if (std::ranges::find(out.notes, kNote) == out.notes.end()) out.notes.push_back(kNote);
        return;
    }
    const FluentVariable variable = fluentVariable(number, remark.storage);
    const bool vector = variable.component >= 0 && size == 1;
    const std::size_t components = vector ? 3 : std::size_t(size), cells = mesh.mesh.cells;
    FluentArray& array =
        out.array(nameInDomain(variable, remark.domain, firstDomain), variable.unit, components, cells);
    if (array.components != components) return;
    if (array.zones.empty() && vector && mesh.mesh.dimensions == 2) // there is no third
        std::fill(array.values.begin() + std::ptrdiff_t(2 * cells), array.values.end(), 0.0f);
    array.zones.insert(zoneId);
    if (vector) array.stored.insert(variable.component);
    for (std::size_t n = 0; n < count; ++n) {
        const std::size_t component = vector ? std::size_t(variable.component) : n % std::size_t(size);
        array.values[component * cells + std::size_t(first) - 1 + n / std::size_t(size)] = float(numbers[n]);
    }
}

/// A vector of which not all components are stored becomes scalars.
void splitIncomplete(FluentValues& values, const FluentCase& mesh) {
    const std::size_t cells = mesh.mesh.cells;
    std::vector<FluentArray> out;
    for (FluentArray& array : values.arrays) {
        if (array.stored.empty() || int(array.stored.size()) >= mesh.mesh.dimensions) {
            out.push_back(std::move(array));
            continue;
        }
        for (const int c : array.stored)
            out.push_back({std::string(1, char('x' + c)) + "-" + array.name,
                           array.unit,
                           1,
                           {array.values.begin() + std::ptrdiff_t(std::size_t(c) * cells),
                            array.values.begin() + std::ptrdiff_t((std::size_t(c) + 1) * cells)},
                           array.zones,
                           {}});
    }
    values.arrays = std::move(out);
}

FluentValues readFluentValues(const std::string& path, const FluentCase& mesh) {
    FluentFile file(path);
    FluentValues values;
    FluentSection section;
    std::size_t sections = 0;
    int firstDomain = 0;
    for (; file.next(section); ++sections) {
        if (section.number == 33 && headerNumber(section, 0, 10) > std::int64_t(mesh.mesh.cells))
            throw std::runtime_error("has more cells than its case");
        if (section.number == 300) {
            if (firstDomain == 0) firstDomain = remarkOf(section.comment).domain;
            takeValues(file, section, mesh, firstDomain, values);
        }
        if (!values.time && !section.binary && section.number != 300)
            values.time = flowTime(std::string_view(file.bytes()).substr(section.open, section.close - section.open));
    }
    if (sections == 0) throw std::runtime_error("is no Fluent file");
    if (values.arrays.empty()) throw std::runtime_error("holds no values of cells");
    splitIncomplete(values, mesh);
    return values;
}

/// The name without .cas, .msh, and .gz.
std::string stemOf(const std::string& path) {
    std::string stem = path.ends_with(".gz") ? path.substr(0, path.size() - 3) : path;
    return fs::path(stem).replace_extension().string();
}

/// The files of values of a case: of the same name, else those whose names begin with it, which are times.
std::vector<std::string> valuesOf(const std::string& path) {
    const std::string stem = stemOf(path);
    for (const char* ending : {".dat", ".dat.gz", ".DAT"})
        if (fs::exists(stem + ending)) return {stem + ending};
    const fs::path folder = fs::path(path).parent_path().empty() ? fs::path(".") : fs::path(path).parent_path();
    const std::string begin = fs::path(stem).filename().string() + "-";
    std::vector<std::string> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with(begin) && (name.ends_with(".dat") || name.ends_with(".dat.gz")))
            found.push_back((fs::path(path).parent_path() / name).string());
    }
    std::ranges::sort(found);
    return found;
}

struct OpenedFluent {
    FluentCase mesh;
    std::vector<vtkSmartPointer<vtkUnstructuredGrid>> blocks; ///< by zone
    std::vector<std::string> names;
    std::vector<std::string> files; ///< of values, by time
};

template <class Body> auto inFluentFile(const std::string& path, Body&& body) {
    try {
        return body();
    } catch (const std::runtime_error& error) {
        throw std::runtime_error("its file " + fs::path(path).filename().string() + " " + error.what());
    }
}

vtkSmartPointer<vtkDataObject> withValues(const OpenedFluent& opened, const FluentValues& values) {
    auto out = vtkSmartPointer<vtkMultiBlockDataSet>::New();
    const std::size_t all = opened.mesh.mesh.cells;
    for (std::size_t z = 0; z < opened.blocks.size(); ++z) {
        const FluentZone& zone = opened.mesh.zones[z];
        vtkNew<vtkUnstructuredGrid> grid;
        grid->ShallowCopy(opened.blocks[z]);
        for (const FluentArray& from : values.arrays) {
            if (!from.zones.contains(zone.id)) continue;
            vtkNew<vtkFloatArray> array;
            array->SetName(from.name.c_str());
            array->SetNumberOfComponents(int(from.components));
            array->SetNumberOfTuples(vtkIdType(zone.last - zone.first));
            for (std::size_t c = zone.first; c < zone.last; ++c)
                for (std::size_t n = 0; n < from.components; ++n)
                    array->SetValue(vtkIdType((c - zone.first) * from.components + n), from.values[n * all + c]);
            grid->GetCellData()->AddArray(array);
        }
        out->SetBlock(unsigned(z), grid);
        out->GetMetaData(unsigned(z))->Set(vtkCompositeDataSet::NAME(), opened.names[z]);
    }
    return out;
}

/// The last number in a name: a-1-00020.dat -> 20.
double stepInName(const std::string& path) {
    const std::string stem = fs::path(stemOf(path)).filename().string();
    const std::size_t last = stem.find_last_of("0123456789");
    if (last == std::string::npos) return 0;
    std::size_t begin = last;
    while (begin > 0 && std::isdigit(static_cast<unsigned char>(stem[begin - 1])) != 0) --begin;
    return std::strtod(stem.substr(begin, last - begin + 1).c_str(), nullptr);
}

/// Sorts the files by their times: those that they state, else the numbers in their names.
void setTimes(OpenedFluent& opened, Source& source) {
    std::vector<std::pair<double, std::string>> stated, counted;
    for (const std::string& path : opened.files) {
        counted.emplace_back(stepInName(path), path);
        const auto time = inFluentFile(path, [&] { return readFluentValues(path, opened.mesh).time; });
        if (time) stated.emplace_back(*time, path);
    }
    const bool ofFiles = stated.size() == counted.size();
    std::vector<std::pair<double, std::string>>& times = ofFiles ? stated : counted;
    std::ranges::stable_sort(times, {}, &std::pair<double, std::string>::first);
    opened.files.clear();
    for (const auto& [time, path] : times) {
        if (!source.times.empty() && !(time > source.times.back())) {
            source.notes.push_back("its file " + fs::path(path).filename().string() +
                                   " is left out: it has the time of another");
            continue;
        }
        source.times.push_back(time);
        opened.files.push_back(path);
    }
    if (ofFiles)
        source.timeUnit = "s";
    else
        source.timeName = "step";
}

void nameBlocks(OpenedFluent& opened) {
    for (const FluentZone& zone : opened.mesh.zones) {
        std::string name = zone.name.empty() ? "zone " + std::to_string(zone.id) : zone.name;
        if (std::ranges::find(opened.names, name) != opened.names.end()) name += " " + std::to_string(zone.id);
        opened.names.push_back(opened.mesh.zones.size() == 1 ? std::string() : name);
    }
}

} // namespace

void openFluent(Source& source) {
    if (readPart(source.path, 0, 11) == "$MeshFormat") return openGmsh(source);
    const auto opened = std::make_shared<OpenedFluent>();
    opened->files = valuesOf(source.path);
    if (opened->files.empty())
        throw std::runtime_error("holds a mesh without values: its file " +
                                 fs::path(stemOf(source.path)).filename().string() + ".dat is not beside it");
    inFluentFile(source.path, [&] {
        opened->mesh = readFluentCase(source.path);
        return 0;
    });
    nameBlocks(*opened);
    for (const FluentZone& zone : opened->mesh.zones)
        opened->blocks.push_back(cellsOfFaces(opened->mesh.mesh, opened->mesh.faces, zone.first, zone.last));
    opened->mesh.mesh.points = {};
    opened->mesh.faces = {};
    if (opened->files.size() > 1) setTimes(*opened, source);
    const auto first = std::make_shared<FluentValues>(
        inFluentFile(opened->files[0], [&] { return readFluentValues(opened->files[0], opened->mesh); }));
    for (const FluentArray& array : first->arrays)
        if (!array.unit.empty()) source.units[array.name] = array.unit;
    source.notes.insert(source.notes.end(), first->notes.begin(), first->notes.end());
    if (source.times.empty() && first->time) {
        source.times = {*first->time};
        source.timeUnit = "s";
    }
    const auto last = std::make_shared<std::pair<std::size_t, FluentValues>>(0, std::move(*first));
    source.read = [opened, last](std::size_t time) {
        if (last->first != time)
            *last = {time, inFluentFile(opened->files.at(time),
                                        [&] { return readFluentValues(opened->files[time], opened->mesh); })};
        return withValues(*opened, last->second);
    };
}

} // namespace tessera::importer
