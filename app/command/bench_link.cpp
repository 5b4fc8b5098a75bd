#include "app/command/bench.h"
#include "app/platform/gui.h"
#include "app/views/statistics_feed.h"
#include "app/workbench.h"
#include "vis/gl/headless.h"
#include "volume/error.h"
#include "volume/memory_source.h"
#include "volume/synthetic/models.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <imgui.h>
#include <map>
#include <thread>

/// How fast linked views follow the hand, and how fast a scatterplot matrix of many samples appears.
namespace tessera::app {

namespace {

using Clock = std::chrono::steady_clock;
constexpr glm::ivec2 kWindow{1500, 950};
constexpr int kSteps = 9;       // of a drag, of which the median counts
constexpr int kMostFrames = 60; // until every view has followed
constexpr int kMostAtRest = 2000;

double milliseconds(Clock::time_point since) {
    return std::chrono::duration<double, std::milli>(Clock::now() - since).count();
}

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    std::ranges::sort(values);
    return values[values.size() / 2];
}

/// The built-in fuel cell at 24 times, its frames enlarged to 64x64x256 samples when they are read: solving it at that
/// size would take minutes and give the same pictures.
std::shared_ptr<const volume::BrickSource> largeCell() {
    auto small = std::make_shared<volume::Dataset>(volume::makeModel("fuel-cell", {{"times", 24}}));
    volume::Dataset large{.info = small->info, .load = {}};
    const volume::Lattice from = small->info.lattice;
    volume::Lattice& to = large.info.lattice;
    to.size = {64, 64, 256};
    to.origin = small->info.bounds.lo;
    to.spacing = small->info.bounds.size() / glm::dvec3(to.size - 1);
    large.load = [small, from, to](int parameter, int component, int time) {
        const volume::Field coarse = small->load(parameter, component, time);
        const bool label = small->info.parameters[std::size_t(parameter)].categorical;
        volume::Field fine = volume::makeField(to, coarse.type);
        auto mask = std::make_shared<volume::Mask>(to.count(), std::uint8_t(1));
        for (int z = 0; z < to.size.z; ++z)
            for (int y = 0; y < to.size.y; ++y)
                for (int x = 0; x < to.size.x; ++x) {
                    const glm::dvec3 at = (to.position({x, y, z}) - from.origin) / from.spacing;
                    const glm::ivec3 near =
                        glm::clamp(glm::ivec3(glm::round(at)), glm::ivec3(0), glm::ivec3(from.size) - 1);
                    const std::size_t i = to.index({x, y, z}), n = from.index(near);
                    (*mask)[i] = coarse.present(n) ? 1 : 0;
                    double sum = 0, weights = 0;
                    for (int corner = 0; corner < 8 && !label; ++corner) {
                        const glm::dvec3 below = glm::floor(at);
                        const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
                        const glm::ivec3 index = glm::ivec3(below) + step;
                        const glm::dvec3 part = glm::mix(1.0 - (at - below), at - below, glm::dvec3(step));
                        if (glm::any(glm::lessThan(index, glm::ivec3(0))) ||
                            glm::any(glm::greaterThanEqual(index, from.size)) || !coarse.present(from.index(index)))
                            continue;
                        const double weight = part.x * part.y * part.z;
                        sum += weight * coarse.value(from.index(index));
                        weights += weight;
                    }
                    if (label)
                        fine.as<std::uint8_t>()[i] = coarse.as<std::uint8_t>()[n];
                    else
                        fine.as<float>()[i] = float(weights > 0 ? sum / weights : coarse.value(n));
                }
        fine.mask = mask;
        return fine;
    };
    return volume::makeMemorySource(std::move(large), {.lattice = volume::LatticeKind::BCC});
}

/// The lens layout on that cell.
Opened shown() {
    Opened opened;
    opened.source = largeCell();
    DataRef data;
    data.model = "fuel-cell";
    opened.document.session =
        applyLayout(loadSession(findLayout("lens")), opened.source->info(), data, opened.messages);
    opened.document.history.reset(opened.document.session);
    return opened;
}

/// What one kind of drag costs: by pane, the time its drawing takes and the time until it shows the new state.
struct Followed {
    std::map<std::string, std::vector<double>> drawing, shown;
    std::vector<double> all; ///< until every pane has followed
};

/// Edits the session as a drag does, with the mouse held down, and waits after each step until every view shows it.
Followed drag(const std::function<void(Session&, double)>& edit, OffscreenFrames& frames, Workbench& workbench,
              std::function<void(const std::string&, bool)>& paneDrawn) {
    Followed out;
    for (int frame = 0; frame == 0 || (workbench.busy() && frame < kMostAtRest); ++frame)
        frames.draw(workbench, 1);      // as one begins to drag: all is there
    const auto held = [](ImGuiIO& io) { // on the status bar, where it does nothing but make every view draw at speed
        io.MousePos = {40, float(kWindow.y) - 6};
        io.MouseDown[0] = true;
    };
    for (int step = 0; step <= kSteps; ++step) {
        const Clock::time_point begin = Clock::now();
        edit(workbench.session(), double(step) / kSteps);
        std::map<std::string, double> first;
        bool behind = true;
        double inPanes = 0;
        for (int frame = 0; frame < kMostFrames && behind; ++frame) {
            behind = false;
            Clock::time_point before = Clock::now();
            paneDrawn = [&](const std::string& pane, bool late) {
                OffscreenFrames::finish();
                const double spent = milliseconds(before);
                if (step > 0 && frame == 0) out.drawing[pane].push_back(spent);
                inPanes += spent;
                if (late)
                    behind = true;
                else
                    first.try_emplace(pane, milliseconds(begin));
                before = Clock::now();
            };
            frames.draw(workbench, 1, held);
            OffscreenFrames::finish();
        }
        paneDrawn = nullptr;
        if (!ImGui::IsAnyItemActive()) throw MachineError("the mouse holds nothing");
        if (step == 0) continue; // to warm up
        for (const auto& [pane, time] : first) out.shown[pane].push_back(time);
        out.all.push_back(milliseconds(begin));
    }
    frames.draw(workbench, 1);
    return out;
}

void add(BenchTable& table, const std::string& what, const Followed& followed) {
    std::vector<double> together;
    for (const auto& [pane, times] : followed.drawing) together.push_back(median(times));
    for (const auto& [pane, times] : followed.drawing)
        table.rows.push_back({what, pane, decimals(median(times), 1), decimals(median(followed.shown.at(pane)), 1)});
    double sum = 0;
    for (const double each : together) sum += each;
    table.rows.push_back({what, "every view", decimals(sum, 1), decimals(median(followed.all), 1)});
}

/// Seven parameters on 250x250x1000 samples: eight bricks of noise and waves, repeated, as a cache of decoded bricks
/// would give them.
class ManySamples final : public volume::BrickSource {
public:
    ManySamples() {
        info_.name = "bench";
        info_.lattice.size = {250, 250, 1000};
        info_.bounds = {glm::dvec3(0), glm::dvec3(info_.lattice.size - 1)};
        for (int p = 0; p < 7; ++p) {
            volume::Parameter parameter;
            parameter.name = std::string(1, char('a' + p));
            parameter.ranges = {{-1.2, 1.2}};
            info_.parameters.push_back(parameter);
        }
        grid_ = {.lattice = info_.lattice, .brickSize = 64, .levels = 6};
        for (int p = 0; p < 7; ++p)
            for (int kind = 0; kind < kKinds; ++kind) {
                std::vector<float>& values = bricks_.emplace_back(std::size_t(64) * 64 * 64);
                std::uint32_t state = std::uint32_t(1 + p + 7 * kind);
                for (std::size_t i = 0; i < values.size(); ++i) {
                    state = state * 1664525u + 1013904223u;
                    const double noise = double(state >> 8) / double(1u << 24) - 0.5;
                    values[i] = float(std::sin(double(i % 4096) * 0.003 * (p + 1) + kind) + 0.3 * noise);
                }
            }
    }
    const volume::DatasetInfo& info() const override { return info_; }
    const volume::BrickGrid& grid() const override { return grid_; }
    volume::BrickStats stats(const volume::BrickKey&) const override { return {-1.2f, 1.2f, 1}; }
    volume::BrickSamples read(const volume::BrickKey& key) const override {
        const std::vector<float>& from =
            bricks_[std::size_t(key.channel * kKinds + (key.index.x + key.index.y + key.index.z) % kKinds)];
        const glm::ivec3 size = grid_.brickSamples(key.index, key.level);
        volume::BrickSamples out{.size = size, .values = {}, .present = {}};
        out.values.resize(std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z));
        std::size_t to = 0;
        for (int z = 0; z < size.z; ++z)
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x)
                    out.values[to++] =
                        from[std::size_t(((z << key.level) * 64 + (y << key.level)) * 64 + (x << key.level))];
        return out;
    }

