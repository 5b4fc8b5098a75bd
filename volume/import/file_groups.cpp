#include "volume/import/file_groups.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace tessera::volume {

namespace {

bool sameForm(const OpenedFile& a, const OpenedFile& b) {
    return std::equal(a.blocks.begin(), a.blocks.end(), b.blocks.begin(), b.blocks.end(),
                      [single = a.blocks.size() == 1](const FileBlock& p, const FileBlock& q) {
                          return (p.name == q.name || single) && p.mesh == q.mesh &&
                                 std::equal(p.arrays.begin(), p.arrays.end(), q.arrays.begin(), q.arrays.end(),
                                            [](const Array& x, const Array& y) {
                                                return x.name == y.name && x.components == y.components;
                                            });
                      });
}

/// The times of a group and the frame of each, from lists, the files or their names.
void setTimes(FileGroup& group) {
    std::map<double, FileGroup::Frame> byTime;
    const auto add = [&](double time, std::size_t file, int local) {
        if (!byTime.emplace(time, FileGroup::Frame{file, local}).second)
            throw Error("has the same time " + std::to_string(time) + " as " +
                            group.files[byTime.at(time).file]->entry.path,
                        group.files[file]->entry.path);
    };
    // Numbers in names are used only if no file of the group states a time.
    bool anyTime = false, allDistinct = true;
    std::set<double> seen;
    for (const OpenedFile* file : group.files) {
        const auto& own = file->blocks.front().times;
        if (file->entry.time || !own.empty()) anyTime = true;
        const double first = file->entry.time ? *file->entry.time : own.empty() ? 0 : own.front();
        if ((file->entry.time || !own.empty()) && !seen.insert(first).second) allDistinct = false;
    }
    const bool several = group.files.size() > 1 || group.files.front()->entry.growing;
    for (std::size_t f = 0; f < group.files.size(); ++f) {
        const SeriesFile& entry = group.files[f]->entry;
        const auto& own = group.files[f]->blocks.front().times;
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

} // namespace

std::vector<FileGroup> groupsInTime(const std::vector<OpenedFile>& files) {
    std::vector<FileGroup> groups;
    for (const OpenedFile& file : files) {
        const bool follows = !groups.empty() && groups.back().files.front()->entry.group == file.entry.group &&
                             sameForm(*groups.back().files.front(), file);
        if (!follows) groups.emplace_back();
        groups.back().files.push_back(&file);
    }
    for (FileGroup& group : groups) setTimes(group);
    return groups;
}

ScalarType typeInAll(const FileGroup& group, std::size_t block, std::size_t array) {
    ScalarType type = group.files.front()->blocks[block].arrays[array].type;
    for (const OpenedFile* file : group.files) type = commonType(type, file->blocks[block].arrays[array].type);
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
