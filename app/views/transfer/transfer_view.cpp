#include "app/pane/view_parts.h"
#include "app/queries/async_query.h"
#include "app/queries/derivative_query.h"
#include "app/queries/readout.h"
#include "app/session/own_functions.h"
#include "app/session/shown_scene.h"
#include "app/views/transfer/curve_page.h"
#include "app/views/transfer/library_page.h"
#include "app/views/transfer/transfer_controls.h"

namespace tessera::app {

namespace {

/// Bins of the gradients up to one range a cell, the largest there is, to find how high the plane must be.
constexpr int kFineGradients = 1024;

using AsyncDerivatives = AsyncQuery<DerivativesAtTime, DerivativeResult>;

struct TransferCache : ViewCache {
    AsyncDerivatives derivatives, everything{{.answers = 1}};
    CurvePage curve;
    RegionPage regions;
    BoundaryPage boundaries;
    LibraryPage library;
    std::string shown;                                 ///< function that the pages were last drawn for
    std::shared_ptr<const volume::BrickSource> source; ///< and data
};

using Derivatives = std::shared_ptr<const DerivativeResult>;

/// What the query counts at the session's time. `exact`: nothing, rather than an answer to another query of the
/// channel.
Derivatives derivatives(ViewContext& context, AsyncDerivatives& answers, const std::string& key,
                        const volume::DerivativeQuery& query, bool exact) {
    return answers.get(
        context, context.numbers, {.key = key, .title = "Gradients"},
        {query, volume::timesAround(context.source->info().times, context.session.time)},
        [](const auto& source, const DerivativesAtTime& asked, int, const Progress& progress) {
            return readDerivatives(source, asked, progress);
        },
        [exact](const DerivativesAtTime& a, const DerivativesAtTime& b) {
            return !exact && a.query.channel == b.query.channel;
        });
}

/// The pages that look at gradients: regions, or boundaries.
void drawGradientPages(ViewContext& context, TransferCache& cache, vis::TransferFunction& function, int channel,
                       const std::string& pane) {
    const volume::DatasetInfo& info = context.source->info();
    const Range range = vis::effectiveRange(function, info.channelRange(info.channel(channel)));
    if (!(range.hi > range.lo)) // NaN where all samples are absent
        return drawHint("One value only", "All gradients are zero.");
    const double width = range.hi - range.lo;
    const bool regions = function.kind == vis::TransferKind::Regions;
    if (regions && cache.regions.fit) {
        const volume::DerivativeQuery all{
            .channel = channel, .gradientBins = kFineGradients, .range = range, .gradientTop = width};
        fitRegions(cache.regions, function, derivatives(context, cache.everything, "all gradients " + pane, all, true));
        if (!cache.everything.failure().empty()) cache.regions.fit = false;
    }
    const volume::DerivativeQuery query{.channel = channel, .gradientTop = double(function.gradientTop) * width};
    const Derivatives result = derivatives(context, cache.derivatives, "gradients " + pane, query, false);
    if (const std::string failure = cache.derivatives.failure(); !failure.empty() && !result)
        return drawHint("No gradients", failure.c_str());
    if (regions)
        drawRegionPage(context, cache.regions, function, info, channel, result);
    else
        drawBoundaryPage(context, cache.boundaries, function, info, channel, result);
}

} // namespace

void drawTransferView(ViewContext& context, const std::string& pane, TransferView& view) {
    if (!context.source) {
        drawHint("No data", "Sets the colour and opacity of each parameter.");
        return;
    }
    const volume::DatasetInfo& info = context.source->info();
    const auto channelNow = [&] {
        const ShownScene scene(context.session, volumePane(context.session)); // has the layer selected
        const std::string shown = shownFunction(context.session, view);
        const auto own = ownFunction(context.session, shown);
        const std::string name = own ? own->channel : shown;
        return resolveChannel(info, context.session, name);
    };
    const auto channel = channelNow();
    if (!channel) {
        drawHint("No parameters", "This data set has no parameter to colour.");
        return;
    }
    TransferCache& cache = cacheOf<TransferCache>(context, pane);
    drawTransferControls(context, view, {cache.regions, cache.boundaries}, info, info.channel(*channel).name);
    const int now = channelNow().value_or(*channel);
    const volume::Channel shown = info.channel(now);
    const std::string name = functionName(context.session, view, shown.name);
    if (view.library) return drawLibraryPage(context, cache.library, name, now);
    vis::TransferFunction& function = transferOf(context.session, name);
    const bool regions = function.kind == vis::TransferKind::Regions;
    if (!regions && !view.boundaries) {
        drawCurvePage(context, cache.curve, view, function, now, sharedReadout(context).value(shown.name), pane);
        return;
    }
    if (cache.shown != name) { // drop the state of the other function
        cache.shown = name;
        cache.regions.drag = {};
        cache.boundaries.from.reset();
    }
    if (cache.source != context.numbers) { // other data: keep the curve until something is changed
        cache.source = context.numbers;
        cache.boundaries.from.reset();
    }
    drawGradientPages(context, cache, function, now, pane);
}

} // namespace tessera::app
