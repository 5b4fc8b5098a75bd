// Fluent's cases and data in HDF5, written since 2020: NAME.cas.h5 with NAME.dat.h5, or with a series of them.
#include "app/importer/hdf/fluent_mesh.h"
#include "app/importer/readers/give_times.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>
#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

/// Fluent's solution variables that have a short name, and their SI units. Others keep theirs, in small letters.
struct SolutionVariable {
    const char* variable;
    const char* name;
    const char* unit;
};
constexpr SolutionVariable kVariables[] = {{"SV_P", "p", "Pa"},
                                           {"SV_T", "T", "K"},
                                           {"SV_U", "U", "m/s"},
                                           {"SV_DENSITY", "density", "kg/m3"},
                                           {"SV_H", "enthalpy", "J/kg"},
                                           {"SV_K", "k", "m2/s2"},
                                           {"SV_D", "epsilon", "m2/s3"},
                                           {"SV_O", "omega", "1/s"},
                                           {"SV_MU_LAM", "viscosity", "Pa s"},
                                           {"SV_MU_T", "turbulent_viscosity", "Pa s"},
                                           {"SV_KLAM", "thermal_conductivity", "W/m/K"},
                                           {"SV_CP", "specific_heat", "J/kg/K"},
                                           {"SV_WALL_DIST", "wall_distance", "m"},
                                           {"SV_VOLUME", "cell_volume", "m3"},
                                           {"SV_VOF", "volume_fraction", ""}};

bool endsAs(const std::string& path, const std::string& ending) {
    std::string name = path;
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return name.ends_with(ending);
}

std::string withoutEnding(const std::string& path) {
    for (const char* ending : {".cas.h5", ".dat.h5", ".msh.h5"})
        if (endsAs(path, ending)) return path.substr(0, path.size() - 7);
    return fs::path(path).replace_extension().string();
}

/// Names that a step of a series may belong to: "run-1-00010", then "run-1", then "run".
std::vector<std::string> stemsOf(std::string stem) {
    std::vector<std::string> stems{stem};
    for (;;) {
        const std::size_t digits = stem.find_last_not_of("0123456789.");
        if (digits == std::string::npos || digits + 1 == stem.size() || (stem[digits] != '-' && stem[digits] != '_'))
            return stems;
        stem.resize(digits);
        stems.push_back(stem);
    }
}

std::string caseOf(const std::string& data) {
    for (const std::string& stem : stemsOf(withoutEnding(data)))
        if (const std::string path = stem + ".cas.h5"; fs::exists(path)) return path;
    throw std::runtime_error("holds values without a mesh: its case " +
                             fs::path(withoutEnding(data)).filename().string() + ".cas.h5 is not beside it");
}

/// The data files of a case: that of its name, else those of its series.
std::vector<std::string> dataOf(const std::string& path) {
    const std::string stem = withoutEnding(path);
    if (fs::exists(stem + ".dat.h5")) return {stem + ".dat.h5"};
    std::vector<std::string> found;
    const fs::path folder = fs::path(stem).parent_path();
    std::error_code failed;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder.empty() ? fs::path(".") : folder, failed)) {
        const std::string own = (folder / entry.path().filename()).string();
        if (!endsAs(own, ".dat.h5")) continue;
        const std::vector<std::string> stems = stemsOf(withoutEnding(own));
        if (std::ranges::find(stems, stem) == stems.end() || fs::exists(withoutEnding(own) + ".cas.h5")) continue;
        found.push_back(own);
    }
    std::sort(found.begin(), found.end(), [](const std::string& a, const std::string& b) {
        return a.size() != b.size() ? a.size() < b.size() : a < b;
    });
    return found;
}

/// The number after a name in lists of Scheme, "(flow-time 0.25)".
std::optional<double> numberNamed(const HdfFile& file, const std::string& name) {
    for (const std::string& text : file.texts("settings/Data Variables")) {
        const std::size_t at = text.find("(" + name + " ");
        if (at == std::string::npos) continue;
        const char* begin = text.c_str() + at + name.size() + 2;
        if (*begin == '.' && begin[1] == ' ') begin += 2;
        char* end = nullptr;
        const double number = std::strtod(begin, &end);
        if (end != begin && std::isfinite(number)) return number;
    }
    return std::nullopt;
}

/// The species of the first mixture with a list of them: "(species (names h2 o2 h2o))".
std::vector<std::string> speciesOf(const HdfFile& file) {
    for (const std::string& text : file.texts("settings/Rampant Variables")) {
        const std::size_t list = text.find("(species (names ");
        if (list == std::string::npos) continue;
        std::vector<std::string> names;
        std::string word;
        for (std::size_t at = list + 16; at < text.size(); ++at) {
            if (text[at] == '(') continue;
            if (std::isspace(static_cast<unsigned char>(text[at])) == 0 && text[at] != ')') {
                word += text[at];
                continue;
            }
            if (!word.empty()) names.push_back(std::exchange(word, ""));
            if (text[at] == ')') break;
        }
        return names;
    }
    return {};
}

