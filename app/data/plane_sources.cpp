#include "app/data/plane_sources.h"

#include "app/data/picture_lattice.h"
#include "app/ui/ticks.h"
#include "volume/base/error.h"
#include "volume/sources/plane_source.h"

#include <variant>

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

Sources cutIfMet(const Sources& whole, const DataRef& data, std::vector<std::string>& messages) {
    try {
        volume::planeOf(whole.numbers->info(), *data.timeAxis);
    } catch (const Error& error) {
        messages.push_back(error.reason() + ": the data are shown as they are");
        return whole;
    }
    return cutByPlane(whole, data);
}

void tellTimeDirection(const std::vector<volume::DerivedParameter>& derived, const volume::DatasetInfo& info,
                       std::vector<std::string>& messages) {
    if (!info.timeAxis()) return;
    std::string names;
    for (const volume::DerivedParameter& each : derived)
        if (std::holds_alternative<volume::GradientRecipe>(each.recipe) ||
            std::holds_alternative<volume::DivergenceRecipe>(each.recipe) ||
            std::holds_alternative<volume::VorticityRecipe>(each.recipe))
            names += (names.empty() ? "" : ", ") + each.name;
    if (names.empty()) return;
    messages.push_back(names + ": along one axis, which is time, 1 " +
                       (info.lengthUnit.empty() ? "of length" : info.lengthUnit) + " stands for " +
                       formatQuantity(info.plane->timePerLength, info.timeUnit));
}

bool layoutCuts(const Session& layout, const DataRef& data, const volume::DatasetInfo& info) {
    return layout.data.timeAxis && !data.timeAxis && !info.plane && info.times.size() > 1;
}

std::optional<volume::TimeAxis> planeOfLayout(const Session& layout, const volume::DatasetInfo& info,
                                              std::vector<std::string>& messages) {
    volume::TimeAxis plane = layout.data.timeAxis.value();
    const glm::dvec3 size = info.bounds.size();
    if (!(size[int(plane.axis)] > 0)) {
        const int longest = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        plane.axis = static_cast<volume::SpaceAxis>(longest);
    }
    try {
        volume::planeOf(info, plane);
        return plane;
    } catch (const Error& error) {
        messages.push_back("The plane of the layout cannot be shown: " + error.reason() +
                           ". The data are shown as they are.");
        return std::nullopt;
    }
}

} // namespace tessera::app
