#include "app/data/apply_layout.h"
#include "app/queries/statistics_query.h"
#include "bench/data/enlarged_cell.h"
#include "bench/pictures/timed_workbench.h"
#include "volume/sources/memory_source.h"

#include <chrono>
#include <cmath>
#include <map>
#include <thread>

/// Latency of linked views while something is dragged, and of a scatterplot matrix of many samples.
namespace tessera::app {

namespace {

using Clock = std::chrono::steady_clock;
constexpr int kSteps = 9; // steps of a drag; the median is reported

double milliseconds(Clock::time_point since) {
    return std::chrono::duration<double, std::milli>(Clock::now() - since).count();
}

/// The lens layout on that cell.
Opened shown() {
    Opened opened;
    opened.source = volume::makeMemorySource(enlargedCell({64, 64, 256}, 24), {.lattice = volume::LatticeKind::BCC});
    DataRef data;
    data.model = "fuel-cell";
    opened.document.session =
        applyLayout(loadSession(findLayout("lens")), opened.source->info(), data, opened.messages);
    opened.document.history.reset(opened.document.session);
    return opened;
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
            bricks_[std::size_t(key.channel) * kKinds + std::size_t(key.index.x + key.index.y + key.index.z) % kKinds];
        const glm::ivec3 size = grid_.brickSamples(key.index, key.level);
        volume::BrickSamples out{.size = size, .values = {}, .present = {}};
        out.values.resize(std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z));
        std::size_t to = 0;
        for (int z = 0; z < size.z; ++z)
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x)
                    out.values[to++] = from[((std::size_t(z) << key.level) * 64 + (std::size_t(y) << key.level)) * 64 +
                                            (std::size_t(x) << key.level)];
        return out;
    }

private:
    static constexpr int kKinds = 8;
    volume::DatasetInfo info_;
    volume::BrickGrid grid_;
    std::vector<std::vector<float>> bricks_; ///< by channel and kind
};

/// Milliseconds until the first answer to a query at any level, and until the exact one.
std::pair<double, double> answered(AsyncStatistics& answers, ViewContext& context, const BrushedQuery& query,
                                   bool whole) {
    const Clock::time_point begin = Clock::now();
    double first = -1;
    for (;;) {
        context.jobs.collect();
        const auto result = answers.get(context, "bench", query);
        if (result && result->query == query) {
            if (first < 0) first = milliseconds(begin);
            if (!whole || result->statistics.level == 0) return {first, milliseconds(begin)};
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

} // namespace

BenchTable benchLink() {
    BenchTable table{"link", {"dragged", "view", "ms drawing", "ms until shown"}, {}};
    TimedWorkbench timed;
    timed.workbench().install(shown());
    const volume::Box box = timed.workbench().source()->info().bounds;
    const Range heat = [&] {
        const volume::DatasetInfo& info = timed.workbench().source()->info();
        return info.channelRange(info.channel(info.findChannel("T").value()));
    }();
    const auto at = [](Range range, double share) { return range.lo + share * (range.hi - range.lo); };

    const auto measure = [&](const std::string& what, const std::function<void(Session&, double)>& edit) {
        timed.drag(edit).addTo(table, what);
    };
    measure("cursor",
            [&](Session& session, double share) { session.cursor = box.lo + box.size() * (0.3 + 0.4 * share); });
    measure("lens", [&](Session& session, double share) {
        session.lenses.front().center = box.lo + box.size() * (0.3 + 0.4 * share);
    });
    timed.session().lenses.clear();
    measure("brush", [&](Session& session, double share) {
        session.selection.brushes = {
            vis::rangeBrush({{"T", at(heat, 0.4 + 0.3 * share), heat.hi, 0.02 * (heat.hi - heat.lo)}}, "bench")};
    });
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
    AsyncStatistics answers;
    const auto query = [&] { return brushedQuery(session, source->info(), channels, ranges, 96, true); };
    const auto [first, whole] = answered(answers, context, query(), true);
    table.rows.push_back({"first picture", decimals(first, 0)});
    table.rows.push_back({"complete", decimals(whole, 0)});
    std::vector<double> moved;
    context.interacting = true;
    for (int step = 0; step < kSteps; ++step) {
        session.selection.brushes = {
            vis::rangeBrush({{"a", 0.1 + 0.05 * step, 1.2, 0.05}, {"b", -0.5, 0.5, 0.05}}, "")};
        moved.push_back(answered(answers, context, query(), false).first);
    }
    table.rows.push_back({"brush dragged", decimals(median(moved), 0)});
    context.interacting = false;
    table.rows.push_back(
        {"complete after release of the brush", decimals(answered(answers, context, query(), true).second, 0)});
    return table;
}

} // namespace tessera::app
