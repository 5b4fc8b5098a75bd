#include "app/history/animated_session.h"

#include "app/history/parameter_path.h"
#include "app/session/session_types.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

double within(double number, const FieldInfo& info) {
    return info.range ? std::clamp(number, info.range->lo, info.range->hi) : number;
}

/// A number as a value of this kind may have it.
double fitting(double number, Value value, const FieldInfo& info) {
    switch (value.kind()) {
    case ValueKind::Flag:
        return number >= 0.5;
    case ValueKind::Choice:
        return double(std::clamp(std::lround(number), 0l, long(info.names.size()) - 1));
    case ValueKind::Number:
        return value.type->whole ? double(std::lround(std::clamp(within(number, info), -2e9, 2e9)))
                                 : within(number, info);
    case ValueKind::Vector:
        return within(number, info);
    default:
        return number;
    }
}

bool setNumbers(Value value, const FieldInfo& info, std::span<const double> in) {
    if (!std::all_of(in.begin(), in.end(), [](double number) { return std::isfinite(number); })) return false;
    if (value.type->numbers == 0 || in.size() != std::size_t(value.type->numbers)) return false;
    if (value.kind() == ValueKind::Choice && info.names.empty()) return false;
    double length = 1;
    if (value.kind() == ValueKind::Quaternion) {
        length = std::sqrt(in[0] * in[0] + in[1] * in[1] + in[2] * in[2] + in[3] * in[3]);
        if (!(length > 0)) return false; // no rotation at all
    }
    for (std::size_t i = 0; i < in.size(); ++i) value.setNumber(fitting(in[i] / length, value, info), int(i));
    return true;
}

} // namespace

std::vector<double> numbersAt(const Session& session, const std::string& path) {
    std::vector<double> numbers;
    visitParameter(session, path, [&](Value value, const FieldInfo&) {
        for (int i = 0; i < value.type->numbers; ++i) numbers.push_back(value.number(i));
    });
    return numbers;
}

bool setNumbersAt(Session& session, const std::string& path, std::span<const double> numbers) {
    bool done = false;
    visitParameter(session, path, [&](Value value, const FieldInfo& info) { done = setNumbers(value, info, numbers); });
    return done;
}

Between betweenAt(const Session& session, const std::string& path) {
    Between between = Between::Nothing;
    visitParameter(session, path, [&](Value value, const FieldInfo&) {
        if (value.kind() == ValueKind::Quaternion)
            between = Between::Arc;
        else if (value.kind() == ValueKind::Number || value.kind() == ValueKind::Range ||
                 value.kind() == ValueKind::Vector)
            between = Between::Line;
    });
    return between;
}

std::vector<std::string> trackProblems(const Session& session) {
    std::vector<std::string> problems;
    for (std::size_t i = 0; i < session.animation.tracks.size(); ++i) {
        const Track& track = session.animation.tracks[i];
        const std::string place = "/animation/tracks/" + std::to_string(i);
        const std::size_t components = numbersAt(session, track.path).size();
        if (components == 0 || track.path.starts_with("/animation")) {
            problems.push_back(place + ": keyframes of \"" + track.path +
                               "\" are ignored: this is no setting that keyframes can change");
            continue;
        }
        for (std::size_t k = 0; k < track.keys.size(); ++k)
            if (const std::size_t own = track.keys[k].value.size(); own != components)
                problems.push_back(place + "/keys/" + std::to_string(k) + ": the keyframe is ignored: it has " +
                                   std::to_string(own) + (own == 1 ? " number, " : " numbers, ") + track.path +
                                   " has " + std::to_string(components));
    }
    return problems;
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