/// One parameter and the data sets that hold its components.
struct FluentField {
    std::string name, unit;
    std::vector<std::string> groups; ///< of one component each, or one of several
    std::size_t column = 0, columns = 1;
};

struct Naming {
    const std::vector<std::string>& species;
    std::string prefix;

    FluentField of(const std::string& variable, const std::string& group) const {
        FluentField field{"", "", {group}};
        for (const SolutionVariable& known : kVariables)
            if (variable == known.variable) {
                field.name = prefix + known.name;
                field.unit = known.unit;
                return field;
            }
        if (variable.starts_with("SV_Y_")) {
            const std::string number = variable.substr(5);
            const std::size_t index = number.find_first_not_of("0123456789") == std::string::npos && number.size() < 6
                                          ? std::size_t(std::stoul("0" + number))
                                          : species.size();
            field.name = prefix + (index < species.size() ? species[index] : "Y_" + number);
            return field;
        }
        std::string name = variable.starts_with("SV_") ? variable.substr(3) : variable;
        std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
        field.name = prefix + name;
        return field;
    }
};

/// All values of one component by number of cell; NaN where there is none.
std::vector<double> readColumn(const HdfFile& file, const std::string& group, std::size_t column, std::size_t cells) {
    std::vector<double> values(cells, std::numeric_limits<double>::quiet_NaN());
    for (const std::string& section : file.members(group)) {
        const std::string path = group + "/" + section;
        const std::optional<HdfShape> shape = file.shape(path);
        const std::vector<double> first = file.attribute(path, "minId");
        if (!shape || !shape->numbers || shape->dims.empty() || first.empty() || !(first[0] >= 1)) continue;
        const std::size_t columns = shape->dims.size() > 1 ? shape->dims[1] : 1, rows = shape->dims[0];
        const std::vector<double> numbers = file.doubles(path);
        for (std::size_t row = 0; row < rows && column < columns; ++row)
            if (const std::size_t cell = std::size_t(first[0]) - 1 + row; cell < cells)
                values[cell] = numbers[row * columns + column];
    }
    return values;
}

/// The number of columns of the data sets of a variable.
std::size_t columnsOf(const HdfFile& file, const std::string& group) {
    for (const std::string& section : file.members(group))
        if (const std::optional<HdfShape> shape = file.shape(group + "/" + section); shape && shape->numbers)
            return shape->dims.size() > 1 ? shape->dims[1] : 1;
    return 0;
}

void addFields(const HdfFile& file, const std::string& cells, const Naming& naming, std::vector<FluentField>& fields,
               std::set<std::string>& earlier) {
    const std::vector<std::string> variables = file.members(cells);
    const auto has = [&](const char* name) { return std::ranges::find(variables, name) != variables.end(); };
    for (const std::string& variable : variables) {
        const std::string group = cells + "/" + variable;
        if (!file.isGroup(group)) continue;
        if (variable.ends_with("_M1") || variable.ends_with("_M2")) {
            earlier.insert(variable);
            continue;
        }
        if ((variable == "SV_V" || variable == "SV_W") && has("SV_U")) continue; // with SV_U
        const std::size_t columns = columnsOf(file, group);
        if (columns == 0) continue;
        FluentField field = naming.of(variable, group);
        if (variable == "SV_U" && has("SV_V")) {
            field.groups.push_back(cells + "/SV_V");
            if (has("SV_W")) field.groups.push_back(cells + "/SV_W");
        }
        for (std::size_t column = 0; column < columns; ++column) {
            FluentField part = field;
            part.column = column;
            if (variable == "SV_Y" && columns > 1)
                part.name = naming.of("SV_Y_" + std::to_string(column), group).name;
            else if (columns == 3 && variable != "SV_Y")
                part.columns = 3;
            else if (columns > 1)
                part.name += "." + std::to_string(column);
            fields.push_back(part);
            if (part.columns == 3) break;
        }
    }
}

std::vector<FluentField> fieldsOf(const HdfFile& file, const std::vector<std::string>& species,
                                  std::set<std::string>& earlier) {
    std::vector<FluentField> fields;
    for (const std::string& phase : file.members("results/1")) // phase-1 is the mixture, or the only one
        if (phase.starts_with("phase-"))
            addFields(file, "results/1/" + phase + "/cells", {species, phase == "phase-1" ? "" : phase + "."}, fields,
                      earlier);
    return fields;
}

