#include "tests/volume/fields.h"
#include "volume/field/part_masks.h"
#include "volume/import/import.h"
#include "volume/resample/resample.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <glm/common.hpp>
#include <gtest/gtest.h>

/// The measured figures of data of several regions: the shared fuel cell, to BCC and back.
namespace tessera::volume {
namespace {

constexpr int kCellBins = 200;

/// Counts of present samples over a range.
std::vector<int> histogram(const Field& field, Range range) {
    std::vector<int> counts(kCellBins);
    for (std::size_t i = 0; i < field.count(); ++i) {
        if (!field.present(i)) continue;
        const double share = (field.value(i) - range.lo) / (range.hi - range.lo);
        counts[std::size_t(std::clamp(int(share * kCellBins), 0, kCellBins - 1))] += 1;
    }
    return counts;
}

Range rangeOf(const Field& field) {
    Range range{1e30, -1e30};
    for (std::size_t i = 0; i < field.count(); ++i)
        if (field.present(i)) range = {std::min(range.lo, field.value(i)), std::max(range.hi, field.value(i))};
    return range;
}

/// Samples of a frame within two cells of another region, and the others, in order.
struct ByPlace {
    std::vector<double> near, inside;
    void sort() {
        std::sort(near.begin(), near.end());
        std::sort(inside.begin(), inside.end());
    }
    static double share99(const std::vector<double>& of) { return of.empty() ? 0 : of[of.size() * 99 / 100]; }
    double near99() const { return share99(near); }
    double inside99() const { return share99(inside); }
};

/// Which samples lie within two cells of one of another region that `counts(own, other)`.
template <class Counts> std::vector<bool> besideBorders(const Field& labels, const Counts& counts) {
    const Lattice& lattice = labels.lattice;
    const std::vector<double> regions = physicalValues(labels);
    std::vector<bool> out;
    for (std::size_t i = 0; i < regions.size(); ++i) {
        const glm::ivec3 at(int(i) % lattice.size.x, int(i) / lattice.size.x % lattice.size.y,
                            int(i) / (lattice.size.x * lattice.size.y));
        bool border = false;
        for (int c = 0; c < 125 && !border; ++c) {
            const glm::ivec3 there =
                glm::clamp(at + glm::ivec3(c % 5, c / 5 % 5, c / 25) - 2, glm::ivec3(0), lattice.size - 1);
            border = counts(regions[i], regions[lattice.index(there)]);
        }
        out.push_back(border);
    }
    return out;
}

/// `value(i, at)` of every present sample of a frame that lies `margin` samples from its faces, less than 0: of none.
template <class Value>
ByPlace byPlace(const Field& source, const std::vector<bool>& border, int margin, const Value& value) {
    ByPlace out;
    const Lattice& lattice = source.lattice;
    for (int z = margin; z < lattice.size.z - margin; ++z)
        for (int y = margin; y < lattice.size.y - margin; ++y)
            for (int x = margin; x < lattice.size.x - margin; ++x) {
                const std::size_t i = lattice.index({x, y, z});
                const double own = source.present(i) ? value(i, glm::ivec3(x, y, z)) : -1;
                if (own >= 0) (border[i] ? out.near : out.inside).push_back(own);
            }
    out.sort();
    return out;
}

ByPlace errorsOf(const Field& source, const Field& back, const std::vector<bool>& border, double range,
                 int margin = 0) {
    return byPlace(source, border, margin, [&](std::size_t i, glm::ivec3) {
        return back.present(i) ? std::abs(back.value(i) - source.value(i)) / range : -1;
    });
}

std::uint8_t numberAt(const Field& field, std::size_t i) {
    return field.mask ? (*field.mask)[i] : std::uint8_t(1);
}

/// How much the samples bend: the largest second difference along an axis, of three samples of one part, among those
/// that a sample takes part in.
ByPlace bendsOf(const Field& source, const std::vector<bool>& border, double range) {
    const Lattice& lattice = source.lattice;
    const auto within = [&](glm::ivec3 at) { return glm::clamp(at, glm::ivec3(0), lattice.size - 1) == at; };
    return byPlace(source, border, 0, [&](std::size_t i, glm::ivec3 at) {
        double most = 0;
        for (int axis = 0; axis < 3; ++axis)
            for (int along = -1; along <= 1; ++along) {
                glm::ivec3 step(0);
                step[axis] = 1;
                const glm::ivec3 middle = at + along * step;
                if (!within(middle - step) || !within(middle + step)) continue;
                const std::size_t n[] = {lattice.index(middle - step), lattice.index(middle),
                                         lattice.index(middle + step)};
                if (std::any_of(n, n + 3, [&](std::size_t k) { return numberAt(source, k) != numberAt(source, i); }))
                    continue;
                most = std::max(most, std::abs(source.value(n[0]) - 2 * source.value(n[1]) + source.value(n[2])));
            }
        return most / range;
    });
}

/// By how much a field leaves what the samples of its own part around each place hold, at most; a part goes on beyond
/// its outermost samples by up to half a cell.
double beyondItsPart(const Field& source, const Field& made) {
    const Lattice &from = source.lattice, &to = made.lattice;
    double most = 0;
    for (int z = 0; z < to.size.z; ++z)
        for (int y = 0; y < to.size.y; ++y)
            for (int x = 0; x < to.size.x; ++x) {
                const std::size_t i = to.index({x, y, z});
                if (!made.present(i)) continue;
                const glm::ivec3 near = from.nearest(to.position({x, y, z}));
                Range own{1e30, -1e30};
                for (int c = 0; c < 125; ++c) {
                    const glm::ivec3 at = near + glm::ivec3(c % 5, c / 5 % 5, c / 25) - 2;
                    if (glm::clamp(at, glm::ivec3(0), from.size - 1) != at) continue;
                    const std::size_t n = from.index(at);
                    if (numberAt(source, n) != numberAt(made, i)) continue;
                    own = {std::min(own.lo, source.value(n)), std::max(own.hi, source.value(n))};
                }
                most = std::max({most, own.lo - made.value(i), made.value(i) - own.hi});
            }
    return most;
}

/// A grid of the shared cell: its data set, and the region of each sample.
struct Cell {
    std::string name;
    Dataset dataset;
    Field labels;
    std::vector<bool> border, membrane; ///< beside any other region, and beside the gas of the other side
};
std::vector<Cell> cells() {
    const char* stated = std::getenv("TESSERA_DATA");
    const std::filesystem::path data = stated != nullptr ? stated : TESSERA_TEST_DATA;
    std::vector<Cell> out;
    for (const char* name : {"small", "large"}) {
        const std::string file = (data / "fuel-cell" / "grid" / name).string() + ".pvd";
        if (!std::filesystem::exists(file)) return {};
        Cell cell{name, openFiles({file}, {}), {}, {}, {}};
        const DatasetInfo& info = cell.dataset.info;
        const auto label = std::ranges::find_if(info.parameters, &Parameter::categorical);
        cell.labels = cell.dataset.read(int(label - info.parameters.begin()), 0, int(info.times.size()) - 1);
        cell.border = besideBorders(cell.labels, std::not_equal_to<>());
        cell.membrane = besideBorders(cell.labels, [](double own, double other) { // 1 is air, 3 fuel, 0 solid
            return (own == 1 && other == 3) || (own == 3 && other == 1);
        });
        out.push_back(std::move(cell));
    }
    return out;
}

TEST(RegionsOfTheFuelCell, KeepTheirValuesOnBccAndBack) {
    const std::vector<Cell> all = cells();
    if (all.empty()) GTEST_SKIP() << "the shared fuel cell is not there";
    for (const auto& [name, dataset, labels, border, membrane] : all) {
        const Dataset parted = withParts(dataset);
        const DatasetInfo& info = dataset.info;
        const int last = int(info.times.size()) - 1;
        const bool small = name == "small";
        for (std::size_t p = 0; p < info.parameters.size(); ++p) {
            const Parameter& parameter = info.parameters[p];
            if (parameter.categorical) continue;
            for (int c = 0; c < parameter.components; ++c) {
                const std::string what = name + " " + parameter.name + "." + std::to_string(c);
                const Field source = parted.read(int(p), c, last);
                const Range range = rangeOf(source);
                const double width = range.hi - range.lo;
                const Field bcc = toBcc(source, false), back = resample(bcc, source.lattice, ResampleFilter::Cubic);
                const std::vector<int> before = histogram(source, range), after = histogram(bcc, range);
                int filled = 0, samples = 0;
                for (std::size_t b = 0; b < before.size(); ++b)
                    if (before[b] == 0 && after[b] > 0) filled += 1, samples += after[b];
                const ByPlace errors = errorsOf(source, back, border, width), bends = bendsOf(source, border, width);
                const double ratio = errors.near99() / errors.inside99(), bend = bends.near99() / bends.inside99();
                const double beside = errorsOf(source, back, membrane, width).near99() / errors.inside99();
                const double beyond = beyondItsPart(source, bcc) / width;
                std::printf("%s: error p99 near %.3f %%, inside %.3f %%: %.2f times, at the membrane %.2f times, bends "
                            "%.2f times; beyond its "
                            "part %.2f %%; bins filled %d (%d samples)\n",
                            what.c_str(), 100 * errors.near99(), 100 * errors.inside99(), ratio, beside, bend,
                            100 * beyond, filled, samples);
                if (parameter.parts.count() > 1) {
                    const Field plain = dataset.read(int(p), c, last);
                    const ByPlace mixed = errorsOf(
                        plain, resample(toBcc(plain, false), plain.lattice, ResampleFilter::Cubic), border, width);
                    EXPECT_LE(errors.near99(), mixed.near99()) << what;
                }
                if (parameter.components > 1) continue;
                // A bin that no sample of the file is in can be filled where the samples of one part step over it.
                EXPECT_LE(beyond, 0.005) << what;
                if (small) {
                    // Of a layer one sample thick BCC has one sublattice, half of its samples. The temperature rises
                    // and falls by a third of its range within two cells there.
                    EXPECT_LT(errors.near99(), parameter.name == "T" ? 0.09 : 0.018) << what;
                    continue;
                }
                EXPECT_EQ(filled, 0) << what;
                EXPECT_LE(beside, 2) << what << " at the membrane";
                // The error follows how much the data bend, and that is more at borders: no more than that.
                EXPECT_LE(ratio, 1.5 * std::max(bend, 1.0)) << what;
                EXPECT_LE(ratio, parameter.name == "T" || parameter.name == "O2" ? 2.7 : 2.25) << what;
            }
        }
    }
}

// What the borders themselves cost: functions that bend alike everywhere, on the regions of the large grid.
TEST(RegionsOfTheFuelCell, ASmoothFunctionIsAsGoodAtABorder) {
    const std::vector<Cell> all = cells();
    if (all.empty()) GTEST_SKIP() << "the shared fuel cell is not there";
    using Function = double (*)(glm::dvec3);
    const Function functions[] = {
        [](glm::dvec3 p) { return std::sin(0.5 * p.x + 0.3 * p.y + 0.2 * p.z); },
        [](glm::dvec3 p) { return std::sin(0.4 * p.x - 0.6 * p.y) + 0.02 * p.z; },
        [](glm::dvec3 p) { return std::sin(0.2 * p.x) * std::cos(0.2 * p.y) * std::sin(0.1 * p.z); },
    };
    const Cell& cell = all.back();
    ASSERT_EQ(cell.name, "large");
    Field source = makeField(cell.labels.lattice, ScalarType::F32);
    source.lattice.spacing = glm::dvec3(1);
    source.lattice.origin = glm::dvec3(0);
    auto mask = std::make_shared<Mask>(source.count());
    for (std::size_t i = 0; i < source.count(); ++i)
        (*mask)[i] = std::uint8_t(cell.labels.value(i) == 1 ? 1 : cell.labels.value(i) == 3 ? 2 : 0);
    source.mask = mask;
    for (const Function function : functions) {
        const glm::ivec3 size = source.lattice.size;
        std::size_t i = 0;
        for (int z = 0; z < size.z; ++z)
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x, ++i)
                    source.as<float>()[i] = float(function({x, y, z}) + ((*mask)[i] == 1 ? 5 : 0));
        const Field back = resample(toBcc(source, false), source.lattice, ResampleFilter::Cubic);
        const ByPlace errors = errorsOf(source, back, cell.border, 1, 2);
        std::printf("error p99 near %.4f, inside %.4f\n", errors.near99(), errors.inside99());
        EXPECT_LE(errors.near99(), 2 * errors.inside99());
    }
}

} // namespace
} // namespace tessera::volume
