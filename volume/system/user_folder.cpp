#include "volume/system/user_folder.h"

#include <cstdlib>
#include <filesystem>

namespace tessera {

std::string userFolder(const char* variable, const char* underHome) {
    namespace fs = std::filesystem;
    const char* const stated = std::getenv(variable);
    const char* const home = std::getenv("HOME");
    fs::path folder;
    if (stated && *stated == '/')
        folder = fs::path(stated) / "tessera";
    else if (home && *home)
        folder = fs::path(home) / underHome / "tessera";
    else
        return {};
    std::error_code problem;
    fs::create_directories(folder, problem);
    return fs::is_directory(folder, problem) ? folder.string() : std::string();
}

} // namespace tessera
