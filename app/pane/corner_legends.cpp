#include "app/pane/corner_legends.h"

#include "app/ui/ticks.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr double kFree = 0.02;           ///< share of a legend over the object that nobody minds
constexpr float kMostOverObject = 0.12f; ///< share of a picture that legends over its object take at most

bool isBar(const LegendEntry& entry) {
    return entry.names.empty() && !entry.swatch && !entry.glyph;
}

std::string endOf(const LegendEntry& entry, bool high) {
    return formatNumber(high ? entry.range.hi : entry.range.lo, (entry.range.hi - entry.range.lo) / 30);
}

/// Legends whose bars are one line each, in columns: title, least value, bar, largest value.
class LegendLines {
public:
    LegendLines(const std::vector<LegendEntry>& entries, float room) : width_(std::min(em() * 18, room * 0.65f)) {
        for (const LegendEntry& entry : entries) {
            if (!isBar(entry)) continue;
            title_ = std::max(title_, ImGui::CalcTextSize(titleWithUnit(entry.title, entry.unit).c_str()).x);
            for (const bool high : {false, true})
                number_ = std::max(number_, ImGui::CalcTextSize(endOf(entry, high).c_str()).x);
            if (beyondLegend(entry, false) || beyondLegend(entry, true)) gap_ = em() * 0.3f + legendArrow();
        }
        title_ = std::min({title_, width_ * 0.5f, std::max(0.0f, width_ - 2 * number_ - 3 * gap_ - em())});
    }
    float width() const { return width_; }
    float height(const LegendEntry& entry) const { return isBar(entry) ? em() * 1.3f : legendHeight(entry); }
    float draw(ImDrawList& draw, ImVec2 min, const LegendEntry& entry) const {
        if (!isBar(entry)) return drawLegend(draw, min, width_, entry);
        const PlotColors colors = plotColors();
        const float top = min.y + em() * 0.3f;
        const std::string whole = titleWithUnit(entry.title, entry.unit);
        const std::string end = whole.substr(entry.title.size()), cut = fitBefore(entry.title, end, title_ + 1);
        const std::string title = firstThatFits({whole, cut.empty() ? entry.title : cut, entry.title}, title_ + 1);
        draw.AddText(min, colors.text, title.c_str());
        const ImVec2 lo{min.x + title_ + number_ + 2 * gap_, top},
            hi{min.x + width_ - number_ - gap_, top + legendStripHeight()};
        const auto write = [&](float x, const std::string& text) {
            draw.AddText({std::round(x), min.y}, colors.text, text.c_str());
        };
        const std::string least = endOf(entry, false);
        write(lo.x - gap_ - ImGui::CalcTextSize(least.c_str()).x, least);
        write(hi.x + gap_, endOf(entry, true));
        drawLegendStrip(draw, lo, hi, entry);
        drawLegendArrows(draw, lo, hi, entry);
        drawLegendMarker(draw, {lo, hi, paddedRange(entry.range), {0, 1}}, entry);
        return height(entry);
    }

private:
    float width_, title_ = 0, number_ = 0, gap_ = em() * 0.4f;
};

