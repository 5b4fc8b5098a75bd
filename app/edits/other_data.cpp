#include "app/edits/other_data.h"

#include "app/session/session_json.h"
#include "app/session/shown_scene.h"
#include "codec/container/json_text.h"

#include <algorithm>
#include <functional>

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

/// A variant that is another size of the layout's model is one of the model shown: settings that the layout's data have
/// are those of the data shown.
void keepSettings(Session& session, const DataRef& made) {
    if (!session.data.files.empty() || session.data.model != made.model) return;
    for (auto& [pane, view] : session.views) {
        auto* compare = std::get_if<CompareView>(&view);
        if (!compare) continue;
        for (CompareVariant& variant : compare->variants) {
            const auto found = variant.changes.find("/data/settings");
            if (found == variant.changes.end()) continue;
            Json settings = Json::parse(found->second, nullptr, false);
            if (!settings.is_object()) continue;
            for (const auto& [key, value] : made.settings) {
                const auto shown = session.data.settings.find(key);
                if (shown == session.data.settings.end())
                    settings.erase(key);
                else
                    settings[key] = shown->second;
            }
            found->second = jsonText(settings);
        }
    }
}

bool isField(const volume::DatasetInfo& info) {
    return std::ranges::any_of(info.parameters, [](const volume::Parameter& parameter) {
        return !parameter.categorical && parameter.type == volume::ScalarType::F32;
    });
}

/// Lenses stand in a row along the longest axis through the cross-hair, and lines of profiles along it: places in the
/// layout's data mean nothing here.
void movePlaces(Session& session, const volume::DatasetInfo& info, std::vector<std::string>& messages) {
    const glm::dvec3 size = info.bounds.size(), shown = size * session.stretch;
    const int axis = shown.x >= shown.y && shown.x >= shown.z ? 0 : shown.y >= shown.z ? 1 : 2;
    const auto stays = [](const vis::Lens& lens) { return lens.followsCursor; };
    const auto count = std::ranges::count_if(session.lenses, std::not_fn(stays));
    double number = 0.5;
    for (vis::Lens& lens : session.lenses) {
        if (stays(lens)) continue;
        lens.center = session.cursor;
        if (count > 1) lens.center[axis] = info.bounds.lo[axis] + size[axis] * number++ / double(count);
    }
    for (auto& [pane, view] : session.views)
        if (auto* const profile = std::get_if<ProfileView>(&view); profile && !profile->points.empty()) {
            profile->points.clear();
            messages.emplace_back("the line of a profile was drawn in other data; it goes along the longest axis here");
        }
}

} // namespace

void suitOtherData(Session& session, const volume::DatasetInfo& info, const DataRef& made,
                   std::vector<std::string>& messages) {
    dropForeignVariants(session, made, messages);
    keepSettings(session, made);
    if (session.data.files.empty() && session.data.model == made.model) return;
    movePlaces(session, info, messages);
    if (!onlyDrawings(session) || !isField(info)) return;
    for (auto& [pane, view] : session.views)
        if (auto* const volume = std::get_if<VolumeView>(&view)) volume->showBox = volume->drawingBox = true;
}

} // namespace tessera::app
