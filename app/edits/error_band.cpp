#include "app/edits/error_band.h"

#include "app/session/session_json.h"

#include <algorithm>
#include <array>
#include <string>

namespace tessera::app {

namespace {

constexpr float kBandOpacity = 0.28f;
constexpr const char* kBandNames[] = {" less its error bound", " plus its error bound"};

} // namespace

bool isOfErrorBand(const vis::Layer& layer) {
    return std::holds_alternative<vis::IsoLayer>(layer.technique) &&
           std::ranges::any_of(kBandNames, [&](const char* name) { return layer.name.ends_with(name); });
}

void showErrorBand(Session& session, std::size_t layer, double bound) {
    if (layer >= session.layers.size() || !(bound > 0) || isOfErrorBand(session.layers[layer])) return;
    const vis::Layer middle = session.layers[layer];
    const auto* const surface = std::get_if<vis::IsoLayer>(&middle.technique);
    if (!surface) return;
    const std::string base = middle.name.empty() ? surface->channel : middle.name;
    std::array<vis::Layer*, 2> former{};
    for (std::size_t side = 0; side < 2; ++side)
        for (vis::Layer& each : session.layers)
            if (isOfErrorBand(each) && each.name == base + kBandNames[side]) former[side] = &each;
    const auto made = [&](std::size_t side) {
        vis::Layer out = middle;
        out.name = base + kBandNames[side];
        out.visible = true;
        auto& own = std::get<vis::IsoLayer>(out.technique);
        own.value += side == 0 ? -bound : bound;
        own.opacity = kBandOpacity;
        return out;
    };
    const std::size_t needed = std::size_t(!former[0]) + std::size_t(!former[1]);
    if (session.layers.size() + needed > kMostLayers) return;
    for (std::size_t side = 0; side < 2; ++side)
        if (former[side]) *former[side] = made(side);
    for (std::size_t side = 0; side < 2; ++side)
        if (!former[side])
            session.layers.insert(session.layers.begin() + static_cast<std::ptrdiff_t>(layer) + 1, made(side));
}

} // namespace tessera::app
