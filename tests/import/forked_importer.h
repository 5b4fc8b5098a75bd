#pragma once

namespace tessera::volume {

/// How often a test program has started tessera-import (forked_importer.cpp).
struct Starts {
    int all = 0, ofTheProgram = 0;
};
Starts starts();

} // namespace tessera::volume
