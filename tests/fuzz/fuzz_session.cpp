// Any bytes as a session file: an Error or a session whose history can be walked and which saves and loads again.
#include "app/history/session_file.h"
#include "volume/base/error.h"

#include <cstdint>
#include <cstdlib>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tessera::app;
    try {
        SessionDocument document = parseSession({reinterpret_cast<const char*>(data), size}, "fuzz");
        repair(document.session.dock, paneKeys(document.session));
        while (document.history.canUndo()) document.history.undo();
        while (document.history.canRedo()) document.history.redo();
        document.history.reset(document.session);
        const std::string text = printSession(document, "/tmp/fuzz.tessera.json");
        if (printSession(parseSession(text, "again"), "/tmp/fuzz.tessera.json") != text) std::abort();
    } catch (const tessera::Error&) {
    }
    return 0;
}
