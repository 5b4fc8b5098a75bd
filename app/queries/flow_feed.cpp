#include "app/queries/flow_feed.h"

#include "app/pane/view_parts.h"
#include "app/queries/pending_wish.h"
#include "vis/shapes/flow_geometry.h"
#include "volume/base/error.h"
#include "volume/bricks/source_at_time.h"

#include <algorithm>
#include <list>

namespace tessera::app {

namespace {

constexpr std::size_t kKept = 48, kKeptVertices = 10'000'000; ///< about 300 MB

/// What decides the geometry; how it is drawn is left out.
struct Wish {
    vis::FlowLayer layer;
    volume::TimePair time;
    glm::dvec3 stretch{1};
    vis::Selection brushes = {}; ///< of beginnings that follow them
    vis::LensSpace lenses = {};
    bool operator==(const Wish&) const = default;
};

Wish wishOf(const vis::FlowLayer& layer, volume::TimePair time, glm::dvec3 stretch) {
    const vis::FlowLayer drawn;
    // Pathlines go through all times; which one is shown decides where their particles are born.
    if (layer.kind == vis::FlowKind::Pathlines) time = {time.nearest(), time.nearest(), 0};
    Wish wish{layer, time, stretch};
    wish.layer.lineWidth = drawn.lineWidth;
    wish.layer.color = drawn.color;
    wish.layer.opacity = drawn.opacity;
    wish.layer.look = drawn.look;
    return wish;
}

std::shared_ptr<const vis::Geometry> makeWish(const std::shared_ptr<const volume::BrickSource>& source,
                                              const Wish& wish, const Progress& progress) {
    const volume::SourceAtTime shown = volume::sourceAt(source, wish.time);
    const vis::DoiFunction interest(wish.brushes, wish.lenses);
    return vis::makeFlow(*shown.source, wish.layer, shown.time, wish.stretch, progress, &interest);
}

struct Made {
    Wish wish;
    std::shared_ptr<const vis::Geometry> geometry; ///< null: there is nothing to show, or it failed
};

} // namespace

struct FlowFeed::State {
    std::list<Made> kept;              ///< most recent first
    std::map<std::size_t, Made> shown; ///< by layer: the last one made for it
    std::map<std::size_t, Wish> running;
    std::shared_ptr<const volume::BrickSource> source;

    const Made* find(const Wish& wish) const {
        const auto found = std::find_if(kept.begin(), kept.end(), [&](const Made& made) { return made.wish == wish; });
        return found == kept.end() ? nullptr : &*found;
    }
    void keep(Made made) {
        kept.push_front(std::move(made));
        std::size_t vertices = 0, count = 0;
        std::erase_if(kept, [&](const Made& old) {
            if (old.geometry) vertices += old.geometry->mesh.positions.size() + old.geometry->lines.positions.size();
            return count++ >= 2 && (vertices > kKeptVertices || count > kKept);
        });
    }
};

FlowFeed::FlowFeed() : state_(std::make_shared<State>()) {}

std::vector<vis::GeometryLayer> FlowFeed::get(ViewContext& context, const std::string& pane) {
    if (state_->source != context.source) {
        state_ = std::make_shared<State>(); // a job of the old source finds its state gone
        state_->source = context.source;
    }
    State& state = *state_;
    const Session& session = context.session;
    const volume::TimePair time = volume::timesAround(context.source->info().times, session.time);
    std::vector<vis::GeometryLayer> out;
    for (std::size_t i = 0; i < session.layers.size(); ++i) {
        const auto* flow = std::get_if<vis::FlowLayer>(&session.layers[i].technique);
        if (!flow || !session.layers[i].visible) continue;
        Wish wish = wishOf(*flow, time, session.stretch);
        if (flow->seedBrushed && session.selection.active()) {
            wish.brushes.brushes = session.selection.brushes;
            if (vis::selectsLens(session.selection)) wish.lenses = lensSpace(session, context.source->info());
        }
        const std::string job = pane + ":flow" + std::to_string(i);
        const Made* here = state.find(wish);
        if (!here && context.headless) {
            Made made{wish, nullptr};
            try {
                made.geometry = makeWish(context.source, wish, {});
            } catch (const Error&) { // shown without it
            }
            state.keep(made);
            here = state.find(wish);
        } else if (!here) {
            context.busy = context.behind = true;
            // One that is under way is waited for though the wish moved on: else a drag would show none.
            if (!state.running.contains(i) || !context.jobs.running(job)) {
                state.running.insert_or_assign(i, wish);
                context.jobs.start(
                    job, "Flow of " + flow->vector,
                    [weak = std::weak_ptr(state_), source = context.source, wish,
                     i](const Progress& progress) -> Jobs::Finish {
                        std::string failure;
                        const auto made = attempt(failure, [&] { return makeWish(source, wish, progress); });
                        return [weak, made, failure, wish, i] {
                            const auto owner = weak.lock();
                            if (!owner) return;
                            owner->running.erase(i);
                            owner->shown.insert_or_assign(i, Made{wish, made});
                            // A failure too is remembered, so that it is not tried again every frame.
                            owner->keep({wish, made});
                            if (!failure.empty()) throw Error(failure);
                        };
                    },
                    true);
            }
            if (const auto last = state.shown.find(i); last != state.shown.end()) here = &last->second;
        }
        if (!here || !here->geometry) continue;
        if (here != &state.shown[i]) state.shown[i] = *here;
        out.push_back({.geometry = here->geometry,
                       .color = flow->color,
                       .channel = here->wish.layer.channel,
                       .opacity = flow->opacity,
                       .lineWidth = flow->lineWidth,
                       .lens = session.layers[i].lens,
                       .transfer = session.layers[i].transfer,
                       .brushes = session.layers[i].brushes,
                       .look = flow->look});
    }
    return out;
}

} // namespace tessera::app
