// Any bytes as the user's file of transfer functions: an Error, or functions that can be drawn with and that are
// written and read again unchanged, entries that are none included.
#include "app/user_files/own_functions.h"
#include "volume/base/error.h"

#include <cstdint>
#include <cstdlib>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tessera;
    try {
        const app::OwnFunctions read = app::parseOwnFunctions({reinterpret_cast<const char*>(data), size}, "fuzz");
        const vis::ValueDistribution values{.range = {-3, 5}, .count = {9, 2, 0, 4}, .background = 0.25};
        for (const vis::TransferRecipe& recipe : read.list)
            for (const char* unit : {"", "HU"}) {
                const vis::TransferFunction made = vis::madeFrom(recipe, values, unit);
                for (std::size_t i = 1; i < made.opacity.size(); ++i)
                    if (!(made.opacity[i - 1].x <= made.opacity[i].x)) std::abort();
            }
        const std::string text = app::printOwnFunctions(read);
        const app::OwnFunctions again = app::parseOwnFunctions(text, "fuzz");
        if (app::printOwnFunctions(again) != text || again.list.size() != read.list.size()) std::abort();
    } catch (const Error&) {
    }
    return 0;
}
