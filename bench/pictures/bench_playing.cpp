#include "bench/bench.h"
#include "bench/data/bench_archives.h"
#include "bench/data/enlarged_cell.h"
#include "bench/pictures/bench_frames.h"
#include "bench/pictures/bench_volumes.h"
#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "vis/gl/headless.h"
#include "volume/sources/centred_source.h"
#include "volume/sources/memory_source.h"

#include <chrono>
#include <thread>

/// How soon a time that was not shown before is seen, and how many of them a second: as the program opens data, with
/// rays cast by the processor.
namespace tessera::app {

namespace {

using Source = std::shared_ptr<const volume::BrickSource>;
constexpr int kTimes = 24;

/// One parameter "v" of range 0..255 at some times, in memory.
volume::Dataset series(const std::string& name, std::vector<volume::Field> frames) {
    volume::Dataset out;
    const volume::Lattice lattice = frames.front().lattice;
    out.info.name = name;
    out.info.lattice = lattice;
    out.info.bounds = {glm::dvec3(0), glm::dvec3(lattice.size - 1)};
    volume::Parameter parameter;
    parameter.name = "v";
    parameter.type = frames.front().type;
    parameter.ranges = {{0, 255}};
    out.info.parameters = {parameter};
    out.info.times.clear();
    for (std::size_t t = 0; t < frames.size(); ++t) out.info.times.push_back(double(t));
    out.read = [all = std::make_shared<const std::vector<volume::Field>>(std::move(frames))](int, int, int time) {
        return (*all)[std::size_t(time)];
    };
    return out;
}

/// The CT phantom, each time darker than the one before.
volume::Dataset darkening(int edge, int times) {
    const BenchVolume phantom = phantomVolume(edge);
    std::vector<volume::Field> frames;
    for (int t = 0; t < times; ++t) {
        volume::Lattice lattice;
        lattice.size = phantom.size;
        volume::Field field = volume::makeField(lattice, volume::ScalarType::U8);
        for (std::size_t i = 0; i < phantom.bytes.size(); ++i)
            field.as<std::uint8_t>()[i] = std::uint8_t(int(phantom.bytes[i]) * (2 * times - t) / (2 * times));
        frames.push_back(std::move(field));
    }
    return series(phantom.name, std::move(frames));
}

/// The temperature of the built-in cell, enlarged, as part of its range.
volume::Dataset cellSeries(glm::ivec3 size) {
    const volume::Dataset cell = enlargedCell(size, kTimes);
    int parameter = 0;
    while (cell.info.parameters[std::size_t(parameter)].name != "T") ++parameter;
    const Range range = cell.info.parameters[std::size_t(parameter)].ranges.front();
    std::vector<volume::Field> frames;
    for (int t = 0; t < kTimes; ++t) {
        const volume::Field from = cell.read(parameter, 0, t);
        volume::Lattice lattice;
        lattice.size = size;
        volume::Field field = volume::makeField(lattice, volume::ScalarType::F32);
        for (std::size_t i = 0; i < field.count(); ++i)
            field.as<float>()[i] = float(255 * (from.value(i) - range.lo) / (range.hi - range.lo));
        frames.push_back(std::move(field));
    }
    return series("fuel cell 64x64x256, floats", std::move(frames));
}

/// A data set as it is drawn: on its grid, as pictures are by default, and both from an archive.
struct Drawn {
    const char* name;
    Source source;
};
std::vector<Drawn> drawnFrom(volume::Dataset data, const std::string& archive) {
    constexpr std::size_t kBricksMade = std::size_t(1) << 29; // as app/data/picture_lattice.cpp
    codec::pack(data, {}, archive, {});
    const auto memory = [&] { return volume::makeMemorySource(data, {}); };
    const auto packed = [&] { return std::make_shared<const codec::Archive>(archive); };
    return {{"grid", memory()},
            {"body-centred", volume::makeCentredSource(memory(), kBricksMade)},
            {"archive, grid", packed()},
            {"archive, body-centred", volume::makeCentredSource(packed(), kBricksMade)}};
}

vis::Scene translucent() {
    vis::Scene scene = benchScene(vis::VolumeLayer{.channel = "v", .shaded = false}, {{0, 0}, {0.15f, 0}, {1, 0.05f}});
    scene.render.engine = vis::Engine::Processor;
    return scene;
}

/// Processor time of all threads, and time that passes.
struct Clocks {
    double processor = milliseconds(BenchClock::Processor), wall = milliseconds(BenchClock::Wall);
};
void addSince(std::vector<std::string>& row, const Clocks& begin) {
    const Clocks now;
    row.push_back(decimals(now.wall - begin.wall, 0));
    row.push_back(decimals(now.processor - begin.processor, 0));
}

/// Frames until one is as wanted.
template <class Wanted>
void drawUntil(vis::Renderer& renderer, vis::ViewTarget& target, const vis::Scene& scene, bool moving,
               const Wanted& wanted) {
    const vis::FrameRequest request{.size = {kBenchPicture, kBenchPicture}, .moving = moving};
    for (;;) {
        const vis::FrameStatus status = renderer.render(target, scene, request);
        if (wanted(status)) return;
        if (status.waits) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}
constexpr auto kIsShown = [](const vis::FrameStatus& status) { return status.current && status.samples > 0; };
constexpr auto kIsComplete = [](const vis::FrameStatus& status) { return status.complete; };

} // namespace

BenchTable benchNewData() {
    const vis::HeadlessContext context;
    BenchTable table{"new data: another time of 256^3 bytes",
                     {"drawn from", "first seen, ms", "CPU ms", "all refined, ms", "CPU ms"},
                     {}};
    const BenchFile archive;
    for (const Drawn& drawn : drawnFrom(darkening(256, 3), archive.path)) {
        vis::Renderer renderer;
        renderer.setSource(drawn.source);
        const vis::ViewTargetPtr target = renderer.makeTarget();
        vis::Scene scene = translucent();
        drawUntil(renderer, *target, scene, false, kIsComplete);
        scene.time = 2; // no animation: nothing is read before
        std::vector<std::string> row{drawn.name};
        const Clocks begin;
        drawUntil(renderer, *target, scene, false, kIsShown);
        addSince(row, begin);
        drawUntil(renderer, *target, scene, false, kIsComplete);
        addSince(row, begin);
        table.rows.push_back(std::move(row));
    }
    return table;
}

BenchTable benchPlaying() {
    const vis::HeadlessContext context;
    BenchTable table{"playing 24 times",
                     {"series", "drawn from", "pictures / s", "of the aim", "CPU ms a picture", "again, pictures / s"},
                     {}};
    struct Played {
        volume::Dataset data;
        double aim; ///< pictures a second
    };
    for (const Played& played : {Played{cellSeries({64, 64, 256}), 20}, Played{darkening(128, kTimes), 12}}) {
        const BenchFile archive;
        for (const Drawn& drawn : drawnFrom(played.data, archive.path)) {
            vis::Renderer renderer;
            renderer.setSource(drawn.source);
            const vis::ViewTargetPtr target = renderer.makeTarget();
            vis::Scene scene = translucent();
            drawUntil(renderer, *target, scene, true, kIsShown);
            const auto play = [&](int from) {
                const Clocks begin;
                for (int t = from; t < kTimes; ++t) {
                    scene.time = t;
                    drawUntil(renderer, *target, scene, true, kIsShown);
                }
                const Clocks end;
                const double count = kTimes - from;
                return std::pair(1000 * count / (end.wall - begin.wall), (end.processor - begin.processor) / count);
            };
            const auto [rate, cost] = play(1);
            const double again = play(0).first;
            table.rows.push_back({played.data.info.name, drawn.name, decimals(rate, 1), decimals(rate / played.aim, 2),
                                  decimals(cost, 0), decimals(again, 1)});
        }
    }
    return table;
}

} // namespace tessera::app
