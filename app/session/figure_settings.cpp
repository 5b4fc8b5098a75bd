#include "app/session/figure_settings.h"

#include "volume/base/trimmed.h"

#include <algorithm>

namespace tessera::app {

std::string captionOf(const FigureSettings& settings, const std::string& name) {
    const std::string_view all = settings.captions;
    for (std::size_t from = 0; from < all.size();) {
        const std::size_t end = std::min(all.find(';', from), all.size());
        const std::string_view one = all.substr(from, end - from);
        const std::size_t equals = one.find('=');
        from = end + 1;
        if (equals == std::string_view::npos || volume::trimmed(one.substr(0, equals)) != name) continue;
        if (const std::string_view caption = volume::trimmed(one.substr(equals + 1)); !caption.empty())
            return std::string(caption);
    }
    return name;
}

} // namespace tessera::app
