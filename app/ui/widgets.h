#pragma once

#include "app/described/describe_json.h"
#include "app/ui/ticks.h"
#include "volume/field/dataset.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Widgets for described structs: label to the left, control to the right, help as a tooltip, unit behind the number. A
/// widget function edits its value and returns whether it changed.
namespace tessera::app {

/// What widgets may offer as choices and scales.
struct WidgetContext {
    const volume::DatasetInfo* info = nullptr; ///< parameters to choose from; may be null
    float labelShare = 0.4f;                   ///< of the width
    std::string path = {};                     ///< of what is drawn, a JSON pointer into the session; "" = not in it
    const std::function<void(const std::string& path)>* menu =
        nullptr;                                   ///< called for a right click on a label with a path
    const std::function<void()>* browse = nullptr; ///< asks for a file for a text that names one

    WidgetContext at(std::string place) const {
        WidgetContext out = *this;
        out.path = std::move(place);
        return out;
    }
    WidgetContext under(std::string_view key) const {
        return at(path.empty() ? std::string() : path + "/" + std::string(key));
    }
};

/// A label in the left column with the help as a tooltip; the next item fills the rest of the line.
void drawLabel(const WidgetContext& context, std::string_view label, std::string_view help);

/// The unit for a setting of unit "m", a place in the data or a length there: one in which the data are of handy size.
LengthUnit dataLength(const WidgetContext& context);

/// The label of a setting: keyWords with a capital, "contextOpacity" -> "Context opacity".
std::string labelOf(std::string_view key);

bool drawBool(const WidgetContext& context, const FieldInfo& info, bool& value);
/// A slider where a range is known, else a field to drag or type in. `scale`: range of the parameter it refers to.
/// Several numbers stand side by side, with the unit in the label or fewer digits where there is little room, else
/// below each other; the whole is in a tooltip.
bool drawNumber(const WidgetContext& context, const FieldInfo& info, std::optional<Range> scale, double* values,
                int count, bool integer);
bool drawChoice(const WidgetContext& context, const FieldInfo& info, int& index);
/// Free text, a choice of parameter or colour map, or a file.
bool drawText(const WidgetContext& context, const FieldInfo& info, std::string& value);
bool drawTexts(const WidgetContext& context, const FieldInfo& info, std::vector<std::string>& values);
bool drawColor(const WidgetContext& context, const FieldInfo& info, float* rgb);
/// A choice of parameter without label. `emptyName` is offered for "" where given.
bool chooseChannel(const char* id, const volume::DatasetInfo* info, std::string& value,
                   const char* emptyName = nullptr);
/// A choice of vector parameter without label.
bool chooseVector(const char* id, const volume::DatasetInfo* info, std::string& value);
/// A choice of colour map, with a search and a strip of each, without label (app/ui/choose_colormap.cpp).
bool chooseColormap(const char* id, std::string& value, bool reversed = false);
bool beginSection(const char* id, std::string_view label, std::string_view help);
void endSection();
/// A small button that adds to a list or removes from it.
bool drawListButton(const char* label);
/// The text with line ends for a width in pixels, at spaces alone: ImGui would also break "a..b" between the dots. A
/// word wider than a line stays whole, as do the groups of digits of a number.
std::string wrappedAtSpaces(const std::string& text, float width);

template <class T> bool drawDescribed(T& value, const WidgetContext& context);

/// A section per element, with buttons to add and to remove.
template <class T> bool drawDescribedList(const WidgetContext& context, const FieldInfo& info, std::vector<T>& values) {
    bool changed = false;
    std::size_t removed = values.size();
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::string id = std::string(info.key) + std::to_string(i);
        if (!beginSection(id.c_str(), labelOf(info.key) + " " + std::to_string(i + 1), info.doc)) continue;
        changed |= drawDescribed(values[i], context.under(std::to_string(i)));
        if (drawListButton("Remove")) removed = i;
        endSection();
    }
    if (removed < values.size()) {
        values.erase(values.begin() + static_cast<std::ptrdiff_t>(removed));
        changed = true;
    }
    if (!drawListButton(("Add to " + std::string(info.key)).c_str())) return changed;
    values.emplace_back();
    return true;
}

/// A choice of presets; the one that equals `value` is selected.
template <class T> bool drawPresets(const WidgetContext& context, T& value) {
    static constexpr std::string_view kOwn = "own settings";
    std::vector<std::string_view> names(std::begin(T::kPresetNames), std::end(T::kPresetNames));
    const auto found = std::find_if(names.begin(), names.end(), [&](auto name) { return T::preset(name) == value; });
    int index = static_cast<int>(found - names.begin());
    if (found == names.end()) names.push_back(kOwn);
    const FieldInfo field{.key = "preset", .unit = "", .doc = "Presets to start from", .names = names};
    if (!drawChoice(context, field, index) || names[static_cast<std::size_t>(index)] == kOwn) return false;
    value = *T::preset(names[static_cast<std::size_t>(index)]);
    return true;
}

