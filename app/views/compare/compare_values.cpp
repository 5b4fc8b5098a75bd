#include "app/views/compare/compare_values.h"

#include "app/queries/pending_wish.h"
#include "app/views/compare/compare_feed.h"
#include "vis/transfer/transfer_function.h"
#include "volume/base/error.h"
#include "volume/derived/other_source.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr const char* kChannel = "difference"; // of volume::differenceSource

std::string firstChannel(const Session& session) {
    if (session.layers.empty()) return {};
    return std::visit([](const auto& own) { return own.channel; }, session.layers.front().technique);
}

/// The planes through the cross-hair with nothing else, as the session looks at them.
vis::Scene planes(const Session& session, double time, double top) {
    vis::Scene scene = sceneOf(session);
    scene.layers.clear();
    for (const auto orientation : {vis::SliceOrientation::X, vis::SliceOrientation::Y, vis::SliceOrientation::Z})
        scene.layers.push_back({kChannel, true, vis::SliceLayer{.channel = kChannel, .orientation = orientation}});
    vis::TransferFunction function = vis::divergingFunction();
    function.autoRange = false;
    function.range = {-top, top};
    scene.transfer = {{kChannel, function}};
    scene.selection = {};
    scene.lenses.clear();
    scene.clips.clear();
    scene.time = time;
    return scene;
}

} // namespace

void CompareValues::find(ViewContext& context, const std::string& jobKey, const CompareSide& own,
                         const CompareSide& reference) {
    const Query query{
        own.source,       reference.source,      firstChannel(own.session), firstChannel(reference.session),
        own.session.time, reference.session.time};
    if (state_->answered == query || state_->wanted == query) {
        const bool running = !context.headless && context.jobs.running(jobKey);
        if (!(state_->answered == query) && !running) {
            state_->answered = query;
            state_->difference = nullptr;
            state_->failure = "cancelled";
        }
        context.busy = context.busy || !(state_->answered == query);
        return;
    }
    state_->wanted = query;
    const auto compute = [query](State& into, const Progress& progress) {
        into.difference = nullptr;
        into.failure.clear();
        const auto a = query.own->info().findChannel(query.channel),
                   b = query.reference->info().findChannel(query.referenceChannel);
        if (!a || !b) {
            into.failure = "One of them has no such parameter";
        } else if (query.own == query.reference && *a == *b && query.time == query.referenceTime) {
            into.failure = "The same values: the pictures differ only in how they are drawn";
        } else {
            into.difference = attempt(into.failure, [&] {
                return volume::differenceSource(
                    {query.own, *a, volume::timesAround(query.own->info().times, query.time)},
                    {query.reference, *b, volume::timesAround(query.reference->info().times, query.referenceTime)},
                    progress);
            });
        }
        into.answered = query;
    };
    if (context.headless) return compute(*state_, {});
    context.busy = true;
    context.jobs.start(
        jobKey, "Difference of a variant",
        [compute, query, weak = std::weak_ptr(state_)](const Progress& progress) -> Jobs::Finish {
            const auto made = std::make_shared<State>();
            compute(*made, progress);
            return [weak, made, query] {
                const auto to = weak.lock();
                if (!to || !(to->wanted == query)) return;
                to->difference = made->difference;
                to->failure = made->failure;
                to->answered = query;
            };
        },
        true);
}

bool CompareValues::draw(ViewContext& context, const Session& session, double top, glm::ivec2 size, bool moving) {
    if (!state_->difference) return false;
    if (!renderer_) renderer_ = std::make_unique<vis::Renderer>();
    if (drawnOf_ != state_->difference) {
        drawnOf_ = state_->difference;
        renderer_->setSource(drawnOf_);
    }
    if (!target_) target_ = renderer_->makeTarget();
    vis::FrameRequest request;
    request.size = size;
    request.moving = moving && !context.headless;
    request.wait = context.headless;
    const vis::Scene scene = planes(session, drawnOf_->info().times.front(), top);
    request.budgetMs = double(scene.render.limits.frameTime);
    status_ = renderer_->render(*target_, scene, request);
    for (std::string& text : renderer_->takeMessages()) context.messages.push_back(std::move(text));
    context.follow(status_);
    return status_.complete || status_.milliseconds > 0;
}

std::string CompareValues::name() const {
    return state_->answered && state_->difference ? state_->answered->channel : std::string();
}

std::string CompareValues::unit() const {
    return state_->difference ? state_->difference->info().parameters.front().unit : std::string();
}

double CompareValues::largest() const {
    if (!state_->difference) return 0;
    const Range range = state_->difference->info().parameters.front().ranges.front();
    return std::max(std::abs(range.lo), std::abs(range.hi));
}

double CompareFeed::findValues(ViewContext& context, const std::string& pane, std::size_t reference) {
    double top = 0;
    const CompareCell& against = *cells_[reference];
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        CompareCell& cell = *cells_[i];
        const auto &source = cell.source(context), &wanted = against.source(context);
        if (i == reference || !cell.failure.empty() || !against.failure.empty() || !source || !wanted) continue;
        cell.values.find(context, pane + ":values" + std::to_string(i), {cell.session, source},
                         {against.session, wanted});
        top = std::max(top, cell.values.largest());
    }
    return top > 0 ? top : 1;
}

} // namespace tessera::app
