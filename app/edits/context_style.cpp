#include "app/edits/context_style.h"

#include "app/session/session_json.h"

#include <algorithm>

namespace tessera::app {

namespace {

/// The parameter that a hull is a surface of: that of the first visible volume or surface.
std::string shownChannel(const Session& session, const volume::DatasetInfo& info) {
    for (const vis::Layer& layer : session.layers) {
        if (!layer.visible || layer.name == kHullLayer || !layer.lens.empty()) continue;
        const auto* volume = std::get_if<vis::VolumeLayer>(&layer.technique);
        const auto* iso = std::get_if<vis::IsoLayer>(&layer.technique);
        std::string name = volume ? volume->channel : iso ? iso->channel : std::string();
        if (!name.empty() && info.findChannel(name)) return name;
    }
    const auto channels = info.channels();
    return channels.empty() ? std::string() : channels.front().name;
}

/// The lowest value at which the opacity of a parameter reaches a tenth of its maximum.
double hullValue(const Session& session, const volume::DatasetInfo& info, const std::string& name) {
    const auto channel = info.findChannel(name);
    if (!channel) return 0;
    const auto found = session.transfer.find(name);
    const vis::TransferFunction function = found == session.transfer.end() ? vis::TransferFunction{} : found->second;
    const Range range = vis::effectiveRange(function, info.channelRange(info.channel(*channel)));
    constexpr int kSteps = 200;
    double most = 0;
    const auto opacity = [&](int i) { return vis::evaluate(function, {0, 1}, double(i) / kSteps).a; };
    for (int i = 0; i <= kSteps; ++i) most = std::max(most, opacity(i));
    for (int i = 1; i < kSteps; ++i)
        if (opacity(i - 1) < 0.1 * most && opacity(i) >= 0.1 * most)
            return range.lo + (range.hi - range.lo) * i / kSteps;
    return 0.5 * (range.lo + range.hi);
}

vis::Look lookOfStyle(ContextStyle style) {
    vis::Look look;
    if (style == ContextStyle::Silhouette)
        look.silhouette = vis::SilhouetteEnhancement{.retained = 0.01f, .strength = 2, .exponent = 3};
    if (style == ContextStyle::Wire) look.wire.emplace();
    if (style == ContextStyle::Drawn) look = *vis::Look::preset("tone");
    return look;
}

} // namespace

std::string_view contextStyleHelp(ContextStyle style) {
    static constexpr std::string_view kHelp[] = {
        "What is not brushed is nearly transparent and pale",
        "What is not brushed is translucent, without colour and darker",
        "What is not brushed is out of focus, as in a photograph",
        "What is not brushed is hidden",
        "The rest is drawn as the silhouette of its hull",
        "The rest is drawn as a translucent hull",
        "The rest is drawn as a wire-frame hull",
        "The rest is drawn as a hull in warm and cool tones",
    };
    static_assert(std::size(kHelp) == std::size(kContextStyleNames));
    return kHelp[static_cast<std::size_t>(style)];
}

std::optional<std::size_t> hullLayer(const Session& session) {
    const auto found = std::find_if(session.layers.begin(), session.layers.end(),
                                    [](const vis::Layer& layer) { return layer.name == kHullLayer; });
    if (found == session.layers.end() || !std::holds_alternative<vis::IsoLayer>(found->technique)) return std::nullopt;
    return static_cast<std::size_t>(found - session.layers.begin());
}

void setContextStyle(Session& session, const volume::DatasetInfo& info, ContextStyle style) {
    vis::Selection& selection = session.selection;
    const vis::Selection defaults;
    selection.contextOpacity = defaults.contextOpacity;
    selection.contextSaturation = defaults.contextSaturation;
    selection.contextLightness = defaults.contextLightness;
    selection.contextBlur = defaults.contextBlur;
    const std::optional<std::size_t> former = hullLayer(session);
    const bool hull = style >= ContextStyle::Silhouette;
    if (style == ContextStyle::Faint) selection.contextOpacity = 0.08f, selection.contextSaturation = 0.35f;
    if (style == ContextStyle::Grey)
        selection.contextOpacity = 0.3f, selection.contextSaturation = 0, selection.contextLightness = 0.75f;
    if (style == ContextStyle::Blurred)
        selection.contextOpacity = 0.3f, selection.contextSaturation = 0.4f, selection.contextBlur = 0.012f;
    if (style == ContextStyle::Hidden || hull) selection.contextOpacity = 0;
    if (!hull) {
        if (former) session.layers.erase(session.layers.begin() + static_cast<std::ptrdiff_t>(*former));
        return;
    }
    vis::IsoLayer surface;
    if (former) {
        surface = std::get<vis::IsoLayer>(session.layers[*former].technique);
    } else {
        surface.channel = shownChannel(session, info);
        surface.value = hullValue(session, info, surface.channel);
        surface.method = vis::SurfaceMethod::Polygons;
    }
    const bool dark = session.appearance.theme == Theme::Dark;
    surface.color = dark ? glm::vec3(0.72f, 0.78f, 0.88f) : glm::vec3(0.3f, 0.35f, 0.45f);
    surface.opacity = style == ContextStyle::Hull ? 0.14f : style == ContextStyle::Drawn ? 0.4f : 0.9f;
    surface.look = lookOfStyle(style);
    if (surface.look.wire && !dark) surface.look.wire->color = surface.color;
    vis::Layer layer{std::string(kHullLayer), true, surface};
    layer.brushes = vis::BrushEffect::None;
    if (former)
        session.layers[*former] = layer;
    else if (session.layers.size() < kMostLayers)
        session.layers.push_back(layer);
}

} // namespace tessera::app
