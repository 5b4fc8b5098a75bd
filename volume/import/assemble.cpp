#include "volume/import/assemble.h"

#include "volume/base/error.h"
#include "volume/field/mesh_origin.h"
#include "volume/import/block_label.h"
#include "volume/import/common_grid.h"
#include "volume/import/files/formats.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <unordered_map>

namespace tessera::volume {

namespace fs = std::filesystem;

namespace {

/// One array of one block of a group that feeds a parameter.
struct Contribution {
    std::size_t group, block, array;
};

/// Where it is at one time: null where the file of that time lacks the block or the array.
struct Found {
    const FileBlock* block = nullptr;
    int array = 0, localTime = 0;
};

Found inFile(const FileGroup& group, const Contribution& from, FileGroup::Frame frame) {
    const GroupBlock& block = group.blocks[from.block];
    const int at = block.at[frame.file], array = block.arrays[from.array][frame.file];
    if (at < 0 || array < 0) return {};
    return {&group.files[frame.file]->blocks[std::size_t(at)], array, frame.localTime};
}

Field allAbsent(const Lattice& lattice, ScalarType type) {
    Field field = makeField(lattice, type);
    field.mask = std::make_shared<const Mask>(field.count(), std::uint8_t(0));
    return field;
}

/// Converts to a type that holds its numbers: integers to longer ones with the same scaling, or to floats with physical
/// values.
Field inType(Field field, ScalarType type) {
    if (field.type == type) return field;
    Field out = makeField(field.lattice, type);
    out.mask = field.mask;
    if (type == ScalarType::F32) {
        const auto values = out.as<float>();
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(field.value(i));
        return out;
    }
    out.scale = field.scale;
    out.offset = field.offset;
    dispatch(field.type, [&]<class From>(From) {
        dispatch(type, [&]<class To>(To) {
            std::ranges::transform(field.as<From>(), out.as<To>().begin(), [](From v) { return static_cast<To>(v); });
        });
    });
    return out;
}

/// Copies samples of `from` that are absent in `into`.
void fillFrom(Field& into, const Field& from) {
    if (!into.mask) return;
    const std::size_t bytes = byteSize(into.type);
    Mask mask = *into.mask;
    for (std::size_t i = 0; i < mask.size(); ++i)
        if (mask[i] == 0 && from.present(i)) {
            mask[i] = 1;
            std::copy_n(from.samples.begin() + std::ptrdiff_t(i * bytes), bytes,
                        into.samples.begin() + std::ptrdiff_t(i * bytes));
        }
    into.mask = std::make_shared<const Mask>(std::move(mask));
}

/// The state of read(), shared by its copies.
struct Assembly {
    std::vector<OpenedFile> files;
    std::vector<FileGroup> groups;
    Lattice lattice;
    std::vector<double> times;
    std::vector<Parameter> parameters;
    std::vector<std::vector<Contribution>> feeds; ///< per parameter; empty = the generated label
    BlockLabel label;                             ///< the generated label
    bool between = false;                         ///< samples lie between the middles of cells

    Found at(const Contribution& from, double time) const {
        const FileGroup& group = groups[from.group];
        std::size_t index = 0;
        if (!group.times.empty()) {
            const auto found = std::ranges::lower_bound(group.times, time);
            if (found == group.times.end() || *found != time) {
                if (group.times.size() > 1) return {};
            } else {
                index = static_cast<std::size_t>(found - group.times.begin());
            }
        }
        return inFile(group, from, group.frames[index]);
    }

    bool inParts() const {
        return std::ranges::none_of(feeds, [](const auto& feed) { return feed.empty(); }) &&
               std::ranges::all_of(files, [this](const OpenedFile& file) {
                   return std::ranges::all_of(file.blocks, [this](const FileBlock& block) {
                       return block.inParts && block.lattice.size == lattice.size;
                   });
               });
    }

