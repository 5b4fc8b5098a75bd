#include "app/session/session_json.h"

#include "volume/base/error.h"

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
    return session;
}

} // namespace tessera::app
