#include "app/data/picture_session.h"

#include "app/drawing/embedded_session.h"
#include "app/history/session_file.h"
#include "vis/image/image_io.h"
#include "volume/base/error.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <optional>

namespace tessera::app {

namespace {

std::string pictureSuffix(const std::string& path) {
    std::string suffix = std::filesystem::path(path).extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return suffix == ".png" || suffix == ".svg" || suffix == ".pdf" ? suffix : "";
}

std::optional<std::string> sessionInPng(const std::string& path) {
    std::map<std::string, std::string> texts;
    (void)vis::readPng(path, &texts);
    const auto found = texts.find(vis::kSessionTextKey);
    return found == texts.end() ? std::nullopt : std::optional(found->second);
}

/// Whether the key of a session stands in a file, also where the session is damaged.
bool namesSession(const std::string& path) {
    try {
        return readText(path).find(vis::kSessionTextKey) != std::string::npos;
    } catch (const Error&) { // also of a picture that is too large to hold one
        return false;
    }
}

} // namespace

bool namesPicture(const std::string& path) {
    return !pictureSuffix(path).empty();
}

bool holdsSession(const std::string& path) {
    try {
        return !sessionTextOfPicture(path).empty();
    } catch (const Error&) {
        return false;
    }
}

bool opensAsPicture(const std::string& path) {
    const std::string suffix = pictureSuffix(path);
    return !suffix.empty() && (suffix != ".png" || namesSession(path));
}

std::string sessionTextOfPicture(const std::string& path) {
    const std::string suffix = pictureSuffix(path);
    const std::optional<std::string> session = suffix == ".svg"   ? sessionInSvg(readText(path))
                                               : suffix == ".pdf" ? sessionInPdf(readText(path), path)
                                                                  : sessionInPng(path);
    if (!session) throw Error("this picture contains no session", path);
    return *session;
}

} // namespace tessera::app
