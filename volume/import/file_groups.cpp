#include "volume/import/file_groups.h"

#include "volume/base/error.h"
#include "volume/base/number_text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

namespace tessera::volume {

namespace {

/// A group while files are added to it. What is known by name is looked up, since there may be thousands of files, of
/// blocks and of arrays.
struct GrowingGroup {
    FileGroup group;
    std::set<std::string> arrays; ///< names of those of all files
    /// Places in group.blocks by name and, among blocks of one name, by order.
    std::map<std::string, std::vector<std::size_t>> blocks;
    std::vector<std::map<std::string, std::size_t>> arraysOf; ///< of each block: places by name

    /// Whether a file of one name pattern with the others holds an array of theirs: else it is a parameter, not a time.
    bool sharesArray(const OpenedFile& file) const {
        return std::ranges::any_of(file.blocks, [this](const FileBlock& block) {
            return std::ranges::any_of(block.arrays,
                                       [this](const Array& array) { return arrays.contains(array.name); });
        });
    }
};

/// The place of a block of a file in its group: by its name, and among blocks of one name by their order, `before` of
/// the file's own came first; the only block of a file is that of the others whatever its name.
std::optional<std::size_t> sameBlock(const GrowingGroup& growing, const OpenedFile& file, const std::string& name,
                                     std::size_t before) {
    if (file.blocks.size() == 1 && growing.group.blocks.size() == 1) return 0;
    const auto known = growing.blocks.find(name);
    if (known == growing.blocks.end() || before >= known->second.size()) return std::nullopt;
    return known->second[before];
}

/// Adds the blocks and arrays of the last file of a group.
void addBlocks(GrowingGroup& growing) {
    FileGroup& group = growing.group;
    const OpenedFile& file = *group.files.back();
    const std::size_t f = group.files.size() - 1;
    std::map<std::string, std::size_t> before; // blocks of a name
    for (GroupBlock& block : group.blocks) {
        block.at.push_back(-1);
        for (std::vector<int>& at : block.arrays) at.push_back(-1);
    }
    for (std::size_t b = 0; b < file.blocks.size(); ++b) {
        const FileBlock& own = file.blocks[b];
        std::optional<std::size_t> place = sameBlock(growing, file, own.name, before[own.name]++);
        if (!place) {
            place = group.blocks.size();
            group.blocks.push_back({own, std::vector<int>(f + 1, -1), {}});
            group.blocks.back().form.arrays.clear();
            growing.blocks[own.name].push_back(*place);
            growing.arraysOf.emplace_back();
        }
        GroupBlock& block = group.blocks[*place];
        block.at[f] = int(b);
        for (std::size_t a = 0; a < own.arrays.size(); ++a) {
            const Array& array = own.arrays[a];
            const auto [at, isNew] = growing.arraysOf[*place].emplace(array.name, block.form.arrays.size());
            if (isNew) {
                block.form.arrays.push_back(array);
                block.arrays.emplace_back(f + 1, -1);
                growing.arrays.insert(array.name);
            }
            Array& known = block.form.arrays[at->second];
            if (known.components != array.components) {
                group.notes.push_back(array.name + " has " + std::to_string(array.components) + " components in " +
                                      file.entry.path + ", " + std::to_string(known.components) +
                                      " before: it is absent there");
                continue;
            }
            if (known.unit.empty()) known.unit = array.unit;
            block.arrays[at->second][f] = int(a);
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
    std::vector<GrowingGroup> growing;
    std::map<std::string, std::vector<std::size_t>> named; // by the group of the entries
    for (const OpenedFile& file : files) {
        std::vector<std::size_t>& alike = named[file.entry.group];
        const auto follows =
            std::ranges::find_if(alike, [&](std::size_t g) { return file.entry.time || growing[g].sharesArray(file); });
        const std::size_t at = follows != alike.end() ? *follows : growing.size();
        if (at == growing.size()) {
            alike.push_back(at);
            growing.emplace_back();
        }
        growing[at].group.files.push_back(&file);
        addBlocks(growing[at]);
    }
    std::vector<FileGroup> groups;
    for (GrowingGroup& each : growing) {
        setTimes(each.group);
        groups.push_back(std::move(each.group));
    }
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
    std::map<std::string, std::size_t> places; // of the quantities by name
    for (std::size_t q = 0; q < info.quantities.size(); ++q) places.emplace(info.quantities[q].name, q);
    const auto note = [&](const std::string& name, const std::string& unit, std::size_t time, double value) {
        const auto [at, isNew] = places.emplace(name, info.quantities.size());
        if (isNew)
            info.quantities.push_back(
                {name, unit, std::vector<double>(info.times.size(), std::numeric_limits<double>::quiet_NaN())});
        Quantity& known = info.quantities[at->second];
        if (known.unit.empty()) known.unit = unit;
        if (std::isnan(known.values[time])) known.values[time] = value;
    };
    for (std::size_t f = 0; f < group.frames.size(); ++f) {
        const OpenedFile& file = *group.files[group.frames[f].file];
        const auto local = std::size_t(group.frames[f].localTime);
        // A single frame beside a series is used at all times.
        const auto [first, last] = group.times.size() > 1 ? std::ranges::equal_range(info.times, group.times[f])
                                                          : std::ranges::subrange(info.times.begin(), info.times.end());
        for (auto t = std::size_t(first - info.times.begin()); t < std::size_t(last - info.times.begin()); ++t) {
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
