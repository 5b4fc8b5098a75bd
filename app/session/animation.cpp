#include "app/session/animation.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace tessera::app {

double eased(Easing easing, double t) {
    switch (easing) {
    case Easing::Step:
        return t < 1 ? 0 : 1;
    case Easing::Linear:
        return t;
    case Easing::In:
        return t * t * t;
    case Easing::Out:
        return 1 - (1 - t) * (1 - t) * (1 - t);
    case Easing::InOut:
        return t < 0.5 ? 4 * t * t * t : 1 - 4 * (1 - t) * (1 - t) * (1 - t);
    }
    return t;
}

std::vector<double> valueAt(const Track& track, double at, Between between) {
    if (track.keys.empty()) return {};
    const auto next =
        std::find_if(track.keys.begin(), track.keys.end(), [&](const Keyframe& key) { return key.at > at; });
    if (next == track.keys.begin()) return next->value;
    const Keyframe& from = *(next - 1);
    if (next == track.keys.end() || between == Between::Nothing || from.value.size() != next->value.size())
        return from.value;
    const double share = eased(from.easing, (at - from.at) / (next->at - from.at));
    if (between == Between::Arc && from.value.size() == 4) {
        const auto rotation = [](const std::vector<double>& v) {
            return glm::normalize(glm::dquat(v[0], v[1], v[2], v[3]));
        };
        const glm::dquat turned = glm::slerp(rotation(from.value), rotation(next->value), share);
        return {turned.w, turned.x, turned.y, turned.z};
    }
    std::vector<double> out(from.value.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = from.value[i] + (next->value[i] - from.value[i]) * share;
    return out;
}

void removeKey(Animation& animation, std::size_t track, std::size_t key) {
    std::vector<Keyframe>& keys = animation.tracks[track].keys;
    keys.erase(keys.begin() + std::ptrdiff_t(key));
    if (keys.empty()) animation.tracks.erase(animation.tracks.begin() + std::ptrdiff_t(track));
}

std::size_t moveKey(Animation& animation, std::size_t track, std::size_t key, double at) {
    std::vector<Keyframe>& keys = animation.tracks[track].keys;
    Keyframe moved = keys[key];
    moved.at = std::clamp(at, 0.0, animation.duration);
    keys.erase(keys.begin() + std::ptrdiff_t(key));
    const auto before =
        std::find_if(keys.begin(), keys.end(), [&](const Keyframe& each) { return each.at >= moved.at; });
    return std::size_t(keys.insert(before, moved) - keys.begin());
}

} // namespace tessera::app