/// The values of a field in the order of the cells of each zone; null where it has none.
std::vector<vtkSmartPointer<vtkDoubleArray>> valuesOf(const HdfFile& file, const FluentField& field,
                                                      const std::vector<FluentZone>& zones) {
    std::size_t cells = 0;
    for (const FluentZone& zone : zones) cells = std::max(cells, std::size_t(zone.cells.back()));
    std::vector<std::vector<double>> parts;
    for (const std::string& group : field.groups)
        for (std::size_t column = 0; column < field.columns; ++column)
            parts.push_back(readColumn(file, group, field.column + column, cells));
    if (parts.size() == 2) parts.emplace_back(cells, 0.0); // a flat mesh
    std::vector<vtkSmartPointer<vtkDoubleArray>> out;
    for (const FluentZone& zone : zones) {
        auto values = vtkSmartPointer<vtkDoubleArray>::New();
        values->SetName(field.name.c_str());
        values->SetNumberOfComponents(int(parts.size()));
        values->SetNumberOfTuples(vtkIdType(zone.cells.size()));
        bool any = false;
        for (std::size_t n = 0; n < zone.cells.size(); ++n)
            for (std::size_t part = 0; part < parts.size(); ++part) {
                const double value = parts[part][std::size_t(zone.cells[n] - 1)];
                any = any || !std::isnan(value);
                values->SetComponent(vtkIdType(n), int(part), value);
            }
        out.push_back(any ? values : nullptr);
    }
    return out;
}

} // namespace

void openFluentHdf(Source& source) {
    HdfFile given(source.path);
    const bool isCase = given.isGroup("meshes/1");
    if (!isCase && !given.isGroup("results")) throw std::runtime_error("is no case or data of Fluent");
    const HdfFile mesh = isCase ? given : HdfFile(caseOf(source.path));
    const bool both = isCase && given.isGroup("results/1");
    const std::vector<std::string> files =
        isCase && !both ? dataOf(source.path) : std::vector<std::string>{source.path};
    if (files.empty())
        throw std::runtime_error("holds a mesh without values: its file " +
                                 fs::path(withoutEnding(source.path)).filename().string() + ".dat.h5 is not beside it");
    const auto zones = std::make_shared<const std::vector<FluentZone>>(readFluentMesh(mesh, source.notes));
    auto data = std::make_shared<std::vector<HdfFile>>();
    std::vector<double> times;
    std::set<std::string> earlier;
    const std::vector<std::string> species = speciesOf(mesh);
    auto fields = std::make_shared<std::vector<std::vector<FluentField>>>();
    std::set<std::string> seen;
    source.shownAt.clear();
    for (const std::string& path : files) {
        data->emplace_back(path);
        fields->push_back(fieldsOf(data->back(), species, earlier));
        const std::optional<double> time = numberNamed(data->back(), "flow-time"),
                                    step = numberNamed(data->back(), "time-step");
        // A steady flow has no time: each file counts.
        times.push_back(time && (*time != 0 || (step && *step != 0) || files.size() == 1) ? *time
                                                                                          : double(times.size()));
        for (const FluentField& field : fields->back())
            if (!field.unit.empty()) source.units[field.name] = field.unit;
    }
    if (fields->front().empty()) throw std::runtime_error("holds no values at cells");
    if (!earlier.empty())
        source.notes.push_back(std::to_string(earlier.size()) + " variables of earlier time steps (" +
                               *earlier.begin() + " ...) left out");
    std::vector<std::size_t> order{0};
    if (files.size() > 1 || times.front() != 0) {
        order = giveTimes(source, times);
        source.timeUnit = "s";
    }
    for (std::size_t t = 0; t < order.size(); ++t) {
        bool news = t == 0;
        for (const FluentField& field : (*fields)[order[t]]) news = seen.insert(field.name).second || news;
        if (news) source.shownAt.push_back(t);
    }
    source.lengthUnit = "m";
    source.read = [zones, data, fields, order](std::size_t time) -> vtkSmartPointer<vtkDataObject> {
        const std::size_t step = order[std::min(time, order.size() - 1)];
        std::vector<vtkSmartPointer<vtkUnstructuredGrid>> meshes;
        for (const FluentZone& zone : *zones) {
            meshes.push_back(vtkSmartPointer<vtkUnstructuredGrid>::New());
            meshes.back()->CopyStructure(zone.mesh);
        }
        for (const FluentField& field : (*fields)[step]) {
            const auto values = valuesOf((*data)[step], field, *zones);
            for (std::size_t z = 0; z < meshes.size(); ++z)
                if (values[z] != nullptr) meshes[z]->GetCellData()->AddArray(values[z]);
        }
        vtkNew<vtkMultiBlockDataSet> blocks;
        for (std::size_t z = 0; z < meshes.size(); ++z) {
            blocks->SetBlock(unsigned(z), meshes[z]);
            blocks->GetMetaData(unsigned(z))->Set(vtkCompositeDataSet::NAME(), (*zones)[z].name.c_str());
        }
        return blocks;
    };
}

} // namespace tessera::importer
