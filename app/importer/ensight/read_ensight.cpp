// EnSight Gold by our own reader. VTK's gives each time the values of one time set, ignores what begins later, loses
// valid values beside undefined ones, and reports its pipeline instead of a reason.
#include "app/importer/ensight/ensight_case.h"
#include "app/importer/ensight/ensight_parts.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"
#include "volume/base/unit_conversion.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <vtkAppendFilter.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkFloatArray.h>
#include <vtkGenericEnSightReader.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

/// The geometry of a step, as it was last read.
struct KnownParts {
    std::string path;
    std::size_t step = 0;
    EnSightForm form;
    std::vector<EnSightPart> parts;
};

struct EnSightData {
    std::vector<EnSightCase> cases; ///< one, or those of several servers
    std::vector<double> times;      ///< empty: none stated
    std::vector<KnownParts> known;  ///< by case
    std::shared_ptr<std::vector<std::string>> notes;
};

std::string nameBeside(const EnSightCase& about, const std::string& path) {
    const fs::path folder = fs::path(about.path).parent_path();
    return fs::path(path).lexically_relative(folder.empty() ? fs::path(".") : folder).string();
}

/// Calls body() and names the file in what it throws.
void ofFile(const EnSightCase& about, const std::string& path, auto&& body) {
    try {
        body();
    } catch (const std::runtime_error& error) {
        throw std::runtime_error("its file " + nameBeside(about, path) + " " + error.what());
    }
}

/// Cells of a geometry whose files hold points alone after the first.
void borrowCells(const EnSightCase& about, std::vector<EnSightPart>& parts) {
    if (!about.coordinatesOnly ||
        std::ranges::none_of(parts, [](const EnSightPart& part) { return part.points > 0 && part.cellCount() == 0; }))
        return;
    const EnSightPlace place = placeOf(about, about.geometry, about.cellsAt);
    ofFile(about, place.path, [&] {
        EnSightBytes file(place.path, place.step);
        for (EnSightPart& from : readEnSightParts(file))
            for (EnSightPart& part : parts)
                if (part.number == from.number && part.cells.empty() && part.points == from.points)
                    part.cells = std::move(from.cells);
    });
}

const KnownParts& partsAt(const EnSightCase& about, double time, KnownParts& known) {
    const std::size_t step = stepAt(about, about.geometry, time, true).value_or(0);
    const EnSightPlace place = placeOf(about, about.geometry, step);
    if (known.path == place.path && known.step == place.step) return known;
    known = {};
    ofFile(about, place.path, [&] {
        EnSightBytes file(place.path, place.step);
        known.form = file.form();
        known.parts = readEnSightParts(file);
    });
    borrowCells(about, known.parts);
    known.path = place.path;
    known.step = place.step;
    return known;
}

std::size_t componentsOf(EnSightVariable::Kind kind) {
    using Kind = EnSightVariable::Kind;
    return kind == Kind::Scalar ? 1 : kind == Kind::Vector ? 3 : kind == Kind::Symmetric ? 6 : 9;
}

/// Adds the values of a part: scalars and vectors as one array, tensors as one for each component.
void addValues(const EnSightVariable& variable, const EnSightValues& from, const EnSightGrid& grid) {
    static constexpr const char* kSymmetric[] = {"xx", "yy", "zz", "xy", "xz", "yz"};
    static constexpr const char* kTensor[] = {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};
    const std::size_t components = componentsOf(variable.kind), all = from.values.size() / components;
    const bool some = variable.ofCells && !grid.kept.empty();
    const std::size_t count = some ? grid.kept.size() : all;
    vtkDataSetAttributes* to = grid.data->GetPointData();
    if (variable.ofCells) to = grid.data->GetCellData();
    const std::size_t together = components > 3 ? 1 : components;
    for (std::size_t first = 0; first < components; first += together) {
        vtkNew<vtkFloatArray> array;
        std::string name = variable.name;
        if (components == 6) name += std::string(".") + kSymmetric[first];
        if (components == 9) name += std::string(".") + kTensor[first];
        array->SetName(name.c_str());
        array->SetNumberOfComponents(int(together));
        array->SetNumberOfTuples(vtkIdType(count));
        for (std::size_t n = 0; n < count; ++n)
            for (std::size_t c = 0; c < together; ++c)
                array->SetValue(vtkIdType(n * together + c),
                                from.values[(first + c) * all + (some ? grid.kept[n] : n)]);
        to->AddArray(array);
    }
}

