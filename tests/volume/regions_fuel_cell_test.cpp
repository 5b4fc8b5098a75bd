#include "tests/volume/fields.h"
#include "volume/import/import.h"
#include "volume/part_masks.h"
#include "volume/resample.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <glm/common.hpp>
#include <gtest/gtest.h>

/// The measured figures of data of several regions: the shared fuel cell, to BCC and back.
namespace tessera::volume {
namespace {

constexpr int kBins = 200;

/// Counts of present samples over a range.
std::vector<int> histogram(const Field& field, Range range) {
    std::vector<int> counts(kBins);
    for (std::size_t i = 0; i < field.count(); ++i) {
        if (!field.present(i)) continue;
        const double share = (field.value(i) - range.lo) / (range.hi - range.lo);
        counts[std::size_t(std::clamp(int(share * kBins), 0, kBins - 1))] += 1;
    }
    return counts;
}

Range rangeOf(const Field& field) {
    Range range{1e30, -1e30};
    for (std::size_t i = 0; i < field.count(); ++i)
        if (field.present(i)) range = {std::min(range.lo, field.value(i)), std::max(range.hi, field.value(i))};
    return range;
}

/// Errors of present samples within two cells of another region, and of the others, in order.
struct Errors {
    std::vector<double> near, inside;
    static double share99(const std::vector<double>& of) { return of.empty() ? 0 : of[of.size() * 99 / 100]; }
};

Errors errorsOf(const Field& source, const Field& back, const Field& labels, double range) {
    Errors out;
    const glm::ivec3 size = source.lattice.size;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const std::size_t i = source.lattice.index({x, y, z});
                if (!source.present(i) || !back.present(i)) continue;
                bool border = false;
                for (int c = 0; c < 125 && !border; ++c) {
                    const glm::ivec3 at = glm::clamp(glm::ivec3(x, y, z) + glm::ivec3(c % 5, c / 5 % 5, c / 25) - 2,
                                                     glm::ivec3(0), size - 1);
                    border = labels.value(source.lattice.index(at)) != labels.value(i);
                }
                (border ? out.near : out.inside).push_back(std::abs(back.value(i) - source.value(i)) / range);
            }
    std::sort(out.near.begin(), out.near.end());
    std::sort(out.inside.begin(), out.inside.end());
    return out;
}

TEST(RegionsOfTheFuelCell, KeepTheirValuesOnBccAndBack) {
    const char* stated = std::getenv("TESSERA_DATA");
    const std::filesystem::path data = stated != nullptr ? stated : TESSERA_TEST_DATA;
    for (const char* name : {"small", "large"}) {
        const std::string file = (data / "fuel-cell" / "grid" / name).string() + ".pvd";
        if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
        const Dataset dataset = openFiles({file}, {}), parted = withParts(dataset);
        const DatasetInfo& info = dataset.info;
        const int last = int(info.times.size()) - 1;
        int label = 0;
        while (!info.parameters[std::size_t(label)].categorical) ++label;
        const Field labels = dataset.load(label, 0, last);
        for (std::size_t p = 0; p < info.parameters.size(); ++p) {
            const Parameter& parameter = info.parameters[p];
            if (parameter.categorical) continue;
            for (int c = 0; c < parameter.components; ++c) {
                const Field source = dataset.load(int(p), c, last);
                const Range range = rangeOf(source);
                const auto roundTrip = [&](const Field& from, const char* how) {
                    const Field bcc = toBcc(from, false), back = resample(bcc, source.lattice, ResampleFilter::Cubic);
                    const std::vector<int> before = histogram(source, range), after = histogram(bcc, range);
                    int filled = 0, samples = 0;
                    for (std::size_t b = 0; b < before.size(); ++b)
                        if (before[b] == 0 && after[b] > 0) filled += 1, samples += after[b];
                    const Errors errors = errorsOf(source, back, labels, range.hi - range.lo);
                    std::printf("%s %s.%d %s: bins filled %d (%d samples); error p99 near %.3f %%, inside %.3f %%, "
                                "largest %.3f %%\n",
                                name, parameter.name.c_str(), c, how, filled, samples,
                                100 * Errors::share99(errors.near), 100 * Errors::share99(errors.inside),
                                errors.near.empty() ? 0 : 100 * errors.near.back());
                    return std::tuple(filled, Errors::share99(errors.near), Errors::share99(errors.inside));
                };
                const auto [filled, near, inside] = roundTrip(parted.load(int(p), c, last), "by parts");
                if (parameter.parts.count() > 1) {
                    const auto [mixedFilled, mixedNear, mixedInside] = roundTrip(source, "mixed");
                    EXPECT_LE(near, mixedNear) << name << " " << parameter.name;
                }
                // Gases and pressure; the temperature has its steepest bend at the membrane itself. The small grid has
                // layers of one sample, which nothing says how to continue.
                if (parameter.components > 1) continue;
                EXPECT_LT(near, parameter.name == "T" ? 0.1 : 0.06) << name << " " << parameter.name;
                if (std::string(name) == "small") continue;
                EXPECT_EQ(filled, 0) << name << " " << parameter.name;
                EXPECT_LE(near, (parameter.name == "T" ? 3 : 2.5) * inside) << name << " " << parameter.name;
            }
        }
    }
}

} // namespace
} // namespace tessera::volume
