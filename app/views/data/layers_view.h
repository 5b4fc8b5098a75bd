#pragma once

#include <string>

namespace tessera::app {

/// A layer's name that is made of its parameter ("O2", "O2 slice", "Volume of O2") follows when another is chosen.
void followChannel(std::string& name, const std::string& before, const std::string& now);

} // namespace tessera::app