    /// Slices of a frame; all of them if the source cannot read a part.
    Field read(int parameter, int component, int timeIndex, SliceRange slices) const {
        const Lattice part = slicesOf(lattice, slices);
        const auto p = static_cast<std::size_t>(parameter);
        if (feeds[p].empty()) {
            Field field = makeField(part, ScalarType::U8);
            std::ranges::copy(label.samples, field.as<std::uint8_t>().begin());
            field.mask = label.mask;
            return field;
        }
        Field merged;
        for (const Contribution& from : feeds[p]) {
            if (!merged.samples.empty() && !merged.mask) break;
            const Found found = at(from, times[static_cast<std::size_t>(timeIndex)]);
            if (found.block == nullptr) continue;
            Field field =
                inType(found.block->read(found.array, component, found.localTime, lattice, slices), parameters[p].type);
            field.lattice = part;
            if (merged.samples.empty())
                merged = std::move(field);
            else
                fillFrom(merged, field);
        }
        return merged.samples.empty() ? allAbsent(part, parameters[p].type) : merged;
    }

    /// Range of a parameter's own values over all times; empty if not known.
    std::vector<Range> ranges(int parameter, const Progress& progress) const {
        std::vector<Range> all;
        double done = 0;
        for (const Contribution& from : feeds[static_cast<std::size_t>(parameter)]) {
            const FileGroup& group = groups[from.group];
            for (const FileGroup::Frame& frame : group.frames) {
                progress.advance(done++ / double(group.frames.size() * feeds.size()));
                const Found found = inFile(group, from, frame);
                if (found.block == nullptr) continue;
                const std::vector<Range> own = found.block->ranges
                                                   ? found.block->ranges(found.array, found.localTime, between)
                                                   : std::vector<Range>{};
                if (own.empty() || (!all.empty() && own.size() != all.size())) return {};
                if (all.empty()) all = own;
                for (std::size_t i = 0; i < own.size(); ++i)
                    all[i] = {std::min(all[i].lo, own[i].lo), std::max(all[i].hi, own[i].hi)};
            }
        }
        for (const Range& range : all)
            if (!(range.lo <= range.hi)) return {};
        return all;
    }
};

/// Equal for equal lattices, but for their axes.
std::size_t hashOf(const Lattice& lattice) {
    std::size_t hash = 0;
    const auto add = [&hash](double number) { hash = hash * 1099511628211u + std::hash<double>()(number); };
    for (int axis = 0; axis < 3; ++axis)
        for (const double number : {double(lattice.size[axis]), lattice.spacing[axis], lattice.origin[axis]})
            add(number);
    return hash;
}

/// Of each block of each group: whether it is a mesh, or one of several adjacent grids of a file, whose arrays of equal
/// name are one parameter.
std::vector<std::vector<bool>> joiningBlocks(const std::vector<FileGroup>& groups) {
    std::vector<std::vector<bool>> joins;
    for (const FileGroup& group : groups) {
        std::unordered_map<std::size_t, std::vector<const GroupBlock*>> alike;
        for (const GroupBlock& block : group.blocks) alike[hashOf(block.form.lattice)].push_back(&block);
        const auto isAlone = [&](const GroupBlock& block) {
            return std::ranges::none_of(alike.at(hashOf(block.form.lattice)), [&](const GroupBlock* other) {
                return other != &block && other->form.lattice == block.form.lattice;
            });
        };
        std::vector<bool>& own = joins.emplace_back();
        for (const GroupBlock& block : group.blocks)
            own.push_back(block.form.mesh || (group.blocks.size() > 1 && isAlone(block)));
    }
    return joins;
}

std::string dataName(const std::vector<OpenedFile>& files) {
    const NumberedName numbered = numberedName(files.front().entry.path);
    std::string name = fs::path(numbered.pattern).filename().string();
    if (files.size() == 1 && !files.front().entry.growing)
        name = fs::path(files.front().entry.path).filename().string();
    name.resize(std::min(name.find('.'), name.size()));
    std::erase(name, '#');
    while (!name.empty() && (name.back() == '_' || name.back() == '-')) name.pop_back();
    return name.empty() ? "data" : name;
}

/// The times of all groups together. A group with a single time is valid at all times of the others.
std::vector<double> timesOf(const std::vector<FileGroup>& groups) {
    std::set<double> series;
    for (const FileGroup& group : groups)
        if (group.times.size() > 1) series.insert(group.times.begin(), group.times.end());
    if (!series.empty()) return {series.begin(), series.end()};
    for (const FileGroup& group : groups)
        if (!group.times.empty()) return group.times;
    return {0};
}

/// Counters of gatherParameters.
struct Gathered {
    bool anyLabel = false, scattered = false;
    std::size_t blocks = 0;
};

/// Gathers the arrays of all blocks as parameters, and what feeds each.
class Parameters {
public:
    Parameters(Assembly& all, const std::vector<std::vector<bool>>& joins, DatasetInfo& info)
        : all_(all), joins_(joins), info_(info) {
        // Files on one grid all stay visible: arrays of equal name get the file's name added.
        for (std::size_t g = 0; g < all.groups.size(); ++g)
            for (std::size_t b = 0; b < joins[g].size(); ++b)
                if (!joins[g][b])
                    for (const Array& array : all.groups[g].blocks[b].form.arrays) ++onGrids_[array.name];
    }

