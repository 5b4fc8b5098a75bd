// XDMF 2 and 3: which grids there are at which times, and what of them is shown.
#include "app/importer/hdf/xdmf_grid.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>
#include <vtkCompositeDataSet.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>

namespace tessera::importer {

namespace {

constexpr int kMostNested = 32;
constexpr std::size_t kMostGrids = 1'000'000;

/// A uniform Grid, where it stands among the collections.
struct PlacedGrid {
    pugi::xml_node node;
    std::string name;           ///< of its block, "" = none
    std::size_t index = 0;      ///< among the grids of its time
    std::optional<double> time; ///< none: the same at all times
};

struct Walk {
    const XdmfDocument& document;
    const XdmfItems& items;
    std::vector<std::string>& notes;
    std::vector<PlacedGrid> grids = {};
    bool counted = false; ///< times are numbers of steps
};

void note(std::vector<std::string>& notes, const std::string& text) {
    if (std::ranges::find(notes, text) == notes.end()) notes.push_back(text);
}

/// The times that a Grid states, for itself or for `count` grids in it.
std::vector<double> timesOf(const Walk& walk, pugi::xml_node grid, std::size_t count) {
    std::vector<double> times;
    for (const pugi::xml_node time : walk.document.children(grid, "Time")) {
        const std::string kind = xdmfWord(xdmfAttribute(time, {"TimeType", "Type"}));
        std::vector<double> numbers = xdmfNumbers(xdmfAttribute(time, {"Value"}));
        if (numbers.empty()) {
            const pugi::xml_node item = walk.document.child(time, "DataItem");
            numbers = item ? walk.items.read(item).list() : xdmfNumbers(time.text().get());
        }
        if (kind == "hyperslab" && numbers.size() >= 3) {
            for (double n = 0; n < std::min(numbers[2], double(kMostGrids)); ++n)
                times.push_back(numbers[0] + n * numbers[1]);
        } else if (kind == "range" && numbers.size() >= 2) {
            for (std::size_t n = 0; n < std::max<std::size_t>(count, 1); ++n)
                times.push_back(numbers[0] +
                                (count > 1 ? (numbers[1] - numbers[0]) * double(n) / double(count - 1) : 0));
        } else {
            times.insert(times.end(), numbers.begin(), numbers.end());
        }
    }
    for (const double time : times)
        if (!std::isfinite(time)) throw std::runtime_error("has a time that is no number");
    return times;
}

void visit(Walk& walk, pugi::xml_node grid, const std::string& name, std::optional<double> time, int depth) {
    if (depth > kMostNested) throw std::runtime_error("has collections in collections without end");
    if (walk.grids.size() > kMostGrids) throw std::runtime_error("holds too many grids");
    const std::string kind = xdmfWord(xdmfAttribute(grid, {"GridType", "Type"}));
    const std::string own = xdmfAttribute(grid, {"Name"});
    if (kind == "subset") return note(walk.notes, "grid \"" + own + "\" left out: subsets are not read");
    const bool collection = kind == "collection" || kind == "tree";
    const bool temporal = collection && xdmfWord(xdmfAttribute(grid, {"CollectionType"})) == "temporal";
    const std::vector<pugi::xml_node> inside =
        collection ? walk.document.children(grid, "Grid") : std::vector<pugi::xml_node>();
    const std::vector<double> times = timesOf(walk, grid, inside.size());
    if (!temporal && !times.empty()) time = times.front();
    if (!collection) {
        walk.grids.push_back({grid, name, 0, time});
        return;
    }
    for (std::size_t n = 0; n < inside.size(); ++n) {
        if (!temporal) {
            const std::string inner = xdmfAttribute(inside[n], {"Name"});
            visit(walk, inside[n], inner.empty() ? "block " + std::to_string(n) : inner, time, depth + 1);
            continue;
        }
        const std::vector<double> stated = timesOf(walk, inside[n], 1);
        walk.counted = walk.counted || (stated.empty() && n >= times.size() && inside.size() > 1);
        visit(walk, inside[n], name,
              !stated.empty()    ? stated.front()
              : n < times.size() ? times[n]
                                 : double(n),
              depth + 1);
    }
}

/// The grids of one time. Those on one mesh are one.
using Step = std::vector<XdmfGrid>;

void addTo(Step& step, const XdmfGrid& grid) {
    const auto known = std::ranges::find_if(step, [&](const XdmfGrid& other) { return other.sameMesh(grid); });
    if (known == step.end()) {
        step.push_back(grid);
        return;
    }
    if (known->fields.empty()) known->name = grid.name;
    for (const XdmfField& field : grid.fields)
        if (std::ranges::find(known->fields, field.name, &XdmfField::name) == known->fields.end())
            known->fields.push_back(field);
}

/// Leaves out fields that cannot be read, grids without values beside others, and surfaces of volumes.
void cleanUp(const XdmfDocument& document, const XdmfItems& items, Step& step, std::vector<std::string>& notes) {
    int most = -1;
    bool values = false;
    for (XdmfGrid& grid : step) {
        std::erase_if(grid.fields, [&](const XdmfField& field) {
            const std::string fault = xdmfFault(document, items, grid, field);
            if (!fault.empty()) note(notes, "attribute \"" + field.name + "\" left out: it " + fault);
            return !fault.empty();
        });
        most = std::max(most, cellDimension(grid));
        values = values || !grid.fields.empty();
    }
    std::erase_if(step, [&](const XdmfGrid& grid) {
        const int dimension = cellDimension(grid);
        if (dimension < most)
            note(notes, "grid \"" + grid.name + "\" left out: it has " +
                            (dimension < 0    ? "a topology that is not read"
                             : dimension == 2 ? "surfaces"
                                              : "lines or points") +
                            (dimension < 0 ? "" : " only"));
        else if (values && grid.fields.empty())
            note(notes, "grid \"" + grid.name + "\" left out: it has no values");
        return dimension < most || (values && grid.fields.empty());
    });
}

/// Blocks of equal names over time. Where names change from time to time, the place among the grids counts.
void nameBlocks(std::vector<Step>& steps) {
    std::map<std::string, std::size_t> used;
    std::size_t most = 0;
    for (const Step& step : steps) {
        std::set<std::string> own;
        for (const XdmfGrid& grid : step)
            if (own.insert(grid.name).second) ++used[grid.name];
        most = std::max(most, step.size());
        if (own.size() < step.size()) used[""] = steps.size() + 1; // names that do not tell the grids apart
    }
    const bool steady = !used.contains("") && used.size() <= most + most / 2;
    for (Step& step : steps)
        for (std::size_t n = 0; n < step.size(); ++n) {
            if (most == 1)
                step[n].name.clear();
            else if (!steady)
                step[n].name = "block " + std::to_string(n);
        }
}

struct XdmfFile {
    XdmfDocument document;
    XdmfItems items{document};
    std::vector<Step> steps;
    Step meshes; ///< read last, with `read`
    std::vector<vtkSmartPointer<vtkDataSet>> read;

