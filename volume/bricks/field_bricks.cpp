#include "volume/bricks/field_bricks.h"

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <limits>
#include <type_traits>
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

/// What columns of stored numbers are summed in, and of how many rows that holds the sum.
template <class T> struct Columns {
    using Sum = double;
    using Total = double;
    static constexpr int kMostRows = std::numeric_limits<int>::max();
};
template <class T>
requires std::integral<T> &&(sizeof(T) < 4) struct Columns<T> {
    using Sum = std::conditional_t<sizeof(T) == 1, std::conditional_t<std::is_signed_v<T>, std::int16_t, std::uint16_t>,
                                   std::int32_t>;
    using Total = std::int64_t;
    static constexpr int kMostRows = sizeof(T) == 1 ? 256 : 32767;
};

/// Means of step^3 samples of a sublattice, or of as many as there are, of the samples [begin, end) of a field, all of
/// which are present. They are summed as they are stored: rows first, then along them.
template <class T>
void meansOf(const Field& field, glm::ivec3 begin, glm::ivec3 end, int step, int slices, BrickSamples& out) {
    using Sum = typename Columns<T>::Sum;
    using Total = typename Columns<T>::Total;
    const auto stored = field.as<T>();
    const auto width = std::size_t(out.size.x), fine = std::size_t(end.x - begin.x), every = std::size_t(step);
    std::vector<Sum> columns(fine);
    std::vector<Total> totals(width);
    const auto collect = [&] {
        for (std::size_t x = 0, i = 0; x < width; ++x)
            for (const std::size_t last = std::min(fine, (x + 1) * every); i < last; ++i)
                totals[x] += Total(columns[i]);
        std::ranges::fill(columns, Sum(0));
    };
    float* to = out.values.data();
    for (int z = 0; z < out.size.z; ++z) {
        const int first = begin.z + (z / slices) * step * slices + z % slices;
        const int last = std::min(first + step * slices, end.z);
        for (int y = begin.y; y < end.y; y += step, to += width) {
            std::ranges::fill(totals, Total(0));
            int rows = 0;
            for (int k = first; k < last; k += slices)
                for (int j = y; j < std::min(y + step, end.y); ++j) {
                    const T* const row = stored.data() + field.lattice.index({begin.x, j, k});
                    for (std::size_t i = 0; i < fine; ++i) columns[i] = Sum(columns[i] + Sum(row[i]));
                    if (++rows % Columns<T>::kMostRows == 0) collect();
                }
            collect();
            for (std::size_t x = 0; x < width; ++x) {
                const auto count = double(std::size_t(rows) * (std::min(fine, (x + 1) * every) - x * every));
                to[x] = float(field.offset + field.scale * (double(totals[x]) / count));
            }
        }
    }
}

/// Whether all samples [begin, end) of a field are present.
bool areAllPresent(const Field& field, glm::ivec3 begin, glm::ivec3 end) {
    if (!field.mask) return true;
    for (int z = begin.z; z < end.z; ++z)
        for (int y = begin.y; y < end.y; ++y) {
            const auto row = field.mask->begin() + std::ptrdiff_t(field.lattice.index({begin.x, y, z}));
            if (std::find(row, row + (end.x - begin.x), std::uint8_t(0)) != row + (end.x - begin.x)) return false;
        }
    return true;
}

} // namespace

BrickSamples fineBrick(const Field& field, glm::ivec3 begin, glm::ivec3 end) {
    BrickSamples out;
    out.size = end - begin;
    const std::size_t total = std::size_t(out.size.x) * std::size_t(out.size.y) * std::size_t(out.size.z);
    out.values.resize(total);
    if (field.mask) out.present.resize(total);
    const bool asStored = field.offset == 0 && field.scale == 1;
    dispatch(field.type, [&]<class T>(T) {
        const auto stored = field.as<T>();
        std::size_t to = 0;
        for (int z = begin.z; z < end.z; ++z)
            for (int y = begin.y; y < end.y; ++y) {
                const std::size_t row = field.lattice.index({begin.x, y, z});
                const auto width = std::size_t(out.size.x);
                const T* const from = stored.data() + row;
                float* const values = out.values.data() + to;
                if (asStored)
                    for (std::size_t x = 0; x < width; ++x) values[x] = float(from[x]);
                else
                    for (std::size_t x = 0; x < width; ++x)
                        values[x] = float(field.offset + field.scale * double(from[x]));
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
    const int slices = grid.lattice.kind == LatticeKind::BCC ? 2 : 1; // storage slices per texel
    const int step = 1 << key.level;
    BrickSamples out;
    out.size = grid.brickSamples(key.index, key.level);
    const std::size_t total = std::size_t(out.size.x) * std::size_t(out.size.y) * std::size_t(out.size.z);
    out.values.resize(total);
    if (!categorical && areAllPresent(field, begin, end)) {
        dispatch(field.type, [&]<class T>(T) { meansOf<T>(field, begin, end, step, slices, out); });
        return out;
    }
    const BrickSamples fine = fineBrick(field, begin, end);
    if (!fine.present.empty()) out.present.resize(total);
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

namespace {

constexpr std::size_t kAtOnce = 16; // so that the compiler uses vectors

/// Takes numbers into the least and greatest ones, kAtOnce of each, that lie nowhere among them; NaN is neither.
template <class T> void takeExtremes(const T* numbers, std::size_t count, T* __restrict least, T* __restrict most) {
    const auto take = [&](T number, std::size_t at) {
        least[at] = number < least[at] ? number : least[at];
        most[at] = number > most[at] ? number : most[at];
    };
    const std::size_t whole = count / kAtOnce * kAtOnce;
    for (std::size_t i = 0; i < whole; i += kAtOnce)
        for (std::size_t j = 0; j < kAtOnce; ++j) take(numbers[i + j], j);
    for (std::size_t i = whole; i < count; ++i) take(numbers[i], 0);
}

} // namespace

BrickStats brickStats(const Field& field, glm::ivec3 begin, glm::ivec3 end) {
    BrickStats stats{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest(), 0};
    const glm::ivec3 size = end - begin;
    std::size_t present = 0;
    dispatch(field.type, [&]<class T>(T) {
        const auto stored = field.as<T>();
        std::array<T, kAtOnce> leastOf, mostOf;
        leastOf.fill(std::numeric_limits<T>::max());
        mostOf.fill(std::numeric_limits<T>::lowest());
        for (int z = begin.z; z < end.z; ++z)
            for (int y = begin.y; y < end.y; ++y) {
                const std::size_t row = field.lattice.index({begin.x, y, z}), width = std::size_t(size.x);
                if (!field.mask) {
                    present += width;
                    takeExtremes(stored.data() + row, width, leastOf.data(), mostOf.data());
                    continue;
                }
                for (std::size_t i = row; i < row + width; ++i)
                    if ((*field.mask)[i] != 0) {
                        ++present;
                        takeExtremes(&stored[i], 1, leastOf.data(), mostOf.data());
                    }
            }
        const T least = *std::ranges::min_element(leastOf), most = *std::ranges::max_element(mostOf);
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
