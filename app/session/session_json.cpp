#include "app/session/session_json.h"

#include "app/session/shown_scene.h"
#include "volume/base/error.h"

#include <utility>

namespace tessera::app {

Session sessionFromJson(const Json& document, const std::string& file, std::vector<JsonIssue>* unknown) {
    Session session;
    std::vector<JsonIssue> issues;
    app::fromJson(session, document, issues);
    std::string more;
    const JsonIssue* first = nullptr;
    int bad = 0;
    for (const JsonIssue& issue : issues) {
        if (issue.unknownKey) {
            if (unknown) unknown->push_back(issue);
            continue;
        }
        if (!first) first = &issue;
        ++bad;
    }
    if (first) {
        if (bad > 1) more = " (and " + std::to_string(bad - 1) + " more)";
        throw Error(first->reason + more, file, first->path.empty() ? "/" : first->path);
    }
    for (const std::vector<vis::Layer>* layers : layerLists(std::as_const(session)))
        if (layers->size() > kMostLayers)
            throw Error("has " + std::to_string(layers->size()) + " layers, more than " + std::to_string(kMostLayers) +
                            " are not drawn",
                        file, "/layers");
    return session;
}

} // namespace tessera::app