/// The name of each part, made distinct.
std::vector<std::string> namesOf(const std::vector<EnSightPart>& parts) {
    std::vector<std::string> names;
    for (const EnSightPart& part : parts) {
        std::string name = part.name.empty() ? "part " + std::to_string(part.number) : part.name;
        if (std::ranges::find(names, name) != names.end()) name += " (part " + std::to_string(part.number) + ")";
        names.push_back(name);
    }
    return names;
}

void noteOnce(std::vector<std::string>& notes, const std::string& note) {
    if (std::ranges::find(notes, note) == notes.end()) notes.push_back(note);
}

/// Whether a part is a volume: boundaries often have no values, and are not shown.
bool isSolid(vtkDataSet& data) {
    return data.GetNumberOfCells() > 0 && data.GetCell(0)->GetCellDimension() == 3;
}

struct NamedBlock {
    std::string name;
    vtkSmartPointer<vtkDataSet> data;
};

/// Adds the blocks of a case at a time. Parts of other servers with the same name are joined.
void addBlocks(const EnSightCase& about, double time, KnownParts& known, std::vector<NamedBlock>& blocks,
               std::vector<std::string>& notes) {
    const KnownParts& geometry = partsAt(about, time, known);
    std::vector<EnSightGrid> grids;
    for (const EnSightPart& part : geometry.parts) grids.push_back(gridOfPart(part));
    for (const EnSightVariable& variable : about.variables) {
        const std::optional<std::size_t> step = stepAt(about, variable.file, time, false);
        if (!step) continue;
        const EnSightPlace place = placeOf(about, variable.file, *step);
        if (!fs::exists(place.path)) continue; // said when the case was opened
        ofFile(about, place.path, [&] {
            EnSightBytes file(place.path, place.step, geometry.form);
            const auto values = readEnSightValues(file, geometry.parts, componentsOf(variable.kind), variable.ofCells);
            for (std::size_t p = 0; p < grids.size(); ++p)
                if (values[p] && grids[p].data != nullptr)
                    addValues(variable, *values[p], grids[p]);
                else if (grids[p].data != nullptr && isSolid(*grids[p].data))
                    noteOnce(notes,
                             variable.name + " has no values in part " + std::to_string(geometry.parts[p].number));
        });
    }
    const std::vector<std::string> names = namesOf(geometry.parts);
    const std::size_t own = blocks.size();
    for (std::size_t p = 0; p < grids.size(); ++p) {
        if (grids[p].data == nullptr) continue;
        const std::string left = "part " + names[p] + ": its " + std::to_string(grids[p].left) +
                                 " surface cells, lines and points beside cells of more dimensions are left out";
        if (grids[p].left > 0) noteOnce(notes, left);
        const auto same = std::find_if(blocks.begin(), blocks.begin() + std::ptrdiff_t(own),
                                       [&](const NamedBlock& block) { return block.name == names[p]; });
        if (same == blocks.begin() + std::ptrdiff_t(own)) {
            blocks.push_back({names[p], grids[p].data});
            continue;
        }
        vtkNew<vtkAppendFilter> append;
        append->AddInputData(same->data);
        append->AddInputData(grids[p].data);
        append->Update();
        same->data = append->GetOutput();
    }
}

vtkSmartPointer<vtkDataObject> readEnSight(EnSightData& data, std::size_t time) {
    std::vector<NamedBlock> blocks;
    for (std::size_t c = 0; c < data.cases.size(); ++c)
        addBlocks(data.cases[c], data.times.empty() ? 0 : data.times.at(time), data.known[c], blocks, *data.notes);
    auto out = vtkSmartPointer<vtkMultiBlockDataSet>::New();
    for (const NamedBlock& block : blocks) {
        const unsigned b = out->GetNumberOfBlocks();
        out->SetBlock(b, block.data);
        out->GetMetaData(b)->Set(vtkCompositeDataSet::NAME(), blocks.size() == 1 ? std::string() : block.name);
    }
    return out;
}

