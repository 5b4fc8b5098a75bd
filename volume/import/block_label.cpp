#include "volume/import/block_label.h"

#include "volume/base/error.h"

#include <algorithm>
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

} // namespace

BlockLabel labelOfBlocks(const std::vector<FileGroup>& groups, const Lattice& lattice, std::vector<std::string>& notes,
                         const Progress& progress) {
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
