#include "app/views/timeline/playback.h"

#include "app/history/animated_session.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

void advance(Playback& playback, Animation& animation, double& time, const std::vector<double>& times, double seconds,
             bool behind) {
    const int count = static_cast<int>(times.size());
    if (!animation.playing || count < 2) return;
    // A long pause (a hidden window, a debugger) must not skip times.
    playback.steps += std::min(seconds, 0.5) * static_cast<double>(animation.speed);
    if (behind && (playback.waited += seconds) < kLongestWait) return;
    if (!behind && playback.waited > 0) playback.steps = std::min(playback.steps, 1.0); // that is not made up for
    playback.waited = 0;
    int index = 0;
    for (int i = 1; i < count; ++i)
        if (std::abs(times[static_cast<std::size_t>(i)] - time) <
            std::abs(times[static_cast<std::size_t>(index)] - time))
            index = i;
    while (playback.steps >= 1 && animation.playing) {
        playback.steps -= 1;
        if (animation.loop != Loop::PingPong) playback.direction = 1;
        index += playback.direction;
        if (index >= 0 && index < count) continue;
        switch (animation.loop) {
        case Loop::Once:
            index = count - 1;
            animation.playing = false;
            playback.steps = 0;
            break;
        case Loop::Repeat:
            index = 0;
            break;
        case Loop::PingPong:
            playback.direction = -playback.direction;
            index += 2 * playback.direction;
            break;
        }
    }
    time = times[static_cast<std::size_t>(index)];
}

namespace {

/// Moves the position in the keyframes on; at the end it stops, starts again or turns round.
void advanceKeyframes(Playback& playback, Animation& animation, double seconds) {
    if (animation.loop != Loop::PingPong) playback.direction = 1;
    animation.position += playback.direction * std::min(seconds, 0.5);
    if (animation.position >= 0 && animation.position <= animation.duration) return;
    switch (animation.loop) {
    case Loop::Once:
        animation.position = animation.duration;
        animation.playing = false;
        break;
    case Loop::Repeat:
        animation.position = std::fmod(std::max(animation.position, 0.0), animation.duration);
        break;
    case Loop::PingPong:
        animation.position =
            std::clamp(playback.direction > 0 ? 2 * animation.duration - animation.position : -animation.position, 0.0,
                       animation.duration);
        playback.direction = -playback.direction;
        break;
    }
}

} // namespace

void playOn(Playback& playback, Session& session, const std::vector<double>& times, double seconds, bool behind) {
    Animation& animation = session.animation;
    if (!animation.playing) return;
    if (animation.tracks.empty()) return advance(playback, animation, session.time, times, seconds, behind);
    advanceKeyframes(playback, animation, seconds);
    applyTracks(session, animation.position);
}

} // namespace tessera::app
