#include "app/data/require_data.h"

#include "app/data/format.h"
#include "app/data/picture_session.h"
#include "app/history/session_file.h"
#include "codec/remote/address.h"
#include "volume/base/error.h"

#include <filesystem>

namespace tessera::app {

void requireData(const std::vector<std::string>& paths) {
    const bool alone = paths.size() == 1;
    for (const std::string& path : paths) {
        std::error_code unknown;
        if (codec::isRemote(path) || !std::filesystem::is_regular_file(path, unknown)) continue;
        if (!alone && codec::namesArchive(path))
            throw Error("is an archive, which is opened alone; tessera compare --with compares two data sets", path);
        if (hasEnding(path, ".tessera.json") || (hasEnding(path, ".json") && looksLikeSession(readText(path))))
            throw Error(alone ? "is a session, and data are expected here" : "is a session, which is opened alone",
                        path);
        if (alone && namesPicture(path) && holdsSession(path))
            throw Error("is a picture that contains a session, and data are expected here", path);
    }
}

} // namespace tessera::app
