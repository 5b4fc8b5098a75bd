#include "app/edits/open_worth.h"
#include "app/pages/table_page.h"
#include "app/pane/plot.h"
#include "app/pane/view_parts.h"
#include "app/queries/async_query.h"
#include "app/ui/widgets.h"
#include "app/views/worth/worth_data.h"
#include "volume/bricks/brick_source.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

struct WorthCache : ViewCache {
    AsyncQuery<WorthQuestion, volume::WorthFindings> answers;
};

constexpr std::array kWorthTitles{"views worth opening", "what else is different", "when it changes"};

void chooseList(ToolRow& tools, WorthSeeingView& view) {
    if (!tools.next(em() * 11)) return;
    ImGui::SetNextItemWidth(em() * 11);
    if (ImGui::BeginCombo("##list", kWorthTitles[std::size_t(view.list)])) {
        for (std::size_t i = 0; i < kWorthTitles.size(); ++i)
            if (ImGui::Selectable(kWorthTitles[i], std::size_t(view.list) == i)) view.list = WorthList(i);
        ImGui::EndCombo();
    } else if (ImGui::IsItemHovered()) {
        tooltip("Views worth opening; how parameters, regions and times of the selection differ from the rest; or the "
                "times of greatest change");
    }
}

void chooseSelected(ToolRow& tools, const Session& session, WorthSeeingView& view) {
    if (view.list == WorthList::WhatElse || !session.selection.active()) return;
    if (!tools.next(checkboxWidth("in the selection"))) return;
    ImGui::Checkbox("in the selection", &view.selected);
    if (ImGui::IsItemHovered()) tooltip("Look only at what is selected");
}

/// A density, a histogram of all with that of a part over it, or a curve over the times.
void drawPicture(ImDrawList& draw, const volume::WorthPicture& picture, ImVec2 lo, ImVec2 hi) {
    const PlotColors colors = plotColors();
    const float width = hi.x - lo.x, height = hi.y - lo.y;
    draw.AddRectFilled(lo, hi, colors.backdrop);
    const auto faded = [](ImU32 color, float share) {
        ImVec4 rgba = ImGui::ColorConvertU32ToFloat4(color);
        rgba.w *= share;
        return ImGui::ColorConvertFloat4ToU32(rgba);
    };
    if (picture.side > 0) {
        const float w = width / float(picture.side), h = height / float(picture.side);
        for (int y = 0; y < picture.side; ++y)
            for (int x = 0; x < picture.side; ++x) {
                const float density = picture.all[std::size_t(y * picture.side + x)];
                if (density <= 0) continue;
                const ImVec2 at{lo.x + w * float(x), hi.y - h * float(y + 1)};
                draw.AddRectFilled(at, {at.x + w, at.y + h}, faded(colors.bars, 0.35f + 0.65f * density));
            }
    } else if (picture.mark >= 0) {
        const float step = width / float(std::max<std::size_t>(1, picture.all.size()));
        const auto at = [&](std::size_t i) {
            return ImVec2{lo.x + step * (float(i) + 0.5f), hi.y - 1 - (height - 3) * picture.all[i]};
        };
        for (std::size_t i = 1; i < picture.all.size(); ++i)
            if (!std::isnan(picture.all[i - 1]) && !std::isnan(picture.all[i])) // gaps where there is nothing
                draw.AddLine(at(i - 1), at(i), colors.bars, std::max(1.0f, em() * 0.1f));
        if (std::size_t(picture.mark) < picture.all.size())
            draw.AddCircleFilled(at(std::size_t(picture.mark)), em() * 0.22f, colors.focus);
    } else {
        const float w = width / float(std::max<std::size_t>(1, picture.all.size()));
        const auto bars = [&](const std::vector<float>& heights, ImU32 color) {
            for (std::size_t i = 0; i < heights.size(); ++i)
                if (heights[i] > 0)
                    draw.AddRectFilled({lo.x + w * float(i), hi.y - (height - 2) * heights[i]},
                                       {lo.x + w * float(i + 1), hi.y}, color);
        };
        bars(picture.all, faded(colors.bars, 0.8f));
        bars(picture.part, faded(colors.focus, 0.75f));
    }
    draw.AddRect(lo, hi, colors.frame);
}