/// All legends in one line: what is coloured, each with a piece of its colours. Those without room are counted.
class LegendNames {
public:
    LegendNames(const std::vector<LegendEntry>& entries, float room) : entries_(entries) {
        units_ = true;
        const auto widthOf = [&](std::size_t count) {
            float width = 0;
            for (std::size_t i = 0; i < count; ++i) width += own(entries[i]) + gap();
            return width - gap() + ImGui::CalcTextSize(rest(count).c_str()).x;
        };
        shown_ = entries.size();
        units_ = widthOf(shown_) <= room * 0.6f;
        while (shown_ > 1 && widthOf(shown_) > room) --shown_;
        width_ = entries.empty() ? 0 : std::min(room, widthOf(shown_));
    }
    float width() const { return width_; }
    static float height() { return em() * 1.3f; }
    void draw(ImDrawList& draw, ImVec2 at) const {
        const PlotColors colors = plotColors();
        const float right = at.x + width_;
        for (std::size_t i = 0; i < shown_; ++i) {
            const LegendEntry& entry = entries_[i];
            const ImVec2 lo{at.x, at.y + em() * 0.3f}, hi{at.x + strip(entry), lo.y + legendStripHeight()};
            if (entry.swatch)
                draw.AddRectFilled(lo, hi, toColor(entry.color));
            else if (isBar(entry))
                drawLegendStrip(draw, lo, hi, entry);
            const float text = hi.x + (strip(entry) > 0 ? em() * 0.4f : 0);
            draw.AddText({text, at.y}, colors.text, fitText(nameOf(entry), right - text + 1).c_str());
            at.x += own(entry) + gap();
        }
        draw.AddText({at.x - gap(), at.y}, colors.faint, rest(shown_).c_str());
    }

private:
    static float gap() { return em() * 0.8f; }
    static float strip(const LegendEntry& entry) {
        return !entry.names.empty() || entry.glyph ? 0 : entry.swatch ? legendStripHeight() : em() * 1.6f;
    }
    std::string nameOf(const LegendEntry& entry) const {
        return units_ ? titleWithUnit(entry.title, entry.unit) : entry.title;
    }
    float own(const LegendEntry& entry) const {
        return strip(entry) + (strip(entry) > 0 ? em() * 0.4f : 0) + ImGui::CalcTextSize(nameOf(entry).c_str()).x;
    }
    std::string rest(std::size_t count) const {
        return count < entries_.size() ? "  +" + std::to_string(entries_.size() - count) : "";
    }
    const std::vector<LegendEntry>& entries_;
    std::size_t shown_ = 0;
    bool units_ = false; ///< where they take little of the line
    float width_ = 0;
};

/// Legends in one form and their room.
struct FormedLegends {
    LegendForm form;
    LegendLines lines;
    LegendNames names;
    float width = 0, pad = em() * 0.5f;
    std::vector<const LegendEntry*> shown = {}; ///< whole or as lines
    LegendArea area;

    float heightOf(const LegendEntry& entry) const {
        return form == LegendForm::Lines ? lines.height(entry) : legendHeight(entry);
    }
};

FormedLegends formLegends(const std::vector<LegendEntry>& entries, const LegendRoom& room, LegendPlace place) {
    const bool bottom = place.corner == LegendCorner::BottomRight, left = place.corner == LegendCorner::TopLeft;
    const float top = room.min.y + (bottom ? 0 : room.top), high = room.max.y - top, wide = room.max.x - room.min.x;
    FormedLegends out{.form = place.form,
                      .lines = LegendLines(entries, wide),
                      .names = LegendNames(entries, wide - em() * 2),
                      .area = {room.max, room.max}};
    float height = 0;
    if (place.form == LegendForm::Names) {
        out.width = out.names.width();
        height = entries.empty() ? 0 : LegendNames::height();
    } else {
        const bool glyphs =
            std::ranges::any_of(entries, [](const LegendEntry& entry) { return entry.glyph.has_value(); });
        const float whole = em() * (glyphs ? 20 : 15); // names, ranges and units beside a picture
        out.width = place.form == LegendForm::Lines ? out.lines.width() : std::min(whole, wide * 0.45f);
        if (out.width < em() * 7) return out;
        for (const LegendEntry& entry : entries) {
            if (height + out.heightOf(entry) > high * place.most) break;
            height += out.heightOf(entry);
            out.shown.push_back(&entry);
        }
    }
    if (height <= 0) return out;
    const ImVec2 size{out.width + 2 * out.pad, height + out.pad * 1.5f};
    out.area.min = {left ? room.min.x : room.max.x - size.x, bottom ? room.max.y - size.y : top};
    out.area.max = {out.area.min.x + size.x, out.area.min.y + size.y};
    return out;
}

