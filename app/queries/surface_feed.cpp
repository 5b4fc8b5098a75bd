#include "app/queries/surface_feed.h"

#include "app/pane/view_parts.h"
#include "app/queries/pending_wish.h"
#include "volume/base/error.h"
#include "volume/bricks/source_at_time.h"
#include "volume/mesh/isosurface.h"

#include <algorithm>
#include <list>

namespace tessera::app {

namespace {

constexpr std::size_t kKeptTriangles = 20'000'000; ///< about 1 GB with the copy on the GPU
constexpr std::size_t kMovingTriangles = 400'000;  ///< more are slow on software GL
constexpr double kCoarseSamples = 5e5;             ///< extracted within a few milliseconds

/// What decides a shape; layers of equal wishes share one.
struct Wish {
    int channel = 0, colorBy = -1;
    volume::TimePair time;
    double value = 0;
    bool operator==(const Wish&) const = default;
};

struct Shape {
    Wish wish;
    int level = 0;
    std::shared_ptr<const vis::Geometry> geometry;
};

int firstLevel(const volume::BrickGrid& grid) {
    int level = 0;
    for (; level + 1 < grid.levels; ++level) {
        const glm::ivec3 size = grid.levelSamples(level);
        if (double(size.x) * size.y * size.z <= kCoarseSamples) break;
    }
    return level;
}

std::shared_ptr<const vis::Geometry> extract(const std::shared_ptr<const volume::BrickSource>& source, const Wish& wish,
                                             int level, const Progress& progress) {
    const volume::SourceAtTime shown = volume::sourceAt(source, wish.time);
    auto geometry = std::make_shared<vis::Geometry>();
    const double share = wish.colorBy < 0 ? 1 : 0.6;
    geometry->mesh =
        volume::extractIsosurface(*shown.source, wish.channel, shown.time, wish.value, level, progress.part(0, share));
    if (wish.colorBy >= 0)
        volume::sampleAtVertices(geometry->mesh, *shown.source, wish.colorBy, shown.time, level,
                                 progress.part(share, 1));
    return geometry;
}

std::optional<Wish> wishOf(const vis::IsoLayer& layer, const volume::DatasetInfo& info, const volume::TimePair& time) {
    const std::optional<int> channel = info.findChannel(layer.channel);
    if (!channel) return std::nullopt;
    Wish wish{*channel, -1, time, layer.value};
    if (!layer.colorBy.empty()) wish.colorBy = info.findChannel(layer.colorBy).value_or(-1);
    return wish;
}

} // namespace

struct SurfaceFeed::State {
    struct Asked {
        PendingWish<Wish> wish;
        int level = 0;
    };
    std::list<Shape> kept;             ///< most recent first
    std::map<std::size_t, Wish> shown; ///< by layer: the last wish that had a shape
    std::map<std::size_t, Asked> asked;
    std::shared_ptr<const volume::BrickSource> source;

    /// The shape of a wish, the finest or the coarsest one there is.
    const Shape* find(const Wish& wish, bool finest) const {
        const Shape* best = nullptr;
        for (const Shape& shape : kept)
            if (shape.wish == wish && (!best || (finest ? shape.level < best->level : shape.level > best->level)))
                best = &shape;
        return best;
    }
    void keep(Shape shape) {
        std::erase_if(kept, [&](const Shape& old) { return old.wish == shape.wish && old.level == shape.level; });
        kept.push_front(std::move(shape));
        std::size_t triangles = 0, count = 0;
        std::erase_if(kept, [&](const Shape& old) {
            triangles += old.geometry->mesh.triangles.size();
            return count++ >= 2 && triangles > kKeptTriangles;
        });
    }
};

SurfaceFeed::SurfaceFeed() : state_(std::make_shared<State>()) {}

std::shared_ptr<const vis::Geometry> extractLayer(const std::shared_ptr<const volume::BrickSource>& source,
                                                  const vis::IsoLayer& layer, const volume::TimePair& time, int level,
                                                  const Progress& progress) {
    const std::optional<Wish> wish = wishOf(layer, source->info(), time);
    return wish ? extract(source, *wish, level, progress) : nullptr;
}

std::vector<vis::GeometryLayer> SurfaceFeed::get(ViewContext& context, const std::string& pane, bool moving) {
    if (state_->source != context.source) {
        state_ = std::make_shared<State>(); // a job of the old source finds its state gone
        state_->source = context.source;
    }
    State& state = *state_;
    const volume::DatasetInfo& info = context.source->info();
    const volume::TimePair time = volume::timesAround(info.times, context.session.time);
    const int first = firstLevel(context.source->grid());
    std::vector<vis::GeometryLayer> out;
    for (std::size_t i = 0; i < context.session.layers.size(); ++i) {
        const vis::Layer& layer = context.session.layers[i];
        const auto* iso = std::get_if<vis::IsoLayer>(&layer.technique);
        if (!iso || !layer.visible || iso->method != vis::SurfaceMethod::Polygons) continue;
        const std::optional<Wish> wish = wishOf(*iso, info, time);
        if (!wish) continue;
        const Shape* here = state.find(*wish, true);
        const std::string job = pane + ":surface" + std::to_string(i);
        State::Asked& asked = state.asked[i];
        if (!asked.wish.refused(context.jobs, job, *wish) && (!here || here->level > 0)) {
            if (context.headless) {
                try {
                    state.keep({*wish, 0, extract(context.source, *wish, 0, {})});
                } catch (const Error& error) {
                    asked.wish.fail(*wish, error.what());
                }
            } else {
                context.busy = true;
                // A coarse shape is waited for though the wish moved on: else a drag would show none.
                const bool wait = asked.wish.running && (*asked.wish.running == *wish || asked.level == first);
                const bool enough = here && context.interacting;
                if (!wait && !enough) {
                    const int level = here ? 0 : first;
                    asked.wish.start(*wish);
                    asked.level = level;
                    context.jobs.start(
                        job, "Surface of " + iso->channel,
                        [weak = std::weak_ptr(state_), source = context.source, wish = *wish, level,
                         i](const Progress& progress) -> Jobs::Finish {
                            std::string failure;
                            const auto made = attempt(failure, [&] { return extract(source, wish, level, progress); });
                            return [weak, made, failure, wish, level, i] {
                                const auto owner = weak.lock();
                                if (!owner) return;
                                PendingWish<Wish>& own = owner->asked[i].wish;
                                if (!made) {
                                    own.fail(wish, failure);
                                    throw Error(failure);
                                }
                                own.answered();
                                owner->keep({wish, level, made});
                            };
                        },
                        level == first);
                }
            }
            here = state.find(*wish, true);
        }
        context.behind = context.behind || (!here && !asked.wish.failed);
        if (here)
            state.shown.insert_or_assign(i, *wish);
        else if (const auto last = state.shown.find(i); last != state.shown.end())
            here = state.find(last->second, true);
        if (!here) continue;
        if (moving && here->geometry->mesh.triangles.size() > kMovingTriangles) here = state.find(here->wish, false);
        out.push_back({.geometry = here->geometry,
                       .color = iso->color,
                       .channel = here->wish.colorBy >= 0 ? iso->colorBy : std::string(),
                       .opacity = iso->opacity,
                       .lens = layer.lens,
                       .transfer = layer.transfer,
                       .brushes = layer.brushes,
                       .look = iso->look});
    }
    return out;
}

} // namespace tessera::app
