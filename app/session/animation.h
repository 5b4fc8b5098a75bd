#pragma once

#include "volume/base/describe.h"

#include <string>
#include <string_view>
#include <vector>

/// Animation: the times of the data, or keyframes of any setting of a session.
namespace tessera::app {

enum class Loop { Once, Repeat, PingPong };
inline constexpr std::string_view kLoopNames[] = {"once", "repeat", "pingPong"};

/// Interpolation from one key to the next.
enum class Easing { Step, Linear, In, Out, InOut };
inline constexpr std::string_view kEasingNames[] = {"step", "linear", "in", "out", "inOut"};

struct Keyframe {
    double at = 0;             ///< s of the animation
    std::vector<double> value; ///< a number per component; a choice is its place in the list of names
    Easing easing = Easing::InOut;
    bool operator==(const Keyframe&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.at, FieldInfo{.key = "at",
                                 .doc = "Time of the animation at which the setting has this value",
                                 .unit = "s",
                                 .range = Range{0, 36000}});
        visit(self.value, FieldInfo{"value", "The value, one number per component"});
        visit(self.easing,
              FieldInfo{.key = "easing", .doc = "Interpolation up to the next key", .names = kEasingNames});
    }
};

/// The keys of one setting, in order of time.
struct Track {
    std::string path; ///< JSON pointer into the session, e.g. "/camera/distance"
    std::vector<Keyframe> keys;
    bool operator==(const Track&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.path, FieldInfo{"path", "Path of the setting in the session"});
        visit(self.keys, FieldInfo{"keys", "Values of the setting at times of the animation"});
    }
};

struct Animation {
    bool playing = false;
    float speed = 4; ///< time steps per second
    Loop loop = Loop::Repeat;
    double position = 0; ///< s, of the keyframes
    double duration = 5; ///< s
    float framesPerSecond = 25;
    std::vector<Track> tracks; ///< without any, the times of the data play
    bool operator==(const Animation&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.playing, FieldInfo{"playing", "The animation is playing"});
        visit(self.speed, FieldInfo{.key = "speed",
                                    .doc = "Stored times shown per second, without keyframes",
                                    .unit = "steps/s",
                                    .range = Range{0.1, 60},
                                    .logScale = true});
        visit(self.loop, FieldInfo{.key = "loop", .doc = "What playing does at the last time", .names = kLoopNames});
        visit(self.position, FieldInfo{.key = "position",
                                       .doc = "Time of the animation that is shown",
                                       .unit = "s",
                                       .range = Range{0, 36000}});
        visit(self.duration, FieldInfo{.key = "duration",
                                       .doc = "Length of the keyframe animation",
                                       .unit = "s",
                                       .range = Range{0.1, 36000},
                                       .logScale = true});
        visit(self.framesPerSecond, FieldInfo{.key = "framesPerSecond",
                                              .doc = "Frames per second of a recorded animation",
                                              .unit = "1/s",
                                              .range = Range{1, 120}});
        visit(self.tracks, FieldInfo{.key = "tracks", .doc = "Keyframes by setting", .hidden = true});
    }
};

/// Progress 0..1 after the share `t` of the time, both in [0, 1]; cubic polynomials (R. Penner, Motion, Tweening, and
/// Easing, 2002): in t^3, out 1 - (1 - t)^3, inOut half of either.
double eased(Easing easing, double t);

/// How a setting is interpolated between two values.
enum class Between { Nothing, Line, Arc };

/// A track's value: before its first key that of the first, after its last that of the last; empty without keys.
/// `Arc`: the four numbers (w, x, y, z) of a rotation turn along the shortest great circle.
std::vector<double> valueAt(const Track& track, double at, Between between);

/// Takes a key away, and its track with the last one.
void removeKey(Animation& animation, std::size_t track, std::size_t key);
/// Moves a key in time, within [0, duration] and kept in order; returns its new index.
std::size_t moveKey(Animation& animation, std::size_t track, std::size_t key, double at);

} // namespace tessera::app