std::string shown(double number) {
    char text[40];
    std::snprintf(text, sizeof text, "%.9g", number);
    return text;
}

/// Notes the files of variables that do not exist. A last line that was cut names one.
void noteMissing(const EnSightCase& about, const std::vector<double>& times, Source& source) {
    const std::string text = readWhole(about.path);
    for (const EnSightVariable& variable : about.variables) {
        std::size_t missing = 0, all = 0;
        std::string first;
        for (std::size_t t = 0; t < std::max<std::size_t>(1, times.size()); ++t) {
            const double time = times.empty() ? 0 : times[t];
            const auto step = stepAt(about, variable.file, time, false);
            if (!step) continue;
            ++all;
            const std::string path = placeOf(about, variable.file, *step).path;
            if (fs::exists(path)) continue;
            if (missing++ == 0) first = nameBeside(about, path) + (times.empty() ? "" : " (time " + shown(time) + ")");
        }
        if (missing == 0) continue;
        if (!text.ends_with('\n') && text.ends_with(variable.file.name))
            throw std::runtime_error("names " + variable.file.name + ", which does not exist: truncated");
        source.notes.push_back(variable.name + (missing == all ? " is left out" : " is absent at some times") +
                               ": its file " + first + " does not exist" +
                               (missing > 1 ? ", nor " + std::to_string(missing - 1) + " more" : ""));
    }
}

/// The times that together show everything: all where the mesh changes, else the first of each variable.
std::vector<std::size_t> timesToShow(const EnSightData& data) {
    std::set<std::size_t> shown{0};
    for (const EnSightCase& about : data.cases) {
        const EnSightTimes* changes = timesOf(about, about.geometry);
        for (std::size_t t = 0; t < data.times.size(); ++t)
            if (changes != nullptr && changes->values.size() > 1 && stepAt(about, about.geometry, data.times[t], false))
                shown.insert(t);
        for (const EnSightVariable& variable : about.variables)
            for (std::size_t t = 0; t < data.times.size(); ++t)
                if (const auto step = stepAt(about, variable.file, data.times[t], false);
                    step && fs::exists(placeOf(about, variable.file, *step).path)) {
                    shown.insert(t);
                    break;
                }
    }
    return {shown.begin(), shown.end()};
}

/// EnSight 6 stores each point with all of its coordinates; VTK's reader knows it.
void openEnSight6(Source& source) {
    vtkNew<vtkGenericEnSightReader> reader;
    reader->SetCaseFileName(source.path.c_str());
    reader->ReadAllVariablesOn();
    source.reader = reader;
}

} // namespace

void openEnSight(Source& source) {
    const auto data = std::make_shared<EnSightData>();
    if (fs::path(source.path).extension() == ".sos")
        for (const std::string& path : casesOfServers(source.path)) {
            if (!fs::exists(path)) throw std::runtime_error("names " + path + ", which does not exist");
            data->cases.push_back(readEnSightCase(path));
        }
    else
        data->cases.push_back(readEnSightCase(source.path));
    if (!data->cases[0].gold && data->cases.size() == 1) return openEnSight6(source);
    data->known.resize(data->cases.size());
    data->times = allTimes(data->cases[0]);
    for (const EnSightCase& about : data->cases) {
        source.notes.insert(source.notes.end(), about.notes.begin(), about.notes.end());
        noteMissing(about, data->times, source);
    }
    source.times = data->times;
    for (const EnSightConstant& constant : data->cases[0].constants) {
        volume::Quantity quantity{constant.name, "", {}};
        const EnSightFile sets{"", constant.timeSet, -1};
        for (std::size_t t = 0; t < std::max<std::size_t>(1, data->times.size()); ++t) {
            std::size_t at = 0;
            if (constant.values.size() > 1 && !data->times.empty())
                at = timesOf(data->cases[0], sets) != nullptr
                         ? stepAt(data->cases[0], sets, data->times[t], true).value_or(0)
                         : t;
            quantity.values.push_back(constant.values[std::min(at, constant.values.size() - 1)]);
        }
        source.quantities.push_back(std::move(quantity));
    }
    source.shownAt = timesToShow(*data);
    data->notes = source.found;
    source.read = [data](std::size_t time) { return readEnSight(*data, time); };
}

} // namespace tessera::importer