    explicit XdmfFile(const std::string& path) : document(path) {}

    /// A mesh that was read for the time before is not read again.
    vtkSmartPointer<vtkDataSet> meshOf(const XdmfGrid& grid) {
        for (std::size_t n = 0; n < meshes.size(); ++n)
            if (meshes[n].sameMesh(grid)) return read[n];
        meshes.push_back(grid);
        read.push_back(readXdmfMesh(document, items, grid));
        return read.back();
    }

    vtkSmartPointer<vtkDataSet> at(const XdmfGrid& grid) {
        const vtkSmartPointer<vtkDataSet> mesh = meshOf(grid);
        auto data = vtkSmartPointer<vtkDataSet>::Take(mesh->NewInstance());
        data->CopyStructure(mesh);
        for (const XdmfField& field : grid.fields) addXdmfField(document, items, field, *data);
        return data;
    }
};

/// Indices of times that together show all blocks and fields; all times where a mesh changes.
std::vector<std::size_t> telling(const std::vector<Step>& steps) {
    std::vector<std::size_t> shown;
    std::set<std::string> seen;
    bool moves = false;
    for (std::size_t t = 0; t < steps.size(); ++t) {
        bool news = t == 0;
        for (const XdmfGrid& grid : steps[t]) {
            for (const XdmfField& field : grid.fields) news = seen.insert(grid.name + "\n" + field.name).second || news;
            const auto before = std::ranges::find(steps.front(), grid.name, &XdmfGrid::name);
            moves = moves || before == steps.front().end() || !before->sameMesh(grid);
        }
        if (news) shown.push_back(t);
    }
    if (!moves) return shown;
    shown.clear();
    for (std::size_t t = 0; t < steps.size(); ++t) shown.push_back(t);
    return shown;
}

} // namespace

void openXdmf(Source& source) {
    const auto file = std::make_shared<XdmfFile>(source.path);
    std::vector<std::string>& notes = source.notes;
    Walk walk{file->document, file->items, notes};
    std::size_t domains = 0;
    for (const pugi::xml_node domain : file->document.children(file->document.root(), "Domain")) {
        const std::vector<pugi::xml_node> grids = file->document.children(domain, "Grid");
        if (grids.empty() || domains++ > 0) continue;
        for (const pugi::xml_node grid : grids)
            visit(walk, grid, grids.size() > 1 ? xdmfAttribute(grid, {"Name"}) : "", std::nullopt, 0);
    }
    if (domains > 1) notes.push_back("the first of " + std::to_string(domains) + " domains shown");
    std::map<double, Step> timed;
    Step always;
    std::set<std::string> units;
    for (const PlacedGrid& placed : walk.grids) {
        XdmfGrid grid = openXdmfGrid(file->document, placed.node, notes);
        if (!placed.name.empty()) grid.name = placed.name;
        for (const XdmfField& field : grid.fields)
            if (!field.unit.empty()) source.units[field.name] = field.unit;
        addTo(placed.time ? timed[*placed.time] : always, grid);
    }
    if (timed.empty()) {
        file->steps.push_back(always);
    } else {
        for (auto& [time, step] : timed) {
            for (const XdmfGrid& grid : always) addTo(step, grid);
            source.times.push_back(meantTime(time));
            file->steps.push_back(std::move(step));
        }
        if (walk.counted) source.timeUnit = "step";
    }
    for (Step& step : file->steps) cleanUp(file->document, file->items, step, notes);
    nameBlocks(file->steps);
    for (const std::string& text : file->document.notes()) notes.push_back(text);
    if (file->steps.front().empty()) throw std::runtime_error(notes.empty() ? "holds no grid" : notes.front());
    source.shownAt = telling(file->steps);
    source.read = [file](std::size_t time) -> vtkSmartPointer<vtkDataObject> {
        const Step& step = file->steps[std::min(time, file->steps.size() - 1)];
        if (step.size() == 1 && step.front().name.empty()) {
            const vtkSmartPointer<vtkDataSet> only = file->at(step.front());
            return only;
        }
        vtkNew<vtkMultiBlockDataSet> blocks;
        for (const XdmfGrid& grid : step) {
            const unsigned index = blocks->GetNumberOfBlocks();
            blocks->SetBlock(index, file->at(grid));
            blocks->GetMetaData(index)->Set(vtkCompositeDataSet::NAME(), grid.name.c_str());
        }
        return blocks;
    };
}

} // namespace tessera::importer
