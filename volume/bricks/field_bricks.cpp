#include "volume/bricks/field_bricks.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace tessera::volume {

namespace {

/// The block of fine samples behind one level sample: mean of the present ones, or for labels the most frequent (the
/// smallest of equals). Present if at least half of the block is.
struct LevelBlock {
    bool categorical;
    double sum = 0;
    int present = 0, total = 0;
    std::vector<double> labels;

    void clear() {
        sum = 0;
        present = total = 0;
        labels.clear();
    }
    void add(double value, bool isPresent) {
        ++total;
        if (!isPresent) return;
        ++present;
        if (categorical)
            labels.push_back(value);
        else
            sum += value;
    }
    bool exists() const { return present > 0 && 2 * present >= total; }
    double value() {
        if (!categorical) return sum / present;
        std::sort(labels.begin(), labels.end());
        double best = labels.front();
        std::ptrdiff_t most = 0;
        for (auto run = labels.begin(); run != labels.end();) {
            const auto next = std::upper_bound(run, labels.end(), *run);
            if (next - run > most) {
                most = next - run;
                best = *run;
            }
            run = next;
        }
        return best;
    }
};

/// Means of step^3 samples of a sublattice, or of as many as there are, into the samples of `out`.
void meansOf(const BrickSamples& fine, int step, int slices, BrickSamples& out) {
    const auto width = std::size_t(out.size.x), fineWidth = std::size_t(fine.size.x);
    const std::size_t whole = fineWidth / std::size_t(step); // number of means over complete steps
    std::vector<double> sums(width);
    float* to = out.values.data();
    for (int z = 0; z < out.size.z; ++z) {
        const int first = (z / slices) * step * slices + z % slices;
        const int last = std::min(first + step * slices, fine.size.z);
        for (int y = 0; y < out.size.y; ++y, to += width) {
            std::ranges::fill(sums, 0);
            const int end = std::min((y + 1) * step, fine.size.y);
            int rows = 0;
            for (int k = first; k < last; k += slices)
                for (int j = y * step; j < end; ++j, ++rows) {
                    const float* row =
                        &fine.values[(std::size_t(k) * std::size_t(fine.size.y) + std::size_t(j)) * fineWidth];
                    for (std::size_t x = 0; x < whole; ++x)
                        for (int i = 0; i < step; ++i) sums[x] += double(*row++);
                    for (std::size_t i = whole * std::size_t(step); i < fineWidth; ++i) sums[whole] += double(*row++);
                }
            for (std::size_t x = 0; x < width; ++x) {
                const std::size_t columns = x < whole ? std::size_t(step) : fineWidth - whole * std::size_t(step);
                to[x] = float(sums[x] / double(std::size_t(rows) * columns));
            }
        }
    }
}

} // namespace

BrickSamples fineBrick(const Field& field, glm::ivec3 begin, glm::ivec3 end) {
    BrickSamples out;
    out.size = end - begin;
    const std::size_t total = std::size_t(out.size.x) * std::size_t(out.size.y) * std::size_t(out.size.z);
    out.values.resize(total);
    if (field.mask) out.present.resize(total);
    dispatch(field.type, [&]<class T>(T) {
        const auto stored = field.as<T>();
        std::size_t to = 0;
        for (int z = begin.z; z < end.z; ++z)
            for (int y = begin.y; y < end.y; ++y) {
                const std::size_t row = field.lattice.index({begin.x, y, z});
                const auto width = std::size_t(out.size.x);
                for (std::size_t x = 0; x < width; ++x)
                    out.values[to + x] = float(field.offset + field.scale * double(stored[row + x]));
                if (field.mask) std::copy_n(&(*field.mask)[row], width, &out.present[to]);
                to += width;
            }
    });
    if (std::all_of(out.present.begin(), out.present.end(), [](std::uint8_t p) { return p != 0; })) out.present.clear();
    if (field.type == ScalarType::I32)
        keepRest(out, [&, size = glm::uvec3(out.size)](std::size_t i) {
            const auto n = std::uint32_t(i);
            return field.value(
                field.lattice.index(begin + glm::ivec3(n % size.x, n / size.x % size.y, n / size.x / size.y)));
        });
    return out;
}

BrickSamples coarseBrick(const Field& field, const BrickGrid& grid, const BrickKey& key, bool categorical) {
    const glm::ivec3 begin = grid.begin(key.index), end = grid.end(key.index);
    const BrickSamples fine = fineBrick(field, begin, end);
    const int slices = grid.lattice.kind == LatticeKind::BCC ? 2 : 1; // storage slices per texel
    const int step = 1 << key.level;
    BrickSamples out;
    out.size = grid.brickSamples(key.index, key.level);
    const std::size_t total = std::size_t(out.size.x) * std::size_t(out.size.y) * std::size_t(out.size.z);
    out.values.resize(total);
    if (!fine.present.empty()) out.present.resize(total);
    if (fine.present.empty() && !categorical) {
        meansOf(fine, step, slices, out);
        return out;
    }
    LevelBlock block{categorical, 0, 0, 0, {}};
    std::size_t to = 0;
    for (int z = 0; z < out.size.z; ++z)
        for (int y = 0; y < out.size.y; ++y)
            for (int x = 0; x < out.size.x; ++x, ++to) {
                block.clear();
                const int first = (z / slices) * step * slices + z % slices;
                for (int k = first; k < std::min(first + step * slices, fine.size.z); k += slices)
                    for (int j = y * step; j < std::min((y + 1) * step, fine.size.y); ++j)
                        for (int i = x * step; i < std::min((x + 1) * step, fine.size.x); ++i) {
                            const std::size_t at = (std::size_t(k) * std::size_t(fine.size.y) + std::size_t(j)) *
                                                       std::size_t(fine.size.x) +
                                                   std::size_t(i);
                            block.add(double(fine.values[at]), fine.isPresent(at));
                        }
                if (block.exists()) out.values[to] = float(block.value());
                if (!out.present.empty()) out.present[to] = block.exists() ? 1 : 0;
            }
    return out;
}

BrickStats brickStats(const Field& field, glm::ivec3 begin, glm::ivec3 end) {
    BrickStats stats{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest(), 0};
    const glm::ivec3 size = end - begin;
    std::size_t present = 0;
    dispatch(field.type, [&]<class T>(T) {
        const auto stored = field.as<T>();
        T least = std::numeric_limits<T>::max(), most = std::numeric_limits<T>::lowest(); // NaN is neither
        for (int z = begin.z; z < end.z; ++z)
            for (int y = begin.y; y < end.y; ++y) {
                const std::size_t row = field.lattice.index({begin.x, y, z});
                const auto take = [&](T value) {
                    least = value < least ? value : least;
                    most = value > most ? value : most;
                };
                if (!field.mask) {
                    present += std::size_t(size.x);
                    for (std::size_t i = row; i < row + std::size_t(size.x); ++i) take(stored[i]);
                    continue;
                }
                for (std::size_t i = row; i < row + std::size_t(size.x); ++i)
                    if ((*field.mask)[i] != 0) {
                        ++present;
                        take(stored[i]);
                    }
            }
        if (!(least <= most)) return;
        const auto physical = [&](T value) { return float(field.offset + field.scale * double(value)); };
        stats.min = std::min(physical(least), physical(most));
        stats.max = std::max(physical(least), physical(most));
    });
    stats.presentFraction =
        float(double(present) / double(std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z)));
    return stats;
}

} // namespace tessera::volume
