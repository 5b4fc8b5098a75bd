#include "app/views/transfer/library_page.h"

#include "app/data/library.h"
#include "app/pane/view_parts.h"
#include "app/ui/widgets.h"

#include <algorithm>
#include <cmath>
#include <imgui_stdlib.h>

namespace tessera::app {

namespace {

float gridGap() {
    return em() * 0.5f;
}

/// Lays cells out in rows that fill the width.
struct Grid {
    int columns, next = 0;

    void place() {
        if (next++ % columns != 0) ImGui::SameLine(0, gridGap());
    }
};

/// A picture with its name below; true when it was clicked. `texture` 0: its colours as a strip.
bool drawCell(const vis::TransferRecipe& recipe, const vis::TransferFunction& function, vis::TextureName texture,
              float side, bool chosen) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float line = ImGui::GetTextLineHeight(), strip = std::round(em() * 0.3f);
    const bool clicked = mouseArea(recipe.name.c_str(), {side, side + line + em() * 0.2f});
    const bool lit = ImGui::IsItemHovered() || ImGui::IsItemFocused();
    const std::string help = recipe.help.empty() ? recipe.name : recipe.name + "\n" + recipe.help;
    if (ImGui::IsItemHovered()) tooltip(help.c_str());
    if (!ImGui::IsItemVisible()) return clicked;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotColors colors = plotColors();
    const ImVec2 corner{at.x + side, at.y + side};
    draw.AddRectFilled(at, corner, colors.backdrop);
    if (texture != 0) draw.AddImage(textureId(texture), at, corner);
    drawColorStrip(draw, {at.x, corner.y - strip}, corner, function);
    draw.AddRect(at, corner, chosen ? colors.focus : lit ? colors.text : colors.frame, 0, 0, chosen ? 2.0f : 1.0f);
    const std::string name = fitText(recipe.name, side);
    draw.AddText({std::round(at.x + (side - ImGui::CalcTextSize(name.c_str()).x) / 2), corner.y + em() * 0.1f},
                 chosen || lit ? colors.text : colors.faint, name.c_str());
    return clicked;
}

/// Whether a channel was measured: by its unit, or as whole numbers.
bool isScan(const volume::DatasetInfo& info, const volume::Channel& channel) {
    return channel.unit == "HU" || info.parameters[std::size_t(channel.parameter)].type != volume::ScalarType::F32;
}

void say(ViewContext& context, const Error& error) {
    context.answers.messages.emplace_back(error.what());
}

void loadOwn(ViewContext& context, LibraryPage& page) {
    page.loaded = true;
    page.own = {};
    try {
        page.own = loadOwnFunctions(context.stateFolder);
        for (const std::string& text : page.own.messages) context.answers.messages.push_back(text);
    } catch (const Error& error) {
        say(context, error);
    }
}

/// The button that saves the function in use, with a popup that asks for its name.
void drawSaving(ViewContext& context, LibraryPage& page, const vis::TransferFunction& function,
                const vis::ValueDistribution& values, float side) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (ImGui::Button("##save", {side, side})) {
        page.name.clear();
        ImGui::OpenPopup("save function");
    }
    if (ImGui::IsItemHovered()) tooltip("Save the function in use under a name, for other data too");
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const char* label = "Save this...";
    const ImVec2 size = ImGui::CalcTextSize(label);
    draw.AddText({std::round(at.x + (side - size.x) / 2), std::round(at.y + (side - size.y) / 2)},
                 ImGui::GetColorU32(ImGuiCol_Text), label);
    if (!ImGui::BeginPopup("save function")) return;
    ImGui::TextUnformatted("Name of this function");
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(em() * 14);
    const bool entered = ImGui::InputText("##name", &page.name, ImGuiInputTextFlags_EnterReturnsTrue);
    const bool known = std::ranges::any_of(page.own.list, [&](const auto& own) { return own.name == page.name; });
    const bool named = page.name.find_first_not_of(" \t") != std::string::npos;
    ImGui::BeginDisabled(!named);
    const bool pressed = ImGui::Button(known ? "Replace" : "Save");
    ImGui::EndDisabled();
    if ((entered || pressed) && named) {
        try {
            const std::string kept = saveOwnFunction(context.stateFolder, vis::recipeOf(page.name, function, values));
            if (!kept.empty())
                context.answers.messages.push_back("transfer functions could not be read; kept as " + kept);
        } catch (const Error& error) {
            say(context, error);
        }
        page.loaded = false;
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

/// The context menu of a function of one's own.
void drawOwnMenu(ViewContext& context, LibraryPage& page, const std::string& name) {
    if (!ImGui::BeginPopupContextItem()) return;
    if (ImGui::MenuItem("Delete")) {
        try {
            deleteOwnFunction(context.stateFolder, name);
        } catch (const Error& error) {
            say(context, error);
        }
        page.loaded = false;
    }
    ImGui::EndPopup();
}

} // namespace

LibraryGrid libraryGrid(float room) {
    const float gap = gridGap(), half = (room - gap) / 2;
    const float side = std::floor(std::clamp(half < em() * 4 ? room : half, em(), em() * 6.5f));
    return {side, std::max(1, int((room + gap) / (side + gap)))};
}

void drawLibraryPage(ViewContext& context, LibraryPage& page, const std::string& function, int index) {
    const volume::DatasetInfo& info = context.source->info();
    const volume::Channel channel = info.channel(index);
    if (info.parameters[std::size_t(channel.parameter)].categorical)
        return drawHint("Labels", "The values of a label have colours of their own.");
    if (!page.loaded) loadOwn(context, page);
    const LibraryPage::Query query{index, info.nearestTime(context.session.time)};
    const auto values = page.values.get(
        context, context.source, {.key = "values " + function, .title = "Values", .quiet = true}, query,
        [](const auto& source, const LibraryPage::Query& asked, int, const Progress&) {
            return readDistribution(*source, asked.channel, asked.time);
        },
        [](const LibraryPage::Query& a, const LibraryPage::Query& b) { return a.channel == b.channel; });
    if (const std::string failure = page.values.failure(); !failure.empty() && !values)
        return drawHint("No values", failure.c_str());
    if (!values) return drawHint("Reading values");

    ImGui::BeginChild("library", {0, 0}, false);
    const auto [side, columns] = libraryGrid(ImGui::GetContentRegionAvail().x);
    page.pictures.begin(context, index, int(side));
    const auto cell = [&, side = side](Grid& grid, const vis::TransferRecipe& recipe) {
        grid.place();
        const vis::TransferFunction made = vis::madeFrom(recipe, *values, channel.unit);
        vis::TransferFunction& used = transferOf(context.session, function);
        if (drawCell(recipe, made, page.pictures.get(made), side, used == made)) used = made;
    };
    Grid shipped{columns}, own{columns};
    for (const bool scans : {isScan(info, channel), !isScan(info, channel)}) // the likelier ones first
        for (const vis::TransferRecipe& recipe : vis::transferLibrary())
            if (recipe.scan == scans && vis::suits(recipe, info.channelRange(channel))) cell(shipped, recipe);
    if (!context.stateFolder.empty()) {
        ImGui::TextDisabled("Your own");
        ImGui::PushID("own");
        for (const vis::TransferRecipe& recipe : std::vector<vis::TransferRecipe>(page.own.list)) {
            cell(own, recipe);
            drawOwnMenu(context, page, recipe.name);
        }
        own.place();
        drawSaving(context, page, transferOf(context.session, function), *values, side);
        ImGui::PopID();
    }
    page.pictures.work(context);
    ImGui::EndChild();
}

} // namespace tessera::app
