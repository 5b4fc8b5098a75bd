#include "app/ui/parameter_widget.h"

#include "app/history/edit_titles.h"
#include "app/history/parameter_path.h"

#include <algorithm>
#include <cctype>
#include <imgui.h>
#include <imgui_stdlib.h>

namespace tessera::app {

namespace {

/// Whether `text` holds all words of `search`, in any case.
bool matches(std::string text, std::string search) {
    const auto lower = [](std::string& word) {
        std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
    };
    lower(text), lower(search);
    std::size_t begin = 0;
    while (begin < search.size()) {
        const std::size_t end = std::min(search.find(' ', begin), search.size());
        if (text.find(search.substr(begin, end - begin)) == std::string::npos) return false;
        begin = end + 1;
    }
    return true;
}

} // namespace

bool drawParameter(Session& session, const std::string& path, const WidgetContext& context) {
    // Values of a layer run over the range of its channel.
    std::optional<Range> scale;
    std::string unit;
    if (context.info)
        visitParameter(session, path.substr(0, path.rfind('/')) + "/channel",
                       [&]<class T>(const T& name, const FieldInfo&) {
                           if constexpr (std::is_same_v<T, std::string>)
                               if (const auto index = context.info->findChannel(name)) {
                                   const volume::Channel channel = context.info->channel(*index);
                                   scale = context.info->channelRange(channel);
                                   unit = channel.unit;
                               }
                       });
    bool changed = false;
    ImGui::PushID(path.c_str());
    visitParameter(session, path, detail::MemberToWidget{context, changed, scale, unit});
    ImGui::PopID();
    return changed;
}

bool chooseParameter(const char* id, const Session& session, const std::vector<std::string>& paths, std::string& search,
                     std::string& path) {
    ImGui::PushID(id);
    // Menus fit their contents, so the width is set here.
    const float width = ImGui::GetFontSize() * 22;
    ImGui::SetNextItemWidth(width);
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    ImGui::InputTextWithHint("##search", "Search a setting", &search);
    bool chosen = false;
    if (ImGui::BeginChild("list", {width, ImGui::GetFontSize() * 12}, true)) {
        for (const std::string& each : paths) {
            const std::string title = pathTitle(session, each);
            if (!matches(title + " " + each, search)) continue;
            if (ImGui::Selectable((title + "##" + each).c_str(), each == path)) {
                path = each;
                chosen = true;
            }
        }
    }
    ImGui::EndChild();
    ImGui::PopID();
    return chosen;
}

} // namespace tessera::app