/// One row: rank, picture, sentence, and below it what stands behind its numbers. True if it was clicked.
bool drawRow(std::size_t rank, const volume::WorthPicture& picture, const std::string& finding,
             const std::string& numbers, bool open) {
    const float pad = em() * 0.35f, side = em() * 3.2f, left = em() * 1.9f;
    const float width = ImGui::GetContentRegionAvail().x, text = left + side * 1.35f + em() * 0.7f;
    const float wrap = std::max(em() * 6, width - text - pad);
    const std::string sentence = wrappedAtSpaces(finding, wrap), evidence = wrappedAtSpaces(numbers, wrap);
    const ImVec2 lines = ImGui::CalcTextSize(sentence.c_str()), below = ImGui::CalcTextSize(evidence.c_str());
    const float height = std::max(side, lines.y + below.y) + 2 * pad;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::PushID(static_cast<int>(rank));
    const bool clicked = ImGui::Selectable("##row", false, 0, {0, height});
    ImGui::PopID();
    if (open && ImGui::IsItemHovered()) tooltip("Click: opens the view that shows it, with its brush, place and time");
    if (!ImGui::IsItemVisible()) return clicked;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotColors colors = plotColors();
    draw.AddText({at.x + pad, at.y + pad}, colors.faint, std::to_string(rank).c_str());
    const ImVec2 lo{at.x + left, at.y + pad};
    drawPicture(draw, picture, lo, {lo.x + side * 1.35f, lo.y + side});
    draw.AddText({at.x + text, at.y + pad}, colors.text, sentence.c_str());
    draw.AddText({at.x + text, at.y + pad + lines.y}, colors.faint, evidence.c_str());
    return clicked;
}

/// Why the list is empty.
void drawNothing(const volume::WorthFindings& answer, const WorthQuestion& question) {
    if (answer.missing == "nothing is selected")
        return drawHint("Nothing is selected",
                        "Brush something in a plot: this list tells how parameters, regions and times in it differ "
                        "from the rest.");
    if (!answer.missing.empty()) return drawHint("Nothing to compare", (answer.missing + ".").c_str());
    const std::string text = formatCount(double(answer.tests)) +
                             " tests, of which none stands out at a false discovery "
                             "rate of " +
                             formatShare(question.rate) + ": what is to be seen may be there by chance.";
    drawHint("Nothing beyond chance", text.c_str());
}

} // namespace

void drawWorthSeeingView(ViewContext& context, const std::string& pane, WorthSeeingView& view) {
    if (!context.source) {
        drawHint("No data", "Lists what stands out in the data.");
        return;
    }
    const volume::DatasetInfo& info = context.numbers->info();
    const std::vector<int> shown = chosenChannels(info, view.channels, 32);
    WorthCache& cache = cacheOf<WorthCache>(context, pane);
    const WorthQuestion question = worthQuestion(context.session, info, view, shown);
    ToolRow tools(context);
    chooseList(tools, view);
    chooseChannels(tools, info, view.channels, shown);
    chooseSelected(tools, context.session, view);
    const auto found = cache.answers.answer(
        context, context.numbers,
        {.key = "worth " + pane,
         .title = "What is worth seeing",
         .lowPriority = true,
         .firstLevel = firstWorthLevel(context.numbers->grid(), shown.size())},
        question,
        [](const std::shared_ptr<const volume::BrickSource>& source, const WorthQuestion& asked, int level,
           const Progress& progress) { return readWorth(source, asked, level, progress); },
        [](const WorthQuestion& a, const WorthQuestion& b) {
            return a.list == b.list && a.channels == b.channels && a.selection == b.selection;
        });
    if (!found) {
        const std::string failure = cache.answers.failure();
        return failure.empty() ? ImGui::TextDisabled("Searching...") : drawHint("No list", failure.c_str());
    }
    // An older answer is told with its own question, until the one to this question is there.
    const WorthQuestion& searched = found->query;
    const volume::WorthFindings& answer = found->result;
    const auto table = [found, source = context.numbers] {
        return worthTable(found->result, found->query, source->info());
    };
    // Exports state the brushes of the session: there is none while these are not yet searched.
    if (searched.brushes == question.brushes)
        exportMenu(context, tools,
                   {.name = "worth-seeing",
                    .figure = [table](const PageForm& form, const Progress&) { return tablePage(table(), form); },
                    .table = [table](const Progress&) { return table(); },
                    .brushed = !searched.selection.empty()},
                   false, searchedOrigin(originText(context), searched, info, context.session.data.axis));
    if (answer.missing.empty()) drawNote(tools, searchedText(answer, searched, info));
    if (answer.found.empty()) return drawNothing(answer, searched);
    std::size_t chosen = answer.found.size();
    ImGui::BeginChild("findings");
    for (std::size_t i = 0; i < answer.found.size(); ++i)
        if (drawRow(i + 1, answer.pictures[i], sentenceOf(answer.found[i], searched, info), evidenceOf(answer.found[i]),
                    context.takesInput()))
            chosen = i;
    ImGui::EndChild();
    if (chosen < answer.found.size()) openFinding(context.session, info, answer.found[chosen], searched.time, pane);
}

} // namespace tessera::app
