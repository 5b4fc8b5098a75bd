#pragma once

#include "app/session/animation.h"

#include <span>

/// The settings of a session as numbers that keyframes hold.
namespace tessera::app {

struct Session;

/// The numbers of the parameter at a path: one per component, 0 or 1 for a switch, the place of a choice. Empty for
/// what has none (texts, lists) and where there is no such parameter.
std::vector<double> numbersAt(const Session& session, const std::string& path);
/// Sets them, rounded for whole numbers and kept within the parameter's range; false where that is not possible.
bool setNumbersAt(Session& session, const std::string& path, std::span<const double> numbers);
Between betweenAt(const Session& session, const std::string& path);

/// Puts the session where its tracks are at `at` seconds. Tracks of parameters that it does not have are left alone.
void applyTracks(Session& session, double at);

/// Sets the key of a parameter at the animation's position to its present value; adds the track on first use. An
/// existing key keeps its easing. False where the parameter cannot be keyed.
bool setKey(Session& session, const std::string& path);

} // namespace tessera::app
