#include "volume/import/file_groups.h"

#include "volume/base/error.h"
#include "volume/base/number_text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace tessera::volume {

namespace {

/// Whether files of one name pattern hold an array of the same name: else they are parameters, not times.
bool sharesArray(const OpenedFile& a, const OpenedFile& b) {
    for (const FileBlock& block : a.blocks)
        for (const Array& array : block.arrays)
            for (const FileBlock& other : b.blocks)
                if (std::ranges::find(other.arrays, array.name, &Array::name) != other.arrays.end()) return true;
    return false;
}

/// The block of the group that is block `index` of a file: by its name, and among blocks of one name by their order;
/// the only block of a file is that of the others whatever its name.
GroupBlock* sameBlock(FileGroup& group, const OpenedFile& file, std::size_t index) {
    const bool single = file.blocks.size() == 1 && group.blocks.size() == 1;
    if (single) return &group.blocks.front();
    const std::string& name = file.blocks[index].name;
    auto before = std::count_if(file.blocks.begin(), file.blocks.begin() + std::ptrdiff_t(index),
                                [&](const FileBlock& block) { return block.name == name; });
    for (GroupBlock& block : group.blocks)
        if (block.form.name == name && before-- == 0) return &block;
    return nullptr;
}

/// Adds the blocks and arrays of the last file of a group.
void addBlocks(FileGroup& group) {
    const OpenedFile& file = *group.files.back();
    const std::size_t f = group.files.size() - 1;
    for (GroupBlock& block : group.blocks) {
        block.at.push_back(-1);
        for (std::vector<int>& at : block.arrays) at.push_back(-1);
    }
    for (std::size_t b = 0; b < file.blocks.size(); ++b) {
        const FileBlock& own = file.blocks[b];
        GroupBlock* block = sameBlock(group, file, b);
        if (block == nullptr) {
            group.blocks.push_back({own, std::vector<int>(f + 1, -1), {}});
            block = &group.blocks.back();
            block->form.arrays.clear();
        }
        block->at[f] = int(b);
        for (std::size_t a = 0; a < own.arrays.size(); ++a) {
            std::vector<Array>& arrays = block->form.arrays;
            auto known = std::ranges::find(arrays, own.arrays[a].name, &Array::name);
            if (known == arrays.end()) {
                known = arrays.insert(known, own.arrays[a]);
                block->arrays.emplace_back(f + 1, -1);
            }
            if (known->components != own.arrays[a].components) {
                group.notes.push_back(own.arrays[a].name + " has " + std::to_string(own.arrays[a].components) +
                                      " components in " + file.entry.path + ", " + std::to_string(known->components) +
                                      " before: it is absent there");
                continue;
            }
            if (known->unit.empty()) known->unit = own.arrays[a].unit;
            block->arrays[std::size_t(known - arrays.begin())][f] = int(a);
        }
    }
}

/// The index of a time that a list states for a file, among the file's own.
int localTime(const std::vector<double>& own, double time) {
    const auto at = std::ranges::find(own, time);
    return at != own.end() ? int(at - own.begin()) : 0;
}

/// The times of a group and the frame of each, from lists, the files or their names.
void setTimes(FileGroup& group) {
    std::map<double, FileGroup::Frame> byTime;
    const auto add = [&](double time, std::size_t file, int local) {
        const auto [at, isNew] = byTime.emplace(time, FileGroup::Frame{file, local});
        if (isNew) return;
        const std::string& before = group.files[at->second.file]->entry.path;
        const std::string& path = group.files[file]->entry.path;
        if (group.files[file]->blocks.front().times.size() < 2)
            throw Error("has the same time " + std::to_string(time) + " as " + before, path);
        group.notes.push_back("time " + exactText(time) + " is that of " + path + ", not of " + before);
        at->second = {file, local}; // a run that was continued from an earlier time
    };
    // Numbers in names are used only if no file of the group states a time.
    bool anyTime = false, allDistinct = true, anySeries = false;
    std::set<double> seen;
    for (const OpenedFile* file : group.files) {
        const auto& own = file->blocks.front().times;
        if (file->entry.time || !own.empty()) anyTime = true;
        anySeries = anySeries || (!file->entry.time && own.size() > 1);
        const double first = file->entry.time ? *file->entry.time : own.empty() ? 0 : own.front();
        if ((file->entry.time || !own.empty()) && !seen.insert(first).second) allDistinct = false;
    }
    const bool several = group.files.size() > 1 || group.files.front()->entry.growing;
    const bool counted = several && (!anyTime || !allDistinct) && anySeries; // all times, one after the other
    if (counted) group.notes.emplace_back("the files state the same times, which are counted instead");
    for (std::size_t f = 0; f < group.files.size(); ++f) {
        const SeriesFile& entry = group.files[f]->entry;
        const auto& own = group.files[f]->blocks.front().times;
        if (counted) {
            group.timesAreNumbers = true;
            for (std::size_t t = 0; t < std::max<std::size_t>(own.size(), 1); ++t)
                add(double(byTime.size()), f, static_cast<int>(t));
        } else if (entry.time) {
            add(*entry.time, f, localTime(own, *entry.time));
        } else if (own.size() > 1) {
            for (std::size_t t = 0; t < own.size(); ++t) add(own[t], f, static_cast<int>(t));
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

} // namespace

std::vector<FileGroup> groupsInTime(const std::vector<OpenedFile>& files) {
    std::vector<FileGroup> groups;
    for (const OpenedFile& file : files) {
        const auto follows = std::ranges::find_if(groups, [&](const FileGroup& group) {
            return group.files.front()->entry.group == file.entry.group &&
                   (file.entry.time || std::ranges::any_of(group.files, [&](const OpenedFile* other) {
                        return sharesArray(*other, file);
                    }));
        });
        FileGroup& group = follows != groups.end() ? *follows : groups.emplace_back();
        group.files.push_back(&file);
        addBlocks(group);
    }
    for (FileGroup& group : groups) setTimes(group);
    return groups;
}

ScalarType typeInAll(const FileGroup& group, std::size_t block, std::size_t array) {
    const GroupBlock& of = group.blocks[block];
    ScalarType type = of.form.arrays[array].type;
    for (std::size_t f = 0; f < group.files.size(); ++f)
        if (const int at = of.arrays[array][f]; at >= 0)
            type = commonType(type, group.files[f]->blocks[std::size_t(of.at[f])].arrays[std::size_t(at)].type);
    return type;
}

void addQuantities(DatasetInfo& info, const FileGroup& group) {
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
            for (const FileBlock& block : file.blocks) {
                for (const Quantity& quantity : block.quantities)
                    if (local < quantity.values.size()) note(quantity.name, quantity.unit, t, quantity.values[local]);
                // A time from a list or a file name that differs from the one in the file.
                if (!group.times.empty() && local < block.times.size() && block.times[local] != group.times[f])
                    note("time in the files", block.timeUnit, t, block.times[local]);
            }
        }
    }
}

} // namespace tessera::volume
