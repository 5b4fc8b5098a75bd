#include "app/queries/extreme_query.h"

#include "app/queries/statistics_query.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/values/place_text.h"
#include "app/values/selection_text.h"
#include "volume/base/error.h"
#include "volume/bricks/source_at_time.h"
#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <numeric>

namespace tessera::app {

std::string textOf(const ExtremeQuestion& question, const Session& session, const volume::DatasetInfo& info) {
    std::string text = (question.greatest ? "maximum of " : "minimum of ") + question.channel;
    const std::string selected = selectionName(session);
    if (question.of != ExtremeOf::All)
        text += " in " + (question.of == ExtremeOf::Selected ? selected : restName(selected));
    if (const auto label = volume::labelChannel(info); question.region && label)
        text += (question.of == ExtremeOf::All ? " in " : ", ") +
                volume::labelName(volume::parameterOf(info, *label), *question.region);
    return text + (question.everyTime ? " over all times" : "");
}

std::optional<ExtremePlace> findExtreme(const std::shared_ptr<const volume::BrickSource>& source,
                                        const Session& session, const ExtremeQuestion& question,
                                        const Progress& progress) {
    const volume::DatasetInfo& info = source->info();
    const auto channel = info.findChannel(question.channel);
    if (!channel) throw Error("the data have no parameter of this name", "parameter", question.channel);
    volume::ExtremeQuery query{.channel = *channel, .greatest = question.greatest, .times = {}};
    if (question.region) {
        query.label = volume::labelChannel(info).value_or(-1);
        query.region = *question.region;
    }
    if (question.of != ExtremeOf::All) {
        const BrushedQuery brushed = brushedQuery(session, info, {}, {}, 1, false);
        query.doiChannels = brushed.channels;
        query.doi = samplesQuery(brushed, info, 0).doi;
        if (question.of == ExtremeOf::Rest && query.doi)
            query.doi = [doi = query.doi](std::span<const float> values, glm::dvec3 at) {
                return doi(values, at) < 0.5 ? 1.0 : 0.0;
            };
    }
    volume::SourceAtTime shown{source, 0};
    query.times.resize(info.times.size());
    std::iota(query.times.begin(), query.times.end(), 0);
    if (!question.everyTime) {
        shown = volume::sourceAt(source, volume::timesAround(info.times, session.time));
        query.times = {shown.time};
    }
    const auto found = volume::findExtreme(*shown.source, query, progress);
    if (!found) return std::nullopt;
    return ExtremePlace{found->value, found->position,
                        question.everyTime ? info.times[std::size_t(found->time)] : session.time};
}

std::string textOf(const ExtremePlace& place, const ExtremeQuestion& question, const volume::DatasetInfo& info) {
    const auto channel = info.findChannel(question.channel);
    const Range range = channel ? info.channelRange(info.channel(*channel)) : Range{0, 0};
    const std::string text =
        formatQuantity(place.value, channel ? info.channel(*channel).unit : "", (range.hi - range.lo) / 10000) +
        " at " + pointText(info, place.position, 1e-3);
    return info.times.size() > 1 ? text + ", " + timeText(info, place.time) : text;
}

} // namespace tessera::app