private:
    static constexpr int kKinds = 8;
    volume::DatasetInfo info_;
    volume::BrickGrid grid_;
    std::vector<std::vector<float>> bricks_; ///< by channel and kind
};

/// Milliseconds until a feed answers a wish, first at any level, then in full.
std::pair<double, double> answered(StatisticsFeed& feed, ViewContext& context, const StatisticsWish& wish, bool whole) {
    const Clock::time_point begin = Clock::now();
    double first = -1;
    for (;;) {
        context.jobs.collect();
        const auto result = feed.get(context, "bench", wish);
        if (result && result->wish == wish) {
            if (first < 0) first = milliseconds(begin);
            if (!whole || result->statistics.level == 0) return {first, milliseconds(begin)};
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

} // namespace

BenchTable benchLink() {
    BenchTable table{"link", {"dragged", "view", "ms drawing", "ms until shown"}, {}};
    const vis::HeadlessContext gl;
    const Gui gui;
    std::function<void(const std::string&, bool)> paneDrawn;
    Workbench workbench({.renderer = nullptr,
                         .render = {},
                         .headless = false,
                         .onlyPane = {},
                         .stateFolder = {},
                         .paneDrawn = [&](const std::string& pane, bool behind) {
                             if (paneDrawn) paneDrawn(pane, behind);
                         }});
    workbench.install(shown());
    OffscreenFrames frames(kWindow);
    const volume::Box box = workbench.source()->info().bounds;
    const Range heat = [&] {
        const volume::DatasetInfo& info = workbench.source()->info();
        return info.channelRange(info.channels()[std::size_t(info.findChannel("T").value())]);
    }();
    const auto at = [](Range range, double share) { return range.lo + share * (range.hi - range.lo); };

    add(table, "cursor",
        drag([&](Session& session, double share) { session.cursor = box.lo + box.size() * (0.3 + 0.4 * share); },
             frames, workbench, paneDrawn));
    add(table, "lens",
        drag([&](Session& session,
                 double share) { session.lenses.front().center = box.lo + box.size() * (0.3 + 0.4 * share); },
             frames, workbench, paneDrawn));
    workbench.session().lenses.clear();
    add(table, "brush",
        drag(
            [&](Session& session, double share) {
                session.selection.brushes = {vis::rangeBrush(
                    {{"T", at(heat, 0.4 + 0.3 * share), heat.hi, 0.02 * (heat.hi - heat.lo)}}, "bench")};
            },
            frames, workbench, paneDrawn));
    return table;
}

BenchTable benchScatter() {
    BenchTable table{"scatterplots of 62.5 million samples, 7 parameters", {"what", "ms"}, {}};
    const vis::HeadlessContext gl;
    vis::Renderer renderer{vis::RendererOptions{}};
    Jobs jobs;
    std::map<std::string, std::unique_ptr<ViewCache>> caches;
    Session session;
    const auto source = std::make_shared<ManySamples>();
    ViewContext context{session, source, renderer, jobs, caches};
    const std::vector<int> channels{0, 1, 2, 3, 4, 5, 6};
    const std::vector<Range> ranges(channels.size(), Range{-1.2, 1.2});
    StatisticsFeed feed;
    const auto wish = [&] { return makeWish(session, source->info(), channels, ranges, 96, true); };
    const auto [first, whole] = answered(feed, context, wish(), true);
    table.rows.push_back({"first picture", decimals(first, 0)});
    table.rows.push_back({"complete", decimals(whole, 0)});
    std::vector<double> moved;
    context.interacting = true;
    for (int step = 0; step < kSteps; ++step) {
        session.selection.brushes = {
            vis::rangeBrush({{"a", 0.1 + 0.05 * step, 1.2, 0.05}, {"b", -0.5, 0.5, 0.05}}, "")};
        moved.push_back(answered(feed, context, wish(), false).first);
    }
    table.rows.push_back({"brush dragged", decimals(median(moved), 0)});
    context.interacting = false;
    table.rows.push_back({"brush let go, complete", decimals(answered(feed, context, wish(), true).second, 0)});
    return table;
}

} // namespace tessera::app
