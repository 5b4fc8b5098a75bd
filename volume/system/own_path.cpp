#include "volume/system/own_path.h"

#include <system_error>
#include <unistd.h>

namespace tessera {

std::filesystem::path programFolder() {
    std::error_code failed;
    return std::filesystem::read_symlink("/proc/self/exe", failed).parent_path();
}

std::string programBeside(const std::string& name) {
    const std::filesystem::path folder = programFolder();
    const std::string path = (folder / name).string();
    return !folder.empty() && access(path.c_str(), X_OK) == 0 ? path : std::string();
}

} // namespace tessera
