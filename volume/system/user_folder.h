#pragma once

#include <string>

namespace tessera {

/// The folder "tessera" in one of the user's folders, made if need be: in that which the environment variable
/// `variable` names (XDG_STATE_HOME, XDG_CACHE_HOME), else in `underHome` of the home folder. "" when there is none.
std::string userFolder(const char* variable, const char* underHome);

} // namespace tessera
