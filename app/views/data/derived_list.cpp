#include "app/views/data/derived_list.h"

#include "app/edits/show_parameter.h"
#include "app/pane/view_parts.h"
#include "app/ui/parameter_widget.h"
#include "app/ui/time_text.h"
#include "volume/base/unit_product.h"
#include "volume/derived/expression.h"
#include "volume/derived/formula_unit.h"
#include "volume/derived/other_source.h"

#include <algorithm>
#include <array>
#include <imgui_stdlib.h>

namespace tessera::app {

namespace {

/// Whether a formula can name a channel without back quotes.
bool plainName(const std::string& name) {
    return std::all_of(name.begin(), name.end(),
                       [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '.' || c == '|'; });
}

std::string unitOf(const volume::DatasetInfo& info, const std::string& channel) {
    const auto found = info.findChannel(channel);
    return found ? info.channel(*found).unit : "";
}

std::string differenceName(const volume::DatasetInfo& info, const volume::DifferenceRecipe& recipe) {
    return recipe.channel + " minus " + volume::timeText(recipe.reference(), info);
}

} // namespace

void followRecipe(volume::DerivedParameter& own, const volume::DerivedParameter& before,
                  const volume::DatasetInfo& info) {
    const auto *formula = std::get_if<volume::ExpressionRecipe>(&own.recipe),
               *former = std::get_if<volume::ExpressionRecipe>(&before.recipe);
    if (formula && former && *formula != *former && before.unit == volume::formulaUnit(former->formula, info))
        own.unit = volume::formulaUnit(formula->formula, info);
    const auto *is = std::get_if<volume::DifferenceRecipe>(&own.recipe),
               *was = std::get_if<volume::DifferenceRecipe>(&before.recipe);
    if (!is || !was || *is == *was) return;
    if (before.name == differenceName(info, *was)) own.name = differenceName(info, *is);
    if (before.unit == unitOf(info, was->channel)) own.unit = unitOf(info, is->channel);
}

namespace {

/// What a formula may contain.
const char* formulaHelp() {
    static const std::string help = [] {
        std::string text =
            "Parameters by name (special names in `back quotes`), x y z t, + - * / ^, comparisons, && ||, "
            "a ? b : c, _pi _e";
        for (const std::string& name : volume::formulaFunctions()) text += " " + name;
        return text + "; at another time: at(T, first), last, previous, next, at(T, 0.3)";
    }();
    return help.c_str();
}

void drawOne(ViewContext& context, DerivedDraft& draft, std::size_t index, int& removed) {
    volume::DerivedParameter& own = draft.parameters[index];
    const volume::DatasetInfo& info = context.source->info();
    const WidgetContext widgets{.info = &info};
    const std::string title = (own.name.empty() ? "unnamed" : own.name) + "   " +
                              (own.unit.empty() ? "" : own.unit + "   ") +
                              std::string(volume::kindOf(own.recipe).title) + "###one";
    const bool wrong = index < draft.problems.size() && !draft.problems[index].empty();
    if (wrong) ImGui::PushStyleColor(ImGuiCol_Text, palette().failure);
    const bool open =
        ImGui::TreeNodeEx(title.c_str(), ImGuiTreeNodeFlags_SpanAvailWidth | ImGuiTreeNodeFlags_DefaultOpen);
    if (wrong) ImGui::PopStyleColor();
    if (!open) return;
    drawLabel(widgets, "Name", "Name of the derived parameter");
    draft.edited |= ImGui::InputText("##name", &own.name);
    drawLabel(widgets, "Unit", "Unit of its values");
    draft.edited |= ImGui::InputText("##unit", &own.unit);
    const volume::DerivedParameter before = own;
    draft.edited |= std::visit([&](auto& recipe) { return drawDescribed(recipe, widgets); }, own.recipe);
    followRecipe(own, before, info);
    // Not while typing: it would cover the error message of the formula.
    if (std::holds_alternative<volume::ExpressionRecipe>(own.recipe) && ImGui::IsItemHovered() &&
        !ImGui::IsItemActive())
        tooltip(formulaHelp());
    if (wrong) {
        ImGui::PushStyleColor(ImGuiCol_Text, palette().failure);
        ImGui::TextWrapped("%s", draft.problems[index].c_str());
        ImGui::PopStyleColor();
    }
    if (ImGui::SmallButton("Remove")) removed = static_cast<int>(index);
    ImGui::TreePop();
}

/// The unit of a derivative in space: K/m of K, 1/s of m/s; K/length where no unit of lengths is stated.
std::string perLength(const volume::DatasetInfo& info, const std::string& unit) {
    const std::array<volume::UnitPower, 2> factors{{{unit, 1}, {info.lengthFactor(), -1}}};
    const volume::ComposedUnit composed = volume::composedUnit(factors);
    // m/s and mm do not cancel without a factor, which the values do not get.
    return composed.factor == 1 ? composed.unit : (unit.empty() ? "1" : unit) + "/" + info.lengthFactor();
}

/// The stated unit of a vector, or that of a velocity.
std::string unitOfVector(const volume::DatasetInfo& info, const std::string& name) {
    const auto found = std::ranges::find(info.parameters, name, &volume::Parameter::name);
    return found != info.parameters.end() && !found->unit.empty() ? found->unit : info.speedUnit();
}

} // namespace

volume::DerivedParameter newDerived(const volume::DatasetInfo& info, std::size_t kind, const std::string& channel) {
    volume::DerivedParameter made;
    made.recipe = volume::recipeOfKind(kind);
    const volume::DerivedKind& traits = volume::kindOf(made.recipe);
    std::string unit = unitOf(info, channel);
    std::vector<std::string> inputs;
    if (auto* const formula = std::get_if<volume::ExpressionRecipe>(&made.recipe)) {
        formula->formula = plainName(channel) ? channel : "`" + channel + "`";
        inputs = {channel};
    }
    std::visit(
        [&](auto& recipe) {
            volume::forEachInput(recipe, [&](std::string& name, bool isVector) {
                name = isVector ? firstVector(info) : channel;
                if (isVector) unit = unitOfVector(info, name);
                inputs.push_back(name);
            });
        },
        made.recipe);
    std::string base = std::string(traits.prefix) + (inputs.size() == 1 ? inputs.front() : "");
    if (const auto* difference = std::get_if<volume::DifferenceRecipe>(&made.recipe))
        base = differenceName(info, *difference);
    made.name = base;
    if (auto* const pieces = std::get_if<volume::PiecesRecipe>(&made.recipe))
        if (const auto of = info.findChannel(channel)) {
            const Range range = info.channelRange(info.channel(*of));
            pieces->value = 0.5 * (range.lo + range.hi);
        }
    const auto taken = [&](const std::string& name) {
        return info.findChannel(name).has_value() ||
               std::any_of(info.parameters.begin(), info.parameters.end(),
                           [&](const volume::Parameter& own) { return own.name == name; });
    };
    for (int i = 2; taken(made.name); ++i) made.name = base + " " + std::to_string(i);
    made.unit = traits.unit == volume::DerivedUnit::InputPerLength ? perLength(info, unit)
                : traits.unit == volume::DerivedUnit::Length       ? info.lengthUnit
                : traits.unit == volume::DerivedUnit::Time         ? info.timeUnit
                : traits.unit == volume::DerivedUnit::None         ? std::string()
                                                                   : unit;
    return made;
}

volume::DerivedParameter newDifference(const volume::DatasetInfo& info, const std::string& channel,
                                       const volume::TimeReference& from) {
    const volume::DifferenceRecipe recipe{channel, from.which, from.time};
    return {differenceName(info, recipe), unitOf(info, channel), recipe};
}

std::string showDifference(Session& session, const volume::DatasetInfo& info, const std::string& channel,
                           const volume::TimeReference& from) {
    const double before = session.time;
    const std::string name = addDerived(session, newDifference(info, channel, from));
    showParameter(session, name);
    const bool moved = leaveReference(session, info, from);
    return "New parameter: " + name +
           (moved ? ", shown at " + timeText(info, session.time) + ": at " + timeText(info, before) +
                        " there is no difference"
                  : "");
}

std::string addDerived(Session& session, const volume::DerivedParameter& wanted) {
    std::vector<volume::DerivedParameter>& derived = session.data.derived;
    for (const volume::DerivedParameter& own : derived)
        if (own.recipe == wanted.recipe) return own.name;
    derived.push_back(wanted);
    colorDifferences(session);
    return wanted.name;
}

namespace {

bool hasOther(const volume::DatasetInfo& info, const std::string& channel) {
    const auto found = info.findChannel(channel);
    return found && volume::otherChannel(info, *found).has_value();
}

/// The times that a parameter can be compared with.
void differenceItems(ViewContext& context, DerivedDraft& draft, const std::string& channel) {
    const volume::DatasetInfo& info = context.source->info();
    const auto item = [&](const std::string& label, const volume::TimeReference& from) {
        if (!ImGui::MenuItem((channel + " minus " + label).c_str())) return;
        showDifference(context.session, info, channel, from);
        // What is being typed is not given up for it.
        for (const volume::DerivedParameter& each : context.session.data.derived)
            if (std::ranges::find(draft.parameters, each) == draft.parameters.end()) draft.parameters.push_back(each);
    };
    if (info.times.size() > 1) {
        item("first", {volume::OtherTime::First});
        item("previous", {volume::OtherTime::Previous});
        item("last", {volume::OtherTime::Last});
        item("next", {volume::OtherTime::Next});
        const volume::TimeReference now{volume::OtherTime::Time, context.session.time};
        item(volume::timeText(now, info) + " (the time shown)", now);
        if (ImGui::BeginMenu((channel + " minus a time").c_str())) {
            for (const double time : info.times)
                item(volume::timeText({volume::OtherTime::Time, time}, info), {volume::OtherTime::Time, time});
            ImGui::EndMenu();
        }
    }
    if (hasOther(info, channel)) item("other data", {volume::OtherTime::Other});
}

/// The parameter shown minus other times, and a menu for each other one.
void drawDifferences(ViewContext& context, DerivedDraft& draft, const std::string& channel) {
    if (ImGui::SmallButton("Minus another time...")) ImGui::OpenPopup("minus another time");
    if (ImGui::IsItemHovered())
        tooltip("Show the difference between a parameter and its values at another time, as a new parameter");
    if (!ImGui::BeginPopup("minus another time")) return;
    const volume::DatasetInfo& info = context.source->info();
    differenceItems(context, draft, channel);
    ImGui::Separator();
    for (const volume::Channel& other : info.channels()) {
        const volume::Parameter& parameter = info.parameters[static_cast<std::size_t>(other.parameter)];
        if (other.name == channel || parameter.categorical || !ImGui::BeginMenu(other.name.c_str())) continue;
        differenceItems(context, draft, other.name);
        ImGui::EndMenu();
    }
    ImGui::EndPopup();
}

} // namespace

void drawDerivedList(ViewContext& context, DerivedDraft& draft) {
    std::vector<volume::DerivedParameter>& saved = context.session.data.derived;
    if (!ImGui::IsAnyItemActive()) {
        if (draft.edited) {
            saved = draft.parameters;
            colorDifferences(context.session);
        } else {
            draft.parameters = saved;
        }
        draft.edited = false;
    }
    if (draft.checked != draft.parameters || draft.problems.size() != draft.parameters.size()) {
        draft.problems = volume::derivedProblems(draft.parameters, volume::underived(context.source)->info());
        draft.checked = draft.parameters;
    }
    int removed = -1;
    for (std::size_t i = 0; i < draft.parameters.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        drawOne(context, draft, i, removed);
        ImGui::PopID();
    }
    if (removed >= 0) {
        draft.parameters.erase(draft.parameters.begin() + removed);
        draft.edited = true;
    }
    if (ImGui::SmallButton("Add...")) ImGui::OpenPopup("add derived");
    if (ImGui::IsItemHovered()) tooltip("Add a parameter computed from others; it is used like any other");
    const volume::DatasetInfo& info = context.source->info();
    const auto channel = resolveChannel(info, context.session, "");
    const std::string name = channel ? info.channel(*channel).name : "";
    if (channel && (info.times.size() > 1 || hasOther(info, name))) {
        ImGui::SameLine();
        drawDifferences(context, draft, name);
    }
    if (ImGui::BeginPopup("add derived")) {
        for (std::size_t kind = 0; kind < volume::kDerivedKinds; ++kind)
            if (ImGui::MenuItem(volume::kindOf(volume::recipeOfKind(kind)).title.data())) {
                draft.parameters.push_back(newDerived(info, kind, name));
                draft.edited = true;
            }
        ImGui::EndPopup();
    }
}

} // namespace tessera::app
