#pragma once

#include "app/history/parameter_path.h"
#include "app/session/session.h"
#include "app/ui/widgets.h"

#include <imgui.h>
#include <optional>
#include <string>
#include <vector>

/// Widgets of described values: of a whole struct, of a list of them, of one setting by its path.
namespace tessera::app {

/// Draws one member in a way of its own; false: it is to be drawn as any other.
using DrawMember = std::function<bool(Value member, const FieldInfo& field)>;

/// Draws a widget for each member that is not hidden and applies: first those without a group, then a section for each
/// group, folded at first. `own` is asked before each member of this struct. Returns true when one changed.
bool drawMembers(Value value, const WidgetContext& context, const DrawMember& own = {});
template <class T> bool drawDescribed(T& value, const WidgetContext& context) {
    return drawMembers(valueOf(value), context);
}

/// A section per element, with buttons to add and to remove.
bool drawList(const WidgetContext& context, const FieldInfo& info, Value list);
template <class T> bool drawDescribedList(const WidgetContext& context, const FieldInfo& info, std::vector<T>& values) {
    return drawList(context, info, valueOf(values));
}

/// A choice of presets; the one that equals `value` is selected.
bool choosePreset(const WidgetContext& context, Value value);
template <class T> bool drawPresets(const WidgetContext& context, T& value) {
    return choosePreset(context, valueOf(value));
}

/// Draws members of one struct.
struct MemberToWidget {
    const WidgetContext& outer;
    bool& changed;
    /// Range and unit of the parameter that the struct names, for members without a range of their own.
    std::optional<Range>& scale;
    std::string& unit;

    void operator()(Value value, const FieldInfo& field) const;

private:
    void draw(const WidgetContext& context, Value value, const FieldInfo& field) const;
    void drawText(const WidgetContext& context, Value value, const FieldInfo& field) const;
    void drawNumbers(const WidgetContext& context, Value value, FieldInfo field) const;
};

/// The widget of one parameter of a session, named by its JSON pointer; true when it changed. Draws nothing where there
/// is no such parameter or it is edited in a view alone.
bool drawParameter(Session& session, const std::string& path, const WidgetContext& context);

/// The widget of one parameter of any described value; true when it changed.
template <class T> bool drawMember(T& value, const std::string& path, const WidgetContext& context) {
    bool changed = false;
    std::optional<Range> scale;
    std::string unit;
    ImGui::PushID(path.c_str());
    visitParameter(value, path, MemberToWidget{context, changed, scale, unit});
    ImGui::PopID();
    return changed;
}

/// A list of the settings `paths` with a field to search it; true when one was chosen.
bool chooseParameter(const char* id, const Session& session, const std::vector<std::string>& paths, std::string& search,
                     std::string& path);

} // namespace tessera::app
