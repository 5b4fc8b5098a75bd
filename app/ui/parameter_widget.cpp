#include "app/ui/parameter_widget.h"

#include "app/described/key_words.h"
#include "app/history/edit_titles.h"
#include "app/history/parameter_path.h"
#include "volume/base/data_units.h"

#include <algorithm>
#include <array>
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

/// Numbers of a value by the field that draws them; true when one changed.
bool drawNumberFields(const WidgetContext& context, const FieldInfo& info, const std::optional<Range>& scale,
                      double perUnit, Value value) {
    const int count = value.type->numbers;
    std::array<double, 4> parts{}, before{};
    for (int i = 0; i < count; ++i) parts[std::size_t(i)] = before[std::size_t(i)] = value.number(i) * perUnit;
    if (!drawNumber(context, info, scale, parts.data(), count, value.type->whole)) return false;
    for (int i = 0; i < count; ++i)
        if (parts[std::size_t(i)] != before[std::size_t(i)]) value.setNumber(parts[std::size_t(i)] / perUnit, i);
    return true;
}

} // namespace

void MemberToWidget::operator()(Value value, const FieldInfo& field) const {
    if (field.hidden) return;
    draw(outer.under(field.key), value, field);
}

void MemberToWidget::drawText(const WidgetContext& context, Value value, const FieldInfo& info) const {
    changed |= app::drawText(context, info, value.text());
    if (info.refersTo != "channel" || !context.info) return;
    if (const auto index = context.info->findChannel(value.text())) {
        const volume::Channel channel = context.info->channel(*index);
        scale = context.info->channelRange(channel);
        unit = channel.unit;
    }
}

void MemberToWidget::drawNumbers(const WidgetContext& context, Value value, FieldInfo info) const {
    if (value.kind() != ValueKind::Vector) {
        changed |= drawNumberFields(context, info, scale, 1, value);
    } else if (value.type->numbers == 3 && value.type->single && info.key.ends_with("olor")) {
        changed |= drawColor(context, info, &static_cast<glm::vec3*>(value.at)->x);
    } else {
        const LengthUnit length =
            info.unit == kUnitOfLengths ? dataLength(context) : LengthUnit{std::string(info.unit), 1};
        info.unit = length.name;
        changed |= drawNumberFields(context, info, {}, length.perUnit, value);
    }
}

void MemberToWidget::draw(const WidgetContext& context, Value value, const FieldInfo& field) const {
    FieldInfo info = field;
    if (!info.range && info.unit.empty() && scale) info.unit = unit;
    if (info.unit == kUnitOfTimes) info.unit = context.info ? std::string_view(context.info->timeUnit) : "";
    switch (value.kind()) {
    case ValueKind::Flag: {
        bool on = value.number() != 0;
        changed |= drawBool(context, info, on);
        value.setNumber(on);
        break;
    }
    case ValueKind::Choice: {
        int index = static_cast<int>(value.number());
        if (!drawChoice(context, info, index)) break;
        value.setNumber(index);
        changed = true;
        break;
    }
    case ValueKind::Text:
        drawText(context, value, info);
        break;
    case ValueKind::Number:
    case ValueKind::Range:
    case ValueKind::Vector:
        drawNumbers(context, value, info);
        break;
    case ValueKind::Struct: {
        const std::string id(info.key);
        if (!beginSection(id.c_str(), labelOf(info.key), info.doc)) break;
        if (!value.type->presets.empty()) changed |= choosePreset(context, value);
        changed |= drawMembers(value, context);
        endSection();
        break;
    }
    case ValueKind::Variant:
        changed |= drawMembers(value.inside(), context);
        break;
    case ValueKind::Optional: {
        bool present = value.inside().at != nullptr;
        if (drawBool(context, info, present)) {
            present ? value.type->emplace(value.at) : value.type->clear(value.at);
            changed = true;
        }
        if (value.inside().at) draw(context, value.inside(), info);
        break;
    }
    case ValueKind::List:
        if (value.type->elementType().kind == ValueKind::Text)
            changed |= drawTexts(context, info, *static_cast<std::vector<std::string>*>(value.at));
        else if (value.type->elementType().kind == ValueKind::Struct)
            changed |= drawList(context, info, value);
        break;
    case ValueKind::Map:
    case ValueKind::Quaternion:
        break; // edited in the views that know what they mean
    }
}

bool drawMembers(Value value, const WidgetContext& context, const DrawMember& own) {
    bool changed = false;
    std::optional<Range> scale;
    std::string unit;
    const MemberToWidget draw{context, changed, scale, unit};
    std::vector<std::string_view> groups;
    const auto drawGroup = [&](std::string_view group) {
        value.visitMembers([&](Value member, const FieldInfo& field) {
            if (field.applies && field.group == group && !(own && own(member, field))) draw(member, field);
        });
    };
    value.visitMembers([&](Value, const FieldInfo& field) {
        const bool shown = field.applies && !field.hidden && !field.group.empty();
        if (shown && std::ranges::find(groups, field.group) == groups.end()) groups.push_back(field.group);
    });
    drawGroup("");
    for (const std::string_view group : groups) {
        if (!beginSection(("group " + std::string(group)).c_str(), group, "")) continue;
        drawGroup(group);
        endSection();
    }
    return changed;
}

bool drawList(const WidgetContext& context, const FieldInfo& info, Value list) {
    bool changed = false;
    const std::size_t size = list.size();
    std::size_t removed = size;
    for (std::size_t i = 0; i < size; ++i) {
        const std::string id = std::string(info.key) + std::to_string(i);
        if (!beginSection(id.c_str(), labelOf(oneOf(info.key)) + " " + std::to_string(i + 1), info.doc)) continue;
        changed |= drawMembers(list.element(i), context.under(std::to_string(i)));
        if (drawListButton("Remove")) removed = i;
        endSection();
    }
    if (removed < size) {
        list.type->erase(list.at, removed);
        changed = true;
    }
    if (!drawListButton(("Add " + oneOf(info.key)).c_str())) return changed;
    list.type->resize(list.at, list.size() + 1);
    openSection((std::string(info.key) + std::to_string(size - (removed < size ? 1 : 0))).c_str());
    return true;
}

bool choosePreset(const WidgetContext& context, Value value) {
    static constexpr std::string_view kOwn = "own settings";
    std::vector<std::string_view> names(value.type->presets.begin(), value.type->presets.end());
    const auto found =
        std::find_if(names.begin(), names.end(), [&](auto name) { return value.type->isPreset(value.at, name); });
    int index = static_cast<int>(found - names.begin());
    if (found == names.end()) names.push_back(kOwn);
    const FieldInfo field{.key = "preset", .doc = "Presets to start from", .names = names};
    if (!drawChoice(context, field, index) || names[static_cast<std::size_t>(index)] == kOwn) return false;
    value.type->setPreset(value.at, names[static_cast<std::size_t>(index)]);
    return true;
}

bool drawParameter(Session& session, const std::string& path, const WidgetContext& context) {
    // Values of a layer run over the range of its channel.
    std::optional<Range> scale;
    std::string unit;
    if (context.info)
        visitParameter(session, path.substr(0, path.rfind('/')) + "/channel", [&](Value name, const FieldInfo&) {
            if (name.kind() != ValueKind::Text) return;
            if (const auto index = context.info->findChannel(name.text())) {
                const volume::Channel channel = context.info->channel(*index);
                scale = context.info->channelRange(channel);
                unit = channel.unit;
            }
        });
    bool changed = false;
    ImGui::PushID(path.c_str());
    visitParameter(session, path, MemberToWidget{context, changed, scale, unit});
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
