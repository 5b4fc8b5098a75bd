#pragma once

#include "app/described/describe_json.h"
#include "app/session/session_types.h"

/// A session as JSON.
namespace tessera::app {

/// Layers of a session, or of a volume view, that are read: each is sampled along every ray, so that a thousand would
/// take minutes.
inline constexpr std::size_t kMostLayers = 100;

/// Reads a session document; issues that are more than unknown keys throw Error with the JSON path.
Session sessionFromJson(const Json& document, const std::string& file, std::vector<JsonIssue>* unknown = nullptr);

} // namespace tessera::app
