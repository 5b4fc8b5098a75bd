#pragma once

#include "app/session/session.h"

#include <vector>

/// Playing through time, apart from its buttons.
namespace tessera::app {

/// Where playing stands between two stored times.
struct Playback {
    double steps = 0;  ///< share of the next step that has passed
    int direction = 1; ///< -1 on the way back of a ping-pong
    double waited = 0; ///< seconds that views have been waited for
};

/// Moves `time` on by `seconds` of playing: whole steps along `times` at animation.speed steps per second. At the end
/// it stops (playing becomes false), starts again or turns round, as animation.loop says. `behind`: views do not show
/// this time yet. They are waited for, but no longer than kLongestWait: times follow each other as fast as they can be
/// shown, rather than that some which are being read are passed over and read in vain.
inline constexpr double kLongestWait = 0.25; ///< seconds
void advance(Playback& playback, Animation& animation, double& time, const std::vector<double>& times, double seconds,
             bool behind = false);

/// Plays keyframes where the session has some: moves the position on by `seconds` and everything keyed with it; else
/// the times of the data, as above.
void playOn(Playback& playback, Session& session, const std::vector<double>& times, double seconds,
            bool behind = false);

} // namespace tessera::app
