#include "app/views/compare/compare_values.h"

#include "vis/transfer/transfer_function.h"
#include "volume/derived/other_source.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr const char* kChannel = "difference"; // of volume::differenceSource

std::string firstChannel(const Session& session) {
    if (session.layers.empty()) return {};
    return vis::shownChannel(session.layers.front().technique);
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

CompareQuery compareQuery(const CompareSide& own, const CompareSide& reference) {
    return {own.source,       reference.source,      firstChannel(own.session), firstChannel(reference.session),
            own.session.time, reference.session.time};
}

void CompareValues::find(ViewContext& context, const std::string& jobKey, const CompareSide& own,
                         const CompareSide& reference) {
    found_ = query_.answer(
        context, std::shared_ptr<const void>(),
        {.key = jobKey, .title = "Difference of a variant", .quiet = true, .duringEdits = true},
        compareQuery(own, reference),
        [](const auto&, const CompareQuery& query, int, const Progress& progress) -> Found {
            const auto a = query.own->info().findChannel(query.channel),
                       b = query.reference->info().findChannel(query.referenceChannel);
            if (!a || !b) return {nullptr, "One of the variants does not have this parameter"};
            if (query.own == query.reference && *a == *b && query.time == query.referenceTime)
                return {nullptr, "The values are the same; only the pictures differ"};
            Found found;
            found.difference = attempt(found.failure, [&] {
                return volume::differenceSource(
                    {query.own, *a, volume::timesAround(query.own->info().times, query.time)},
                    {query.reference, *b, volume::timesAround(query.reference->info().times, query.referenceTime)},
                    progress);
            });
            return found;
        },
        [](const CompareQuery&, const CompareQuery&) { return true; });
    if (!query_.failure().empty()) found_ = nullptr;
}

bool CompareValues::draw(ViewContext& context, const Session& session, double top, glm::ivec2 size, bool moving) {
    if (!difference()) return false;
    if (!renderer_) renderer_ = context.renderer.another();
    if (drawnOf_ != found_->result.difference) {
        drawnOf_ = found_->result.difference;
        renderer_->setSource(drawnOf_);
    }
    if (!target_) target_ = renderer_->makeTarget();
    vis::FrameRequest request;
    request.size = size;
    request.moving = moving && !context.headless;
    request.wait = context.headless;
    vis::Scene scene = planes(session, drawnOf_->info().times.front(), top);
    scene.showBox = scene.showBox && context.decoration.box;
    if (context.whiteGround) scene.background = glm::vec3(1);
    request.budgetMs = double(scene.render.limits.frameTime);
    status_ = renderer_->render(*target_, scene, request);
    for (std::string& text : renderer_->takeMessages()) context.answers.messages.push_back(std::move(text));
    context.answers.follow(status_);
    return status_.complete || status_.milliseconds > 0;
}

std::string CompareValues::name() const {
    return difference() ? found_->query.channel : std::string();
}

std::string CompareValues::unit() const {
    return difference() ? difference()->info().parameters.front().unit : std::string();
}

double CompareValues::largest() const {
    if (!difference()) return 0;
    const Range range = difference()->info().parameters.front().ranges.front();
    return std::max(std::abs(range.lo), std::abs(range.hi));
}

} // namespace tessera::app
