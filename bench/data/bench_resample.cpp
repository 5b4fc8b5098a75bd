#include "bench/bench.h"

#include "volume/resample/series.h"
#include "volume/synthetic/marschner_lobb.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>

namespace tessera::app {

namespace {

struct Seconds {
    double wall = 1e30, cpu = 1e30;
};

/// The best of three runs; CPU time is of all threads.
template <class Work> Seconds best(const Work& work) {
    Seconds least;
    for (int run = 0; run < 3; ++run) {
        const auto start = std::chrono::steady_clock::now();
        const std::clock_t busy = std::clock();
        work();
        least.cpu = std::min(least.cpu, double(std::clock() - busy) / CLOCKS_PER_SEC);
        least.wall =
            std::min(least.wall, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return least;
}

void addRow(BenchTable& table, const std::string& data, const std::string& filter, double samples, Seconds seconds) {
    table.rows.push_back({data, filter, decimals(samples / 1e6, 1), decimals(seconds.wall, 2), decimals(seconds.cpu, 2),
                          decimals(samples / 1e6 / seconds.wall, 0)});
}

} // namespace

BenchTable benchResample() {
    BenchTable table;
    table.name = "resampling";
    table.columns = {"data", "filter", "Msamples in", "seconds", "CPU seconds", "Msamples/s"};
    const volume::Dataset volume = volume::makeMarschnerLobb({{"nx", 256}, {"ny", 256}, {"nz", 256}, {"bits", 8}});
    const volume::Field cube = volume.read(0, 0, 0);
    const volume::ResampleOptions filters[] = {
        {.filter = volume::ResampleFilter::Nearest},
        {.filter = volume::ResampleFilter::Linear},
        {.filter = volume::ResampleFilter::Cubic},
        {.filter = volume::ResampleFilter::BSpline3},
        {.filter = volume::ResampleFilter::BSpline5},
        {.filter = volume::ResampleFilter::Lagrange, .order = 5},
        {.filter = volume::ResampleFilter::Sinc, .order = 5},
    };
    for (const volume::ResampleOptions& options : filters)
        addRow(table, "256^3 u8 -> BCC", std::string(volume::kResampleFilterNames[std::size_t(options.filter)]),
               double(cube.count()), best([&] { (void)volume::toBcc(cube, false, options); }));

    // A parameter of two parts (volume/field/part_masks.h) beside the same samples as one, and with as many absent
    // ones.
    const volume::Dataset parted = volume::makeMarschnerLobb({{"nx", 128}, {"ny", 128}, {"nz", 128}});
    const auto halves = [&](std::uint8_t low, std::uint8_t high) {
        volume::Field field = parted.read(0, 0, 0);
        auto mask = std::make_shared<volume::Mask>(field.count());
        for (std::size_t i = 0; i < mask->size(); ++i) (*mask)[i] = i / 128 % 128 < 64 ? low : high;
        if (low != high) field.mask = std::move(mask);
        return field;
    };
    for (const auto& [name, field] : {std::pair{"one part", halves(1, 1)}, std::pair{"half absent", halves(1, 0)},
                                      std::pair{"two parts", halves(1, 2)}})
        addRow(table, std::string("128^3 f32 -> BCC, ") + name, "default", double(field.count()),
               best([&, each = &field] { (void)volume::toBcc(*each, false); }));

    const volume::Dataset moving =
        volume::makeMarschnerLobb({{"nx", 90}, {"ny", 90}, {"nz", 80}, {"times", 64}, {"bits", 8}});
    std::vector<std::shared_ptr<const volume::Field>> frames;
    for (int t = 0; t < 64; ++t) frames.push_back(std::make_shared<const volume::Field>(moving.read(0, 0, t)));
    const volume::Series series{
        {volume::LatticeKind4::CC, {90, 90, 80, 64}, glm::dvec4(1), glm::dvec4(0)}, false, [&](int t) {
            volume::Field frame = *frames[std::size_t(t)];
            frame.lattice.origin = glm::dvec3(0);
            frame.lattice.spacing = glm::dvec3(1);
            return std::make_shared<const volume::Field>(std::move(frame));
        }};
    const volume::Lattice4 d4 = volume::d4For(series.lattice);
    addRow(table, "90x90x80x64 u8 -> D4*", "cubic", double(series.lattice.count()), best([&] {
               const volume::Series kept = volume::remembering(series, std::size_t(volume::framesSpanned({})) + 1);
               for (int k = 0; k < d4.size.w; ++k) (void)volume::toD4Frame(kept, d4, k, {});
           }));
    return table;
}

} // namespace tessera::app