    void add(std::size_t group, std::size_t number, std::size_t array) {
        const FileGroup& files = all_.groups[group];
        const FileBlock& block = files.blocks[number].form;
        const Array& about = block.arrays[array];
        const bool joins = joins_[group][number];
        const ScalarType type = typeInAll(files, number, array);
        std::string name = about.name;
        if (!joins && onGrids_[name] > 1) {
            const std::string stem = fs::path(files.files.front()->entry.path).stem().string();
            name = about.name == "value" ? stem : stem + "." + about.name;
        }
        const Contribution from{group, number, array};
        const auto known = byName_.find(name);
        if (known == byName_.end()) {
            byName_.emplace(name, info_.parameters.size());
            info_.parameters.push_back({name, about.unit, about.components, type, about.categorical, about.labels, {}});
            all_.feeds.push_back({from});
            return;
        }
        if (!joins) throw Error("array \"" + about.name + "\" is present twice", block.file);
        Parameter& parameter = info_.parameters[known->second];
        if (parameter.components != about.components)
            throw Error("array has " + std::to_string(about.components) + " components here and " +
                            std::to_string(parameter.components) + " in another block",
                        block.file, about.name);
        parameter.type = commonType(parameter.type, type);
        all_.feeds[known->second].push_back(from);
    }

private:
    Assembly& all_;
    const std::vector<std::vector<bool>>& joins_; ///< joiningBlocks()
    DatasetInfo& info_;
    std::map<std::string, std::size_t> byName_;
    std::map<std::string, int> onGrids_;
};

/// Adds those notes of a block that are new.
void addNotes(const FileBlock& block, std::set<std::string>& known, Gathered& found, std::vector<std::string>& notes) {
    for (const std::string& note : block.notes) {
        found.scattered = found.scattered || note.starts_with("scattered points");
        if (known.insert(note).second) notes.push_back(note);
    }
}

/// Merges the metadata of all blocks, and gathers their arrays as parameters.
Gathered gather(Assembly& all, bool numbers, DatasetInfo& info, std::vector<std::string>& notes) {
    Gathered found;
    const std::vector<std::vector<bool>> joins = joiningBlocks(all.groups);
    Parameters parameters(all, joins, info);
    std::set<std::string> known(notes.begin(), notes.end());
    for (std::size_t g = 0; g < all.groups.size(); ++g) {
        const FileGroup& group = all.groups[g];
        notes.insert(notes.end(), group.notes.begin(), group.notes.end());
        known.insert(group.notes.begin(), group.notes.end());
        for (const OpenedFile* file : group.files)
            for (const FileBlock& block : file->blocks) addNotes(block, known, found, notes);
        for (std::size_t b = 0; b < group.blocks.size(); ++b) {
            const FileBlock& block = group.blocks[b].form;
            found.blocks += joins[g][b] ? 1 : 0;
            if (!block.lengthUnit.empty()) info.lengthUnit = block.lengthUnit;
            if (!numbers && !block.timeName.empty()) info.timeName = block.timeName;
            if (!numbers && !block.timeUnit.empty()) info.timeUnit = block.timeUnit;
            if (info.provenance.empty()) info.provenance = block.provenance;
            for (std::size_t a = 0; a < block.arrays.size(); ++a) {
                found.anyLabel = found.anyLabel || block.arrays[a].categorical;
                parameters.add(g, b, a);
            }
        }
    }
    if (info.parameters.empty()) throw Error("holds no array of numbers", all.files.front().entry.path);
    return found;
}

/// Number of cells of the meshes; none without a mesh.
std::optional<double> cellsOf(const std::vector<FileGroup>& groups) {
    std::optional<double> cells;
    for (const FileGroup& group : groups)
        for (const GroupBlock& block : group.blocks)
            if (block.form.mesh) cells = cells.value_or(0) + block.form.cells;
    return cells;
}

} // namespace

Assembled assemble(std::vector<OpenedFile> files, const ImportOptions& options, bool readSamples,
                   const Progress& progress) {
    Assembled result;
    auto all = std::make_shared<Assembly>();
    all->files = std::move(files);
    for (const OpenedFile& file : all->files)
        if (file.blocks.empty()) throw Error("holds no data", file.entry.path);
    all->groups = groupsInTime(all->files);
    DatasetInfo& info = result.dataset.info;
    const ChosenGrid chosen = chooseGrid(all->files, options, info.bounds, result.notes);
    all->lattice = chosen.lattice;
    all->between = !chosen.aligned;
    info.name = dataName(all->files);
    info.lattice = all->lattice;
    info.times = all->times = timesOf(all->groups);
    const FileFormat* row = formatNamed(all->groups.front().files.front()->blocks.front().format);
    info.lengthUnit = row != nullptr ? row->lengthUnit : ""; // unless the file states one, below
    info.timeUnit = "";                                      // few files state it
    const bool numbers = std::ranges::any_of(all->groups, &FileGroup::timesAreNumbers);
    const auto isWhole = [](double time) { return time == std::floor(time); };
    if (numbers && std::ranges::all_of(info.times, isWhole))
        info.timeName = "step";
    else if (numbers)
        result.notes.emplace_back("times are the numbers in the names of the files");

    const Gathered found = gather(*all, numbers, info, result.notes);
    result.mesh = found.blocks > 0;
    std::string origin;
    if (const std::optional<double> cells = cellsOf(all->groups)) {
        origin = chosen.onePerCell ? cellsProvenance(*cells) : meshProvenance(*cells, all->lattice.size);
        result.ranges = [all](int parameter, const Progress& by) { return all->ranges(parameter, by); };
    } else if (found.scattered || all->lattice != all->files.front().blocks.front().lattice) {
        origin = found.scattered ? kFromPoints : kFromGrids;
    }
    if (!origin.empty()) info.provenance += (info.provenance.empty() ? "" : "; ") + origin;
    if (info.timeUnit == "step") { // a count has a name and no unit
        if (info.timeName == DatasetInfo().timeName) info.timeName = info.timeUnit;
        info.timeUnit.clear();
    }
    for (const FileGroup& group : all->groups) addQuantities(info, group);
    const bool named = std::ranges::find(info.parameters, "region", &Parameter::name) != info.parameters.end();
    if (!found.anyLabel && found.blocks > 1 && !named) {
        Parameter region{"region", "", 1, ScalarType::U8, true, {}, {}};
        constexpr double kQuickSamples = 2e7; // of all blocks: previews too say which region lost its volume
        if (readSamples || double(all->lattice.count()) * double(found.blocks) <= kQuickSamples) {
            all->label = labelOfBlocks(all->groups, all->lattice, info.bounds, result.notes, progress);
            region.labels = all->label.labels;
        }
        info.parameters.push_back(std::move(region));
        all->feeds.emplace_back();
        result.notes.push_back("label region created from the names of the blocks");
        result.madeLabel = true;
    }
    all->parameters = info.parameters;
    if (all->inParts())
        result.dataset.read = [all](int parameter, int component, int time, SliceRange slices) {
            return all->read(parameter, component, time, slices);
        };
    else
        result.dataset.read = [all](int parameter, int component, int time) {
            return all->read(parameter, component, time, {});
        };
    return result;
}

} // namespace tessera::volume