/// The corner where legends of a form cover least, rather one where they usually are, and how much of the object that
/// is.
std::pair<LegendPlace, double> freestCorner(const std::vector<LegendEntry>& entries, const LegendRoom& room,
                                            const LegendSurroundings& covered, LegendPlace best) {
    double least = 2, leastNumbers = 2;
    for (const LegendCorner corner : {LegendCorner::BottomRight, LegendCorner::TopRight, LegendCorner::TopLeft}) {
        const LegendArea area = legendArea(entries, room, {best.form, corner, best.most});
        const double own = covered.object(area.min, area.max);
        const double numbers = covered.numbers ? covered.numbers(area.min, area.max) : 0;
        const bool same = std::abs(own - least) <= kFree;
        if (same ? numbers >= leastNumbers - kFree : own > least) continue;
        least = own;
        leastNumbers = numbers;
        best.corner = corner;
    }
    return {best, least};
}

/// Whether all legends have room in one form.
bool allFit(const std::vector<LegendEntry>& entries, const LegendRoom& room, LegendPlace place) {
    return formLegends(entries, room, place).shown.size() == entries.size();
}

} // namespace

bool legendsAsLines(float height, float room) {
    return room < em() * 24 ? height > em() * 2 : height > room * 0.3f;
}

LegendPlace placeLegends(const std::vector<LegendEntry>& entries, const LegendRoom& room,
                         const LegendSurroundings& covered, std::optional<FigureLegends> figure) {
    const auto find = [&](LegendForm form) { return freestCorner(entries, room, covered, {form}); };
    if (figure == FigureLegends::Lines) return find(LegendForm::Lines).first;
    if (figure == FigureLegends::Whole) {
        const LegendPlace place =
            freestCorner(entries, room, covered, {LegendForm::Whole, LegendCorner::BottomRight, 0.95f}).first;
        if (allFit(entries, room, place)) return place;
    }
    float height = 0;
    for (const LegendEntry& entry : entries) height += legendHeight(entry);
    std::vector<LegendForm> forms{LegendForm::Lines};
    if (!figure) forms.push_back(LegendForm::Names);
    if (figure || !legendsAsLines(height, room.max.y - room.min.y)) forms.insert(forms.begin(), LegendForm::Whole);
    std::optional<LegendPlace> over;
    const float most = (room.max.x - room.min.x) * (room.max.y - room.min.y) * kMostOverObject;
    for (const LegendForm form : forms) {
        const auto [place, share] = find(form);
        if (share <= kFree) return place;
        const LegendArea area = legendArea(entries, room, place);
        if (!over && (area.max.x - area.min.x) * (area.max.y - area.min.y) <= most) over = place;
    }
    return over.value_or(find(forms.back()).first);
}

LegendArea legendArea(const std::vector<LegendEntry>& entries, const LegendRoom& room, LegendPlace place) {
    return formLegends(entries, room, place).area;
}

LegendArea drawLegends(ImDrawList& draw, const std::vector<LegendEntry>& entries, const LegendRoom& room,
                       LegendPlace place) {
    const FormedLegends formed = formLegends(entries, room, place);
    const auto& [min, max] = formed.area;
    if (!(max.y > min.y)) return formed.area;
    draw.AddRectFilled(min, max, plotColors().backdrop, em() * 0.25f);
    ImVec2 at{min.x + formed.pad, min.y + formed.pad * 0.5f};
    if (place.form == LegendForm::Names) formed.names.draw(draw, at);
    for (const LegendEntry* entry : formed.shown)
        at.y += place.form == LegendForm::Lines ? formed.lines.draw(draw, at, *entry)
                                                : drawLegend(draw, at, formed.width, *entry);
    const bool all = place.form == LegendForm::Whole && formed.shown.size() == entries.size();
    if (all || !ImGui::IsWindowHovered() || !ImGui::IsMouseHoveringRect(min, max)) return formed.area;
    ImGui::BeginTooltip();
    for (const LegendEntry& entry : entries) {
        const float width = em() * 15;
        ImGui::Dummy({width, drawLegend(*ImGui::GetWindowDrawList(), ImGui::GetCursorScreenPos(), width, entry)});
    }
    ImGui::EndTooltip();
    return formed.area;
}

} // namespace tessera::app
