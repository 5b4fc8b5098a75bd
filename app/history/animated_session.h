#pragma once

#include "app/session/animation.h"

#include <span>
#include <string>
#include <vector>

/// The settings of a session as numbers that keyframes hold.
namespace tessera::app {

struct Session;

/// The numbers of the parameter at a path: one per component, 0 or 1 for a switch, the index of a choice. Empty for
/// texts, lists and unknown paths.
std::vector<double> numbersAt(const Session& session, const std::string& path);
/// Sets them, rounded for integers and clamped to the parameter's range; returns false if not possible.
bool setNumbersAt(Session& session, const std::string& path, std::span<const double> numbers);
Between betweenAt(const Session& session, const std::string& path);

/// Keyframes of a session that do nothing, a sentence each: those of parameters that it lacks, and keys with another
/// number of components than their parameter.
std::vector<std::string> trackProblems(const Session& session);

/// Sets the keyed parameters to their values at `at` seconds. Ignores keyframes that do nothing (trackProblems).
void applyTracks(Session& session, double at);

/// Sets the key of a parameter at the animation's position to its present value; adds the track on first use. An
/// existing key keeps its easing. False where the parameter cannot be keyed.
bool setKey(Session& session, const std::string& path);

} // namespace tessera::app
