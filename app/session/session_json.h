#pragma once

#include "app/described/describe_json.h"
#include "app/session/session.h"

/// A session as JSON. The templates are large: only session_json.cpp instantiates them.
namespace tessera::app {

extern template Json toJson(const Session& session);
extern template void fromJson(Session& session, const Json& json, std::vector<JsonIssue>& issues,
                              const std::string& path);

/// Reads a session document; issues that are more than unknown keys throw Error with the JSON path.
Session sessionFromJson(const Json& document, const std::string& file, std::vector<JsonIssue>* unknown = nullptr);

} // namespace tessera::app
