#pragma once

#include "app/described/describe_json.h"
#include "app/session/session_types.h"

/// A session as JSON.
namespace tessera::app {

/// Reads a session document; issues that are more than unknown keys throw Error with the JSON path.
Session sessionFromJson(const Json& document, const std::string& file, std::vector<JsonIssue>* unknown = nullptr);

} // namespace tessera::app
