#pragma once

#include "app/session/animation.h"

#include <span>

/// The settings of a session as numbers that keyframes hold.
namespace tessera::app {

struct Session;

/// The numbers of the parameter at a path: one per component, 0 or 1 for a switch, the index of a choice. Empty for
/// texts, lists and unknown paths.
std::vector<double> numbersAt(const Session& session, const std::string& path);
/// Sets them, rounded for integers and clamped to the parameter's range; returns false if not possible.
bool setNumbersAt(Session& session, const std::string& path, std::span<const double> numbers);
Between betweenAt(const Session& session, const std::string& path);

/// Sets the keyed parameters to their values at `at` seconds. Ignores tracks of parameters that the session lacks.
void applyTracks(Session& session, double at);

/// Sets the key of a parameter at the animation's position to its present value; adds the track on first use. An
/// existing key keeps its easing. False where the parameter cannot be keyed.
bool setKey(Session& session, const std::string& path);

} // namespace tessera::app
