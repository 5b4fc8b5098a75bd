#include "app/history/animated_session.h"

#include "app/history/parameter_path.h"
#include "app/session/session.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace tessera::app {

namespace {

template <class T>
concept Numeric = std::is_arithmetic_v<T> || std::is_enum_v<T>;

struct Read {
    std::vector<double>& out;
    template <class T> void operator()(const T& value, const FieldInfo&) const {
        if constexpr (Numeric<T>) {
            out.push_back(double(value));
        } else if constexpr (detail::GlmLength<T>::value > 0) {
            for (int i = 0; i < detail::GlmLength<T>::value; ++i) out.push_back(double(value[i]));
        } else if constexpr (detail::IsQuat<T>::value) {
            out.insert(out.end(), {double(value.w), double(value.x), double(value.y), double(value.z)});
        } else if constexpr (std::is_same_v<T, Range>) {
            out.insert(out.end(), {value.lo, value.hi});
        }
    }
};

double within(double number, const FieldInfo& info) {
    return info.range ? std::clamp(number, info.range->lo, info.range->hi) : number;
}

struct Write {
    std::span<const double> in;
    bool& done;
    template <class T> void operator()(T& value, const FieldInfo& info) const {
        if (!std::all_of(in.begin(), in.end(), [](double number) { return std::isfinite(number); })) return;
        if constexpr (std::is_same_v<T, bool>) {
            if (in.size() != 1) return;
            value = in[0] >= 0.5;
        } else if constexpr (std::is_enum_v<T>) {
            if (in.size() != 1 || info.names.empty()) return;
            value = static_cast<T>(std::clamp(std::lround(in[0]), 0l, long(info.names.size()) - 1));
        } else if constexpr (std::is_integral_v<T>) {
            if (in.size() != 1) return;
            value = static_cast<T>(std::lround(std::clamp(within(in[0], info), -2e9, 2e9)));
        } else if constexpr (std::is_floating_point_v<T>) {
            if (in.size() != 1) return;
            value = static_cast<T>(within(in[0], info));
        } else if constexpr (detail::GlmLength<T>::value > 0) {
            if (in.size() != std::size_t(detail::GlmLength<T>::value)) return;
            for (std::size_t i = 0; i < in.size(); ++i)
                value[static_cast<typename T::length_type>(i)] =
                    static_cast<typename T::value_type>(within(in[i], info));
        } else if constexpr (detail::IsQuat<T>::value) {
            if (in.size() != 4) return;
            const glm::dquat turn(in[0], in[1], in[2], in[3]);
            if (!(glm::dot(turn, turn) > 0)) return; // no rotation at all
            value = T(glm::normalize(turn));
        } else if constexpr (std::is_same_v<T, Range>) {
            if (in.size() != 2) return;
            value = {in[0], in[1]};
        } else {
            return;
        }
        done = true;
    }
};

struct Kind {
    Between& between;
    template <class T> void operator()(const T&, const FieldInfo&) const {
        if constexpr (detail::IsQuat<T>::value)
            between = Between::Arc;
        else if constexpr (std::is_floating_point_v<T> || std::is_same_v<T, Range>)
            between = Between::Line;
        else if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>)
            between = Between::Line;
        else if constexpr (detail::GlmLength<T>::value > 0)
            between = Between::Line;
    }
};

} // namespace

std::vector<double> numbersAt(const Session& session, const std::string& path) {
    std::vector<double> numbers;
    visitParameter(session, path, Read{numbers});
    return numbers;
}

bool setNumbersAt(Session& session, const std::string& path, std::span<const double> numbers) {
    bool done = false;
    visitParameter(session, path, Write{numbers, done});
    return done;
}

Between betweenAt(const Session& session, const std::string& path) {
    Between between = Between::Nothing;
    visitParameter(session, path, Kind{between});
    return between;
}

void applyTracks(Session& session, double at) {
    const std::vector<Track> tracks = session.animation.tracks;
    for (const Track& track : tracks)
        if (!track.path.starts_with("/animation"))
            setNumbersAt(session, track.path, valueAt(track, at, betweenAt(session, track.path)));
}

bool setKey(Session& session, const std::string& path) {
    const std::vector<double> value = numbersAt(session, path);
    if (value.empty() || path.starts_with("/animation")) return false;
    std::vector<Track>& tracks = session.animation.tracks;
    auto track = std::find_if(tracks.begin(), tracks.end(), [&](const Track& each) { return each.path == path; });
    if (track == tracks.end()) track = tracks.insert(tracks.end(), Track{path, {}});
    const double at = session.animation.position;
    auto key =
        std::find_if(track->keys.begin(), track->keys.end(), [&](const Keyframe& each) { return each.at >= at; });
    if (key != track->keys.end() && key->at == at)
        key->value = value;
    else
        track->keys.insert(key, Keyframe{at, value});
    return true;
}

} // namespace tessera::app
