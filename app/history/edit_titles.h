#pragma once

#include "app/described/describe_json.h"

#include <string>

/// Names of settings and edits as users read them.
namespace tessera::app {

struct Session;

/// A readable name for an edit, an RFC 6902 patch: "Layers 1: density".
std::string describePatch(const Json& patch);

/// The same in the words of the user, with the names that things have: "T surface: value", "brush hot: region",
/// "Slices: contours", "lens 2 added". `before`, `after`: the sessions around the edit.
std::string editTitle(const Json& patch, const Session& before, const Session& after);

/// "/layers/0/technique/density" -> "Layers 1: technique: density", with the name of the layer where it has one.
std::string pathTitle(const Session& session, const std::string& path);

} // namespace tessera::app
