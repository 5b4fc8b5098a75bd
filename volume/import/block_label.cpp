#include "volume/import/block_label.h"

#include "volume/base/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

namespace tessera::volume {

namespace {

/// Where a block is, at the first time at which it has a sample; empty if at none.
std::vector<std::uint8_t> coverOf(const FileGroup& group, const GroupBlock& block, const Lattice& lattice) {
    for (const FileGroup::Frame& frame : group.frames) {
        const int at = block.at[frame.file];
        if (at < 0) continue;
        const FileBlock& own = group.files[frame.file]->blocks[std::size_t(at)];
        const Field cover = own.read(-1, 0, frame.localTime, lattice, {});
        if (!cover.mask) return std::vector<std::uint8_t>(lattice.count(), 1);
        if (std::ranges::find(*cover.mask, 1) != cover.mask->end()) return *cover.mask;
    }
    return {};
}

/// Lengths of the cells of samples along an axis, within the box.
std::vector<double> cellsAlong(const Lattice& lattice, const Box& bounds, int axis) {
    const auto border = [&](int i) {
        const double place = lattice.axes.toSpace(axis, lattice.origin[axis] + lattice.spacing[axis] * (i - 0.5));
        return std::clamp(place, bounds.lo[axis], std::max(bounds.lo[axis], bounds.hi[axis]));
    };
    std::vector<double> lengths;
    for (int i = 0; i < lattice.size[axis]; ++i) lengths.push_back(border(i + 1) - border(i));
    return lengths;
}

/// Says where the samples of a block have another volume than its cells.
void noteVolume(const GroupBlock& block, const std::vector<std::uint8_t>& cover, const Lattice& lattice,
                const Box& bounds, std::vector<std::string>& notes) {
    constexpr double kTold = 0.02;
    const FileBlock& form = block.form;
    if (!form.mesh || !(form.volume > 0)) return;
    std::array<std::vector<double>, 3> lengths;
    for (int axis = 0; axis < 3; ++axis) lengths[std::size_t(axis)] = cellsAlong(lattice, bounds, axis);
    double sampled = 0;
    std::size_t i = 0;
    for (const double z : lengths[2])
        for (const double y : lengths[1])
            for (const double x : lengths[0]) sampled += cover[i++] != 0 ? x * y * z : 0;
    const double more = sampled / form.volume - 1;
    if (!(std::abs(more) > kTold)) return;
    char text[160];
    std::snprintf(text, sizeof text, " is sampled with %.2g %% %s volume than its cells have: %.4g, not %.4g",
                  100 * std::abs(more), more > 0 ? "more" : "less", sampled, form.volume);
    const std::string unit = form.lengthUnit.empty() ? "" : " " + form.lengthUnit + "^3";
    notes.push_back("region " + form.name + text + unit);
}

} // namespace

BlockLabel labelOfBlocks(const std::vector<FileGroup>& groups, const Lattice& lattice, const Box& bounds,
                         std::vector<std::string>& notes, const Progress& progress) {
    struct Block {
        std::string name;
        std::vector<std::uint8_t> cover;
    };
    std::vector<Block> blocks;
    std::size_t total = 0, done = 0;
    for (const FileGroup& group : groups) total += group.blocks.size();
    Mask anywhere(lattice.count(), 0);
    for (const FileGroup& group : groups)
        for (const GroupBlock& block : group.blocks) {
            progress.advance(double(done++) / double(total), "blocks");
            std::vector<std::uint8_t> cover = coverOf(group, block, lattice);
            if (cover.empty()) {
                notes.push_back("region " + block.form.name +
                                " has no sample: it is thinner than the samples are apart");
                continue;
            }
            noteVolume(block, cover, lattice, bounds, notes);
            for (std::size_t i = 0; i < anywhere.size(); ++i) anywhere[i] |= cover[i];
            blocks.push_back({block.form.name, std::move(cover)});
        }
    std::erase_if(blocks, [&](const Block& block) { return block.cover == anywhere && blocks.size() > 1; });
    BlockLabel label;
    label.samples.assign(lattice.count(), 0);
    std::map<std::vector<bool>, std::uint8_t> values;
    std::vector<bool> covers(blocks.size());
    for (std::size_t i = 0; i < label.samples.size(); ++i) {
        if (anywhere[i] == 0) continue;
        for (std::size_t b = 0; b < blocks.size(); ++b) covers[b] = blocks[b].cover[i] != 0;
        if (const auto at = values.find(covers); at != values.end()) {
            label.samples[i] = at->second;
            continue;
        }
        if (values.size() == 255)
            throw Error("more than 255 combinations of overlapping blocks", groups.front().files.front()->entry.path);
        const auto value = static_cast<std::uint8_t>(values.size() + 1);
        values.emplace(covers, value);
        label.samples[i] = value;
        std::string name;
        for (std::size_t b = 0; b < blocks.size(); ++b)
            if (covers[b]) name += (name.empty() ? "" : " + ") + blocks[b].name;
        label.labels.push_back({value, name.empty() ? "other" : name});
    }
    label.mask = std::make_shared<const Mask>(std::move(anywhere));
    return label;
}

} // namespace tessera::volume