namespace detail {

struct MemberToWidget {
    const WidgetContext& outer;
    bool& changed;
    /// Range and unit of the parameter that the struct names, for members without a range of their own.
    std::optional<Range>& scale;
    std::string& unit;

    template <class T> void operator()(T& value, const FieldInfo& field) const {
        if (field.hidden) return;
        draw(outer.under(field.key), value, field);
    }

    template <class T> void draw(const WidgetContext& context, T& value, const FieldInfo& field) const {
        FieldInfo info = field;
        if (!info.range && info.unit.empty() && scale) info.unit = unit;
        if constexpr (std::is_same_v<T, bool>) {
            changed |= drawBool(context, info, value);
        } else if constexpr (std::is_enum_v<T>) {
            int index = static_cast<int>(value);
            if (drawChoice(context, info, index)) {
                value = static_cast<T>(index);
                changed = true;
            }
        } else if constexpr (std::is_same_v<T, std::string>) {
            changed |= drawText(context, info, value);
            if (info.refersTo == "channel" && context.info) {
                if (const auto index = context.info->findChannel(value)) {
                    const volume::Channel channel = context.info->channel(*index);
                    scale = context.info->channelRange(channel);
                    unit = channel.unit;
                }
            }
        } else if constexpr (std::is_same_v<T, std::vector<std::string>>) {
            changed |= drawTexts(context, info, value);
        } else if constexpr (std::is_arithmetic_v<T>) {
            double number = static_cast<double>(value);
            if (drawNumber(context, info, scale, &number, 1, std::is_integral_v<T>)) {
                value = static_cast<T>(number);
                changed = true;
            }
        } else if constexpr (std::is_same_v<T, Range>) {
            double ends[2] = {value.lo, value.hi};
            if (drawNumber(context, info, scale, ends, 2, false)) {
                value = {ends[0], ends[1]};
                changed = true;
            }
        } else if constexpr (GlmLength<T>::value > 0) {
            using V = typename T::value_type;
            if constexpr (GlmLength<T>::value == 3 && std::is_same_v<V, float>) {
                if (info.key.ends_with("olor")) {
                    changed |= drawColor(context, info, &value.x);
                    return;
                }
            }
            const LengthUnit length = info.unit == "m" ? dataLength(context) : LengthUnit{std::string(info.unit), 1};
            info.unit = length.name;
            double parts[4] = {}, before[4] = {};
            for (int i = 0; i < GlmLength<T>::value; ++i)
                parts[i] = before[i] = static_cast<double>(value[i]) * length.perUnit;
            if (drawNumber(context, info, {}, parts, GlmLength<T>::value, std::is_integral_v<V>)) {
                for (int i = 0; i < GlmLength<T>::value; ++i)
                    if (parts[i] != before[i]) value[i] = static_cast<V>(parts[i] / length.perUnit);
                changed = true;
            }
        } else if constexpr (Described<T>) {
            const std::string id(info.key);
            if (beginSection(id.c_str(), labelOf(info.key), info.doc)) {
                if constexpr (HasPresets<T>) changed |= drawPresets(context, value);
                changed |= drawDescribed(value, context);
                endSection();
            }
        } else if constexpr (IsVariant<T>::value) {
            changed |= std::visit([&](auto& alternative) { return drawDescribed(alternative, context); }, value);
        } else if constexpr (IsOptional<T>::value) {
            bool present = value.has_value();
            if (drawBool(context, info, present)) {
                if (present)
                    value.emplace();
                else
                    value.reset();
                changed = true;
            }
            if (value) draw(context, *value, info);
        } else if constexpr (IsVector<T>::value) {
            if constexpr (Described<typename T::value_type>) {
                changed |= drawDescribedList(context, info, value);
            }
        }
        // Maps and quaternions are edited in the views that know what they mean.
    }
};

} // namespace detail

/// Draws a widget for each member that is not hidden and applies; returns true when one changed.
template <class T> bool drawDescribed(T& value, const WidgetContext& context) {
    bool changed = false;
    std::optional<Range> scale;
    std::string unit;
    const detail::MemberToWidget draw{context, changed, scale, unit};
    T::describe(value, [&](auto& member, const FieldInfo& field) {
        if (field.applies) draw(member, field);
    });
    return changed;
}

} // namespace tessera::app
