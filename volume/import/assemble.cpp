#include "volume/import/assemble.h"

#include "volume/base/error.h"
#include "volume/field/mesh_origin.h"
#include "volume/import/common_grid.h"
#include "volume/import/files/formats.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <set>

namespace tessera::volume {

namespace fs = std::filesystem;

namespace {

/// Files of one group, consecutive in time: they differ only in their samples.
struct Group {
    std::vector<const OpenedFile*> files;
    struct Frame {
        std::size_t file;
        int localTime;
    };
    std::vector<double> times; ///< strictly increasing; empty: one frame that is there at all times
    std::vector<Frame> frames; ///< one per time, or the only one
    bool timesAreNumbers = false;
};

/// One array of one block that feeds a parameter.
struct Contribution {
    std::size_t group, piece;
    int array;
};

bool sameForm(const OpenedFile& a, const OpenedFile& b) {
    return std::equal(a.pieces.begin(), a.pieces.end(), b.pieces.begin(), b.pieces.end(),
                      [single = a.pieces.size() == 1](const Piece& p, const Piece& q) {
                          return (p.name == q.name || single) && p.mesh == q.mesh &&
                                 std::equal(p.arrays.begin(), p.arrays.end(), q.arrays.begin(), q.arrays.end(),
                                            [](const Array& x, const Array& y) {
                                                return x.name == y.name && x.components == y.components;
                                            });
                      });
}

std::vector<Group> makeGroups(const std::vector<OpenedFile>& files) {
    std::vector<Group> groups;
    for (const OpenedFile& file : files) {
        const bool follows = !groups.empty() && groups.back().files.front()->entry.group == file.entry.group &&
                             sameForm(*groups.back().files.front(), file);
        if (!follows) groups.emplace_back();
        groups.back().files.push_back(&file);
    }
    for (Group& group : groups) {
        std::map<double, Group::Frame> byTime;
        const auto add = [&](double time, std::size_t file, int local) {
            if (!byTime.emplace(time, Group::Frame{file, local}).second)
                throw Error("has the same time " + std::to_string(time) + " as " +
                                group.files[byTime.at(time).file]->entry.path,
                            group.files[file]->entry.path);
        };
        // Numbers in names are used only if no file of the group states a time.
        bool anyTime = false, allDistinct = true;
        std::set<double> seen;
        for (const OpenedFile* file : group.files) {
            const auto& own = file->pieces.front().times;
            if (file->entry.time || !own.empty()) anyTime = true;
            const double first = file->entry.time ? *file->entry.time : own.empty() ? 0 : own.front();
            if ((file->entry.time || !own.empty()) && !seen.insert(first).second) allDistinct = false;
        }
        const bool several = group.files.size() > 1;
        for (std::size_t f = 0; f < group.files.size(); ++f) {
            const SeriesFile& entry = group.files[f]->entry;
            const auto& own = group.files[f]->pieces.front().times;
            if (own.size() > 1 && (!several || allDistinct)) {
                for (std::size_t t = 0; t < own.size(); ++t) add(own[t], f, static_cast<int>(t));
            } else if (entry.time) {
                add(*entry.time, f, 0);
            } else if (own.size() == 1 && (!several || allDistinct)) {
                add(own[0], f, 0);
            } else if (several) {
                group.timesAreNumbers = !anyTime || !allDistinct;
                add(group.timesAreNumbers && entry.number ? *entry.number : double(f), f, 0);
            } else {
                group.frames.push_back({f, 0});
            }
        }
        for (const auto& [time, frame] : byTime) {
            group.times.push_back(time);
            group.frames.push_back(frame);
        }
    }
    return groups;
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

/// A type that holds an array's numbers in every file of its group.
ScalarType typeInAll(const Group& group, std::size_t piece, std::size_t array) {
    ScalarType type = group.files.front()->pieces[piece].arrays[array].type;
    for (const OpenedFile* file : group.files) type = commonType(type, file->pieces[piece].arrays[array].type);
    return type;
}

/// Fills samples that `into` lacks with those of `from`.
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

/// Everything load() needs, shared by its copies.
struct Assembly {
    std::vector<OpenedFile> files;
    std::vector<Group> groups;
    Lattice lattice;
    std::vector<double> times;
    std::vector<Parameter> parameters;
    std::vector<std::vector<Contribution>> feeds; ///< per parameter; empty = the made label
    std::vector<std::uint8_t> label;              ///< samples of the made label
    std::shared_ptr<const Mask> labelMask;

    const Piece* pieceAt(const Contribution& from, double time, int& local) const {
        const Group& group = groups[from.group];
        std::size_t at = 0;
        if (!group.times.empty()) {
            const auto found = std::find(group.times.begin(), group.times.end(), time);
            if (found == group.times.end()) {
                if (group.times.size() > 1) return nullptr;
            } else {
                at = static_cast<std::size_t>(found - group.times.begin());
            }
        }
        const Group::Frame frame = group.frames[at];
        local = frame.localTime;
        return &group.files[frame.file]->pieces[from.piece];
    }

    bool canSlice() const {
        for (const std::vector<Contribution>& feed : feeds)
            if (feed.empty()) return false;
        for (const OpenedFile& file : files)
            for (const Piece& piece : file.pieces)
                if (!piece.slices || piece.lattice.size != lattice.size) return false;
        return true;
    }

    Field load(int parameter, int component, int timeIndex) const {
        return load(parameter, component, timeIndex, 0, lattice.size.z);
    }

    /// Slices [first, first + count); of what cannot be sliced all.
    Field load(int parameter, int component, int timeIndex, int first, int count) const {
        const Lattice part = slicesOf(lattice, first, count);
        const auto p = static_cast<std::size_t>(parameter);
        if (feeds[p].empty()) {
            Field field = makeField(part, ScalarType::U8);
            std::copy(label.begin(), label.end(), field.as<std::uint8_t>().begin());
            field.mask = labelMask;
            return field;
        }
        Field merged;
        for (const Contribution& from : feeds[p]) {
            if (!merged.samples.empty() && !merged.mask) break;
            int local = 0;
            const Piece* piece = pieceAt(from, times[static_cast<std::size_t>(timeIndex)], local);
            if (piece == nullptr) continue;
            Field field = count == lattice.size.z ? piece->load(from.array, component, local, part)
                                                  : piece->slices(from.array, component, local, first, count);
            field = inType(std::move(field), parameters[p].type);
            field.lattice = part;
            if (merged.samples.empty())
                merged = std::move(field);
            else
                fillFrom(merged, field);
        }
        return merged.samples.empty() ? allAbsent(part, parameters[p].type) : merged;
    }

    /// Of a parameter's own values at all times; empty where they are not known.
    std::vector<Range> ranges(int parameter, const Progress& progress) const {
        std::vector<Range> all;
        double done = 0;
        for (const Contribution& from : feeds[static_cast<std::size_t>(parameter)]) {
            const Group& group = groups[from.group];
            for (const Group::Frame& frame : group.frames) {
                progress.advance(done++ / double(group.frames.size() * feeds.size()));
                const Piece& piece = group.files[frame.file]->pieces[from.piece];
                const std::vector<Range> own =
                    piece.ranges ? piece.ranges(from.array, frame.localTime) : std::vector<Range>{};
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

    /// Labels each sample with the set of blocks that cover it. A block that covers every sample tells nothing and is
    /// left out.
    void makeLabel(Parameter& parameter, const Progress& progress) {
        struct Block {
            std::string name;
            Field cover;
        };
        std::vector<Block> blocks;
        std::size_t total = 0;
        for (const Group& group : groups) total += group.files.front()->pieces.size();
        std::vector<std::uint8_t> anywhere(lattice.count(), 0);
        for (const Group& group : groups)
            for (const Piece& piece : group.files.front()->pieces) {
                progress.advance(double(blocks.size()) / double(total), "blocks");
                Field cover = piece.load(-1, 0, 0, lattice);
                for (std::size_t i = 0; i < anywhere.size(); ++i) anywhere[i] = anywhere[i] != 0 || cover.present(i);
                blocks.push_back({piece.name, std::move(cover)});
            }
        std::erase_if(blocks, [&](const Block& block) {
            for (std::size_t i = 0; i < anywhere.size(); ++i)
                if (anywhere[i] != 0 && !block.cover.present(i)) return false;
            return blocks.size() > 1;
        });
        std::map<std::vector<bool>, std::uint8_t> values;
        label.assign(lattice.count(), 0);
        std::vector<bool> covers(blocks.size());
        Mask mask = anywhere;
        for (std::size_t i = 0; i < label.size(); ++i) {
            if (anywhere[i] == 0) continue;
            for (std::size_t b = 0; b < blocks.size(); ++b) covers[b] = blocks[b].cover.present(i);
            const auto at = values.find(covers);
            if (at != values.end()) {
                label[i] = at->second;
                continue;
            }
            if (values.size() == 255)
                throw Error("more than 255 ways in which blocks overlap", files.front().entry.path);
            const auto value = static_cast<std::uint8_t>(values.size() + 1);
            values.emplace(covers, value);
            label[i] = value;
            std::string name;
            for (std::size_t b = 0; b < blocks.size(); ++b)
                if (covers[b]) name += (name.empty() ? "" : " + ") + blocks[b].name;
            parameter.labels.push_back({value, name.empty() ? "other" : name});
        }
        labelMask = std::make_shared<const Mask>(std::move(mask));
    }
};

/// Times and quantities that the files of a group, and the list file that names them, state. The first statement is
/// used.
void addQuantities(DatasetInfo& info, const Group& group) {
    const auto note = [&info](const std::string& name, const std::string& unit, std::size_t time, double value) {
        auto known = std::ranges::find(info.quantities, name, &Quantity::name);
        if (known == info.quantities.end())
            known = info.quantities.insert(
                known, {name, unit, std::vector<double>(info.times.size(), std::numeric_limits<double>::quiet_NaN())});
        if (known->unit.empty()) known->unit = unit;
        if (std::isnan(known->values[time])) known->values[time] = value;
    };
    for (std::size_t f = 0; f < group.frames.size(); ++f) {
        const OpenedFile& file = *group.files[group.frames[f].file];
        const auto local = std::size_t(group.frames[f].localTime);
        for (std::size_t t = 0; t < info.times.size(); ++t) {
            // A single frame beside a series is used at all times.
            if (group.times.size() > 1 && group.times[f] != info.times[t]) continue;
            for (const auto& [name, value] : file.entry.numbers) note(name, "", t, value);
            for (const Piece& piece : file.pieces) {
                for (const Quantity& quantity : piece.quantities)
                    if (local < quantity.values.size()) note(quantity.name, quantity.unit, t, quantity.values[local]);
                // A list, or numbers of names, that says another time than the file itself.
                if (!group.times.empty() && local < piece.times.size() && piece.times[local] != group.times[f])
                    note("time in the files", piece.timeUnit, t, piece.times[local]);
            }
        }
    }
}

/// A mesh, or one of several grids of a file that lie beside each other: arrays of equal name are one parameter.
bool isBlock(const OpenedFile& file, const Piece& piece) {
    return piece.mesh || (file.pieces.size() > 1 && std::ranges::none_of(file.pieces, [&](const Piece& other) {
                              return &other != &piece && other.lattice == piece.lattice;
                          }));
}

std::string dataName(const std::vector<OpenedFile>& files) {
    const NumberedName numbered = numberedName(files.front().entry.path);
    std::string name = fs::path(numbered.pattern).filename().string();
    if (files.size() == 1) name = fs::path(files.front().entry.path).filename().string();
    name.resize(std::min(name.find('.'), name.size()));
    std::erase(name, '#');
    while (!name.empty() && (name.back() == '_' || name.back() == '-')) name.pop_back();
    return name.empty() ? "data" : name;
}

} // namespace

Assembled assemble(std::vector<OpenedFile> files, glm::ivec3 gridSize, bool readSamples, const Progress& progress) {
    Assembled result;
    std::vector<std::string>& notes = result.notes;
    auto all = std::make_shared<Assembly>();
    all->files = std::move(files);
    for (const OpenedFile& file : all->files)
        if (file.pieces.empty()) throw Error("holds no data", file.entry.path);
    all->groups = makeGroups(all->files);
    Box bounds;
    all->lattice = chooseLattice(all->files, gridSize, bounds, notes);
    bool scattered = false;
    const bool resampled = all->lattice != all->files.front().pieces.front().lattice;

    DatasetInfo info;
    info.name = dataName(all->files);
    info.lattice = all->lattice;
    info.bounds = bounds;
    std::set<double> times;
    bool numbers = false;
    for (const Group& group : all->groups) {
        if (group.times.size() > 1 || times.empty()) times.insert(group.times.begin(), group.times.end());
        numbers = numbers || (group.timesAreNumbers && group.times.size() > 1);
    }
    if (all->groups.size() > 1) { // a single time beside a series holds at all times
        std::set<double> series;
        for (const Group& group : all->groups)
            if (group.times.size() > 1) series.insert(group.times.begin(), group.times.end());
        if (!series.empty()) times = series;
    }
    info.times.assign(times.begin(), times.end());
    if (info.times.empty()) info.times = {0};
    // Voxel files of scanners and volume archives omit units; simulations use metres and seconds.
    const std::string& format = all->groups.front().files.front()->pieces.front().format;
    const FileFormat* row = formatNamed(format);
    info.lengthUnit = row != nullptr ? row->lengthUnit : format == "raw" ? "" : "m";
    info.timeUnit = ""; // few files say it
    if (numbers) info.timeName = "step";

    std::map<std::string, std::size_t> byName;
    // Files on one grid do not hide each other: arrays of equal name are told apart by the file's name.
    std::map<std::string, int> onGrids;
    for (const Group& group : all->groups)
        for (const Piece& piece : group.files.front()->pieces)
            if (!isBlock(*group.files.front(), piece))
                for (const Array& array : piece.arrays) ++onGrids[array.name];
    bool anyLabel = false;
    std::size_t meshes = 0;
    for (std::size_t g = 0; g < all->groups.size(); ++g) {
        const OpenedFile& file = *all->groups[g].files.front();
        for (std::size_t b = 0; b < file.pieces.size(); ++b) {
            const Piece& piece = file.pieces[b];
            const bool block = isBlock(file, piece);
            meshes += block ? 1 : 0;
            scattered = scattered || piece.note.starts_with("scattered points");
            if (!piece.note.empty() && std::ranges::find(notes, piece.note) == notes.end()) notes.push_back(piece.note);
            if (!piece.lengthUnit.empty()) info.lengthUnit = piece.lengthUnit;
            if (!numbers && !piece.timeName.empty()) info.timeName = piece.timeName;
            if (!numbers && !piece.timeUnit.empty()) info.timeUnit = piece.timeUnit;
            if (info.provenance.empty()) info.provenance = piece.provenance;
            for (std::size_t a = 0; a < piece.arrays.size(); ++a) {
                const Array& array = piece.arrays[a];
                const ScalarType type = typeInAll(all->groups[g], b, a);
                anyLabel = anyLabel || array.categorical;
                std::string name = array.name;
                if (!block && onGrids[name] > 1) {
                    const std::string stem = fs::path(file.entry.path).stem().string();
                    name = array.name == "value" ? stem : stem + "." + array.name;
                }
                const auto known = byName.find(name);
                if (known != byName.end() && !block)
                    throw Error("array \"" + array.name + "\" is there twice", piece.file);
                if (known != byName.end()) {
                    Parameter& parameter = info.parameters[known->second];
                    if (parameter.components != array.components)
                        throw Error("array has " + std::to_string(array.components) + " components here and " +
                                        std::to_string(parameter.components) + " in another block",
                                    piece.file, array.name);
                    parameter.type = commonType(parameter.type, type);
                    all->feeds[known->second].push_back({g, b, static_cast<int>(a)});
                    continue;
                }
                byName.emplace(name, info.parameters.size());
                info.parameters.push_back(
                    {name, array.unit, array.components, type, array.categorical, array.labels, {}});
                all->feeds.push_back({{g, b, static_cast<int>(a)}});
            }
        }
    }
    if (info.parameters.empty()) throw Error("holds no array of numbers", all->files.front().entry.path);
    result.mesh = meshes > 0;
    bool mesh = false;
    double cells = 0;
    for (const Group& group : all->groups)
        for (const Piece& piece : group.files.front()->pieces) {
            mesh = mesh || piece.mesh;
            cells += piece.mesh ? piece.cells : 0;
        }
    if (mesh) {
        const std::string origin = meshProvenance(cells, all->lattice.size);
        info.provenance += (info.provenance.empty() ? "" : "; ") + origin;
        result.ranges = [all](int parameter, const Progress& by) { return all->ranges(parameter, by); };
    } else if (resampled || scattered) {
        info.provenance += (info.provenance.empty() ? "" : "; ") + std::string(scattered ? kFromPoints : kFromGrids);
    }
    if (info.timeUnit == "step") { // a count has a name and no unit
        if (info.timeName == DatasetInfo().timeName) info.timeName = info.timeUnit;
        info.timeUnit.clear();
    }
    all->times = info.times;
    for (const Group& group : all->groups) addQuantities(info, group);
    if (!anyLabel && meshes > 1 && !byName.contains("region")) {
        Parameter region{"region", "", 1, ScalarType::U8, true, {}, {}};
        if (readSamples) all->makeLabel(region, progress);
        info.parameters.push_back(std::move(region));
        all->feeds.emplace_back();
        notes.push_back("label region made from the names of the blocks");
        result.madeLabel = true;
    }
    all->parameters = info.parameters;
    result.dataset = {std::move(info),
                      [all](int parameter, int component, int time) { return all->load(parameter, component, time); }};
    if (all->canSlice())
        result.slices = [all](int parameter, int component, int time, int first, int count) {
            return all->load(parameter, component, time, first, count);
        };
    return result;
}

} // namespace tessera::volume
