#include "app/edits/other_data.h"

#include "app/session/shown_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace tessera::app {

namespace {

/// Sizes and settings of a model do not apply to other data.
void dropForeignVariants(Session& session, const DataRef& made, std::vector<std::string>& messages) {
    if (made.model.empty() || (session.data.files.empty() && session.data.model == made.model)) return;
    for (auto& [pane, view] : session.views) {
        auto* compare = std::get_if<CompareView>(&view);
        if (!compare) continue;
        for (std::size_t i = compare->variants.size(); i-- > 0;) {
            const auto changes = [&, &variant = compare->variants[i]](std::string_view place) {
                return std::ranges::any_of(variant.changes,
                                           [&](const auto& change) { return change.first.starts_with(place); });
            };
            if (!changes("/data/settings") || changes("/data/model")) continue;
            messages.push_back("this comparison uses the model " + made.model + ": \"" + compare->variants[i].name +
                               "\" is skipped, as it needs that model");
            compare->variants.erase(compare->variants.begin() + static_cast<std::ptrdiff_t>(i));
            const auto before = [&](int index) { return std::max(0, index - (index > static_cast<int>(i) ? 1 : 0)); };
            compare->reference = before(compare->reference);
            compare->other = before(compare->other);
            if (compare->other == compare->reference) compare->other = compare->reference + 1;
        }
    }
}

/// Turns a camera that looks nearly along the length of a long body.
void lookAcross(vis::Camera& camera, const vis::WorldFrame& world) {
    constexpr double kLong = 2, kAlong = 0.6; // the longest edge by the next one; cosine of the angle to it
    const glm::dvec3 half = world.halfSize;
    int longest = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (half[axis] > half[longest]) longest = axis;
    if (half[longest] < kLong * std::max(half[(longest + 1) % 3], half[(longest + 2) % 3])) return;
    const glm::dvec3 back = glm::conjugate(glm::normalize(glm::dquat(camera.orientation))) * glm::dvec3(0, 0, 1);
    if (std::abs(back[longest]) > kAlong) camera.orientation = vis::firstOrientation(world);
}

bool isField(const volume::DatasetInfo& info) {
    return std::ranges::any_of(info.parameters, [](const volume::Parameter& parameter) {
        return !parameter.categorical && parameter.type == volume::ScalarType::F32;
    });
}

} // namespace

void suitOtherData(Session& session, const volume::DatasetInfo& info, const DataRef& made,
                   std::vector<std::string>& messages) {
    dropForeignVariants(session, made, messages);
    const vis::WorldFrame world = vis::worldFrame(info.bounds, session.stretch);
    lookAcross(session.camera, world);
    for (auto& [pane, view] : session.views) {
        auto* const volume = std::get_if<VolumeView>(&view);
        if (!volume) continue;
        if (volume->camera) lookAcross(*volume->camera, world);
        if (onlyDrawings(session) && isField(info)) volume->showBox = volume->drawingBox = true;
    }
}

} // namespace tessera::app
