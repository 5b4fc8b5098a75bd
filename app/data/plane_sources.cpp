#include "app/data/plane_sources.h"

#include "app/data/picture_lattice.h"
#include "volume/sources/plane_source.h"

namespace tessera::app {

Sources cutByPlane(const Sources& whole, const DataRef& data) {
    const auto cut = [&](const std::shared_ptr<const volume::BrickSource>& source) {
        return volume::makePlaneSource(source, *data.timeAxis);
    };
    const auto numbers = cut(whole.numbers);
    NumberOrigin origin = whole.origin;
    origin.alongTime = true;
    origin.spaceOfPlane = whole.numbers;
    origin.parameters = int(numbers->info().parameters.size());
    return {drawnOn(whole.packed ? cut(whole.packed) : numbers, data.lattice), numbers, std::move(origin)};
}

std::optional<Sources> cutAgain(const Sources& shown, const DataRef& data, std::vector<std::string>& messages,
                                const Progress& progress) {
    if (!data.timeAxis || !shown.origin.spaceOfPlane || data.packed) return std::nullopt;
    const Sources whole(shown.origin.spaceOfPlane, shown.origin.spaceOfPlane, shown.origin);
    return deriveBoth(cutByPlane(whole, data), data.derived, messages, progress);
}

bool layoutCuts(const Session& layout, const DataRef& data, const volume::DatasetInfo& info) {
    return layout.data.timeAxis && !data.timeAxis && !info.plane && info.times.size() > 1;
}

} // namespace tessera::app
