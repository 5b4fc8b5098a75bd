#include "volume/bricks/parts_bricks.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cmath>

namespace tessera::volume {

std::optional<int> labelChannel(const DatasetInfo& info, const Parameter& parameter) {
    if (parameter.categorical || parameter.parts.count() < 2) return std::nullopt;
    const std::vector<Channel> channels = info.channels();
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const Parameter& label = info.parameters[std::size_t(channels[c].parameter)];
        if (label.categorical && label.components == 1 && label.name == parameter.parts.label) return int(c);
    }
    return std::nullopt;
}

std::vector<std::uint8_t> partsOfSamples(const BrickSamples& labels, const Parts& parts) {
    std::vector<std::uint8_t> out(labels.values.size());
    float last = 0;
    std::uint8_t part = 0;
    bool known = false;
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (!labels.isPresent(i)) continue;
        const float value = labels.values[i];
        if (!known || value != last) {
            last = value;
            part = std::isfinite(value) ? std::uint8_t(parts.partOf(int(std::lround(value)))) : std::uint8_t(0);
            known = true;
        }
        out[i] = part;
    }
    return out;
}

BrickSamples onlyPart(BrickSamples values, const BrickSamples& labels, const Parts& parts, std::size_t part) {
    if (labels.values.size() != values.values.size()) throw Error("a label's brick has another size");
    const std::vector<std::uint8_t> own = partsOfSamples(labels, parts);
    std::vector<std::uint8_t> present =
        values.present.empty() ? std::vector<std::uint8_t>(own.size(), 1) : std::move(values.present);
    bool whole = true;
    for (std::size_t i = 0; i < own.size(); ++i) {
        if (own[i] != part) present[i] = 0;
        whole = whole && present[i] != 0;
    }
    values.present = whole ? std::vector<std::uint8_t>() : std::move(present);
    return values;
}

BrickSamples coarserLabels(const BrickGrid& grid, const BrickKey& key, const BrickSamples& fine) {
    const int slices = grid.lattice.kind == LatticeKind::BCC ? 2 : 1, step = 1 << key.level;
    BrickSamples out;
    out.size = grid.brickSamples(key.index, key.level);
    for (int z = 0; z < out.size.z; ++z)
        for (int y = 0; y < out.size.y; ++y)
            for (int x = 0; x < out.size.x; ++x) {
                const int slice = (z / slices) * step * slices + z % slices;
                const std::size_t from =
                    (std::size_t(slice) * std::size_t(fine.size.y) + std::size_t(y * step)) * std::size_t(fine.size.x) +
                    std::size_t(x * step);
                out.values.push_back(fine.values[from]);
                if (!fine.present.empty()) out.present.push_back(fine.present[from]);
            }
    return out;
}

BrickSamples coarserOfParts(const BrickGrid& grid, int level, const BrickSamples& fine, const BrickSamples& fineLabels,
                            const BrickSamples& coarseLabels, const Parts& parts) {
    const std::vector<std::uint8_t> own = partsOfSamples(fineLabels, parts);
    const std::vector<std::uint8_t> wanted = partsOfSamples(coarseLabels, parts);
    const int slices = grid.lattice.kind == LatticeKind::BCC ? 2 : 1, step = 1 << level;
    BrickSamples out;
    out.size = coarseLabels.size;
    out.values.resize(wanted.size());
    out.present.assign(wanted.size(), 1);
    const auto indexOf = [&](int x, int y, int z) {
        return (std::size_t(z) * std::size_t(fine.size.y) + std::size_t(y)) * std::size_t(fine.size.x) + std::size_t(x);
    };
    bool whole = true;
    std::size_t to = 0;
    for (int z = 0; z < out.size.z; ++z)
        for (int y = 0; y < out.size.y; ++y)
            for (int x = 0; x < out.size.x; ++x, ++to) {
                const int first = (z / slices) * step * slices + z % slices;
                const auto isOwn = [&](std::size_t at) { return own[at] == wanted[to] && fine.isPresent(at); };
                const std::size_t corner = indexOf(x * step, y * step, first);
                if (grid.phase == 0 && isOwn(corner)) {
                    out.values[to] = fine.values[corner];
                    continue;
                }
                double sum = 0;
                int count = 0, present = 0, total = 0;
                for (int k = first; k < std::min(first + step * slices, fine.size.z); k += slices)
                    for (int j = y * step; j < std::min((y + 1) * step, fine.size.y); ++j)
                        for (int i = x * step; i < std::min((x + 1) * step, fine.size.x); ++i) {
                            const std::size_t at = indexOf(i, j, k);
                            ++total;
                            present += fine.isPresent(at) ? 1 : 0;
                            if (!isOwn(at)) continue;
                            sum += double(fine.values[at]);
                            ++count;
                        }
                if (count > 0 && 2 * present >= total) {
                    out.values[to] = float(sum / count);
                } else {
                    out.present[to] = 0;
                    whole = false;
                }
            }
    if (whole) out.present.clear();
    return out;
}

} // namespace tessera::volume
