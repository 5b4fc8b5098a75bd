#include "app/pages/plot_marks.h"

#include "app/drawing/line_pieces.h"
#include "app/ui/ticks.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

using namespace shapes;

namespace {

constexpr double kPageThin = 0.7, kPageLine = 1.2, kPageHalo = 1.8; // widths of lines, points
constexpr double kRampGap = 6, kRampWidth = 8, kRampText = 3;       // of a key of colours
constexpr double kPageDash = 5, kPageDashPeriod = 8, kPageDot = 2.2;

/// The ticks of an axis that have room: their texts lie along it, or each takes a line.
TickLabels pageTicks(const PlotAxis& axis, double length, bool lines, const PageForm& form) {
    const double text = form.text;
    if (!axis.numbered) return {};
    return scaledTicks(
        axis.range, axis.scale, length, text * (lines ? 0.8 : 1.2), true,
        [&](const std::string& each) { return lines ? text : pageTextWidth(each, text); }, form.figure.ticks);
}

class PlotMarks {
public:
    PlotMarks(const Plot& plot, const PlotPlace& place, const PageForm& form, std::vector<Mark>& out)
        : plot_(plot), place_(place), form_(form), inks_(pageInks(form)), text_(form.text),
          scale_(form.text / kFigureText), x0_(place.box.lo.x), x1_(place.box.hi.x), y0_(place.box.hi.y),
          y1_(place.box.lo.y), out_(out) {}

    std::size_t draw() {
        image();
        if (form_.legend && !plot_.key.rgba.empty()) colorKey();
        if (plot_.framed) axes();
        const std::size_t before = out_.size();
        if (form_.outlines)
            for (const PlotBand& each : plot_.brushed) band(each);
        for (const std::vector<glm::dvec2>& contour : plot_.contours) haloed(contour);
        for (const PlotLabel& each : plot_.labels) {
            // What stands alone in a cell that is too small for it is left out, as in a small pane.
            if (!plot_.framed && pageTextWidth(each.text, text_) > x1_ - x0_ + 2 * place_.overhang) continue;
            out_.push_back({Words{.text = each.text,
                                  .at = at(each.at),
                                  .size = text_,
                                  .color = plot_.image.width > 0 || !plot_.contours.empty() ? kOnPicture : inks_.text,
                                  .anchor = 0.5,
                                  .angle = each.angle,
                                  .halo = plot_.framed ? kPageHalo : 0,
                                  .middle = true}});
        }
        if (form_.outlines)
            for (const PlotOutline& each : plot_.outlines) outline(each);
        for (const PlotFlow& each : plot_.flows) flow(each);
        for (const PlotSeries& series : plot_.series) series.bars ? bars(series) : line(series);
        if (std::ranges::any_of(plot_.series, &PlotSeries::bars) && plot_.y.range.lo < 0 && plot_.y.range.hi > 0)
            stroke({{x0_, py(0)}, {x1_, py(0)}}, inks_.frame, kPageThin);
        if (form_.cursor) cursor();
        return before;
    }

private:
    static constexpr glm::vec4 kOnPicture{0.133f, 0.133f, 0.133f, 1}; // with its light halo

    static double share(Range range, double value, double from, double to) {
        const double span = range.hi > range.lo ? range.hi - range.lo : 1;
        return from + (value - range.lo) / span * (to - from);
    }
    double px(double value) const { return share(plot_.x.range, value, x0_, x1_); }
    double py(double value) const { return share(plot_.y.range, value, y0_, y1_); }
    glm::dvec2 at(glm::dvec2 values) const { return {px(values.x), py(values.y)}; }
    double points(double usual) const { return usual * scale_; }

    void words(double x, double y, const std::string& what, double anchor, double angle = 0,
               std::optional<glm::vec3> ink = {}) {
        if (what.empty()) return;
        const glm::vec4 color = ink ? glm::vec4(*ink, 1) : inks_.text;
        out_.push_back(
            {Words{.text = what, .at = {x, y}, .size = text_, .color = color, .anchor = anchor, .angle = angle}});
    }
    void stroke(std::vector<glm::dvec2> way, glm::vec4 color, double width) {
        out_.push_back({Stroke{.points = std::move(way), .width = width * scale_, .color = color}});
    }
    void rect(glm::dvec2 lo, glm::dvec2 hi, glm::vec4 color, double line = 0) {
        out_.push_back({Rect{.box = {lo, hi}, .color = color, .line = line * scale_}});
    }
    void circle(glm::dvec2 center, double radius, glm::vec4 color, double line = 0) {
        if (!std::isfinite(center.x) || !std::isfinite(center.y)) return;
        out_.push_back({Circle{.center = at(center), .radius = points(radius), .color = color, .line = line * scale_}});
    }
    static std::string noted(const PlotAxis& axis, const TickLabels& ticks, double length, double text) {
        const std::string note = ticks.note.empty() ? "" : "  " + ticks.note;
        return fittedAxisTitle(axis, length - pageTextWidth(note, text), text) + note;
    }

    void axes() {
        rect({x0_, y1_}, {x1_, y0_}, inks_.frame, kPageThin);
        if (form_.axes) {
            below();
            beside();
            if (plot_.right) rightOf(*plot_.right);
        }
        const std::vector<std::string> lines = titleLines(plot_, place_.box.hi.x - place_.box.lo.x, form_);
        const double line = titleLine(lines.size(), form_);
        double top = y1_ - (lines.size() > 1 ? points(4) + line * double(lines.size() - 1) : points(7)) - place_.above;
        for (const std::string& each : lines) {
            words(x0_, top, each, 0);
            top += line;
        }
    }
    void below() {
        const TickLabels ticks = pageTicks(plot_.x, x1_ - x0_, false, form_);
        double free = -HUGE_VAL; // from here on there is no number
        for (std::size_t i = 0; i < ticks.values.size(); ++i) {
            const double x = px(ticks.values[i]), half = pageTextWidth(ticks.texts[i], text_) / 2;
            stroke({{x, y0_}, {x, y0_ + points(4)}}, inks_.frame, kPageThin);
            const double first = std::max(free, x0_ - place_.overhang) + half, last = x1_ + place_.overhang - half;
            if (!place_.numbersBelow || first > last || (i > 0 && x < first - half)) continue;
            words(std::clamp(x, first, last), y0_ + points(14), ticks.texts[i], 0.5);
            free = std::clamp(x, first, last) + half + text_ * 0.4;
        }
        if (!place_.numbersBelow) return;
        if (place_.acrossBelow)
            words((x0_ + x1_) / 2 + text_ * kMiddle, y0_ + points(17),
                  noted(plot_.x, ticks, place_.bottom - points(17), text_), 1, -90);
        else
            words((x0_ + x1_) / 2, y0_ + points(30), noted(plot_.x, ticks, place_.left + x1_ - x0_, text_), 0.5);
    }
    void beside() {
        const TickLabels ticks = pageTicks(plot_.y, y0_ - y1_, true, form_);
        double widest = 0, free = HUGE_VAL; // up to there is no number
        for (std::size_t i = 0; i < ticks.values.size(); ++i) {
            const double y = py(ticks.values[i]);
            stroke({{x0_ - points(4), y}, {x0_, y}}, inks_.frame, kPageThin);
            widest = std::max(widest, pageTextWidth(ticks.texts[i], text_));
            if (!place_.numbersBeside || y > free) continue;
            const double base = y + points(3);
            words(x0_ - points(6), place_.stacked ? std::min(std::max(base, y1_ + 2 * kMiddle * text_), y0_) : base,
                  ticks.texts[i], 1, 0, plot_.y.ink);
            free = y - text_;
        }
        if (!place_.numbersBeside) return;
        const double start = x0_ - place_.left + points(4); // of what reads along
        if (place_.up == UpTitle::Above)
            words(start, y1_ - points(4), noted(plot_.y, ticks, x1_ - start, text_), 0);
        else if (place_.up == UpTitle::Across)
            words(start, (y0_ + y1_) / 2 + points(3), noted(plot_.y, ticks, place_.left - points(12) - widest, text_),
                  0);
        else
            words(x0_ - place_.left + points(16), (y0_ + y1_) / 2, noted(plot_.y, ticks, y0_ - y1_, text_), 0.5, -90,
                  plot_.y.ink);
    }
    void rightOf(const PlotAxis& axis) {
        const TickLabels ticks = pageTicks(axis, y0_ - y1_, true, form_);
        double free = HUGE_VAL;
        for (std::size_t i = 0; i < ticks.values.size(); ++i) {
            const double y = share(axis.range, ticks.values[i], y0_, y1_);
            stroke({{x1_, y}, {x1_ + points(4), y}}, inks_.frame, kPageThin);
            if (y > free) continue;
            words(x1_ + points(6), y + points(3), ticks.texts[i], 0, 0, axis.ink);
            free = y - text_;
        }
        words(x1_ + keyRoom(plot_, form_) - points(kRampText), (y0_ + y1_) / 2, noted(axis, ticks, y0_ - y1_, text_),
              0.5, -90, axis.ink);
    }

    /// A dark line with a light outline, seen on any colour.
    void haloed(const std::vector<glm::dvec2>& values) {
        std::vector<glm::dvec2> way;
        for (const glm::dvec2& each : values) way.push_back(at(each));
        stroke(way, kHalo, kPageHalo);
        stroke(std::move(way), kOnPicture, kPageThin);
    }
    void closed(std::vector<glm::dvec2> way, glm::vec4 color, bool dashed) {
        if (!way.empty()) way.push_back(way.front());
        const std::vector<glm::dvec2> frame{{x0_, y1_}, {x1_, y1_}, {x1_, y0_}, {x0_, y0_}};
        for (std::vector<glm::dvec2>& piece : piecesWithin(way, frame)) {
            if (!dashed) {
                stroke(std::move(piece), color, kPageLine);
                continue;
            }
            DashPattern dashes(points(kPageDash), points(kPageDashPeriod));
            for (std::size_t i = 1; i < piece.size(); ++i)
                dashes.line(piece[i - 1], piece[i], [&](glm::dvec2 a, glm::dvec2 b) {
                    stroke({a, b}, color, kPageLine);
                });
        }
    }
    void outline(const PlotOutline& shown) {
        std::vector<glm::dvec2> way;
        for (const glm::dvec2& each : shown.points) way.push_back(at(each));
        closed(std::move(way), shown.color, shown.dashed);
        if (!shown.dot) return;
        const glm::dvec2 dot = at(*shown.dot);
        if (dot.x >= x0_ && dot.x <= x1_ && dot.y >= y1_ && dot.y <= y0_) circle(*shown.dot, kPageDot, shown.color);
    }
    /// Filled where it adds to the selection; ends that reach over the plot have no line.
    void band(const PlotBand& shown) {
        constexpr float kFill = 0.11f;
        const auto within = [](double value, double lo, double hi) { return std::clamp(value, lo, hi); };
        const double left = within(px(shown.x.lo), x0_, x1_), right = within(px(shown.x.hi), x0_, x1_),
                     low = within(py(shown.y.lo), y1_, y0_), high = within(py(shown.y.hi), y1_, y0_);
        if (!shown.dashed) rect({left, high}, {right, low}, glm::vec4(shown.color, kFill));
        const auto edge = [&](glm::dvec2 from, glm::dvec2 to) {
            if (!shown.dashed) return stroke({from, to}, glm::vec4(shown.color, 1), kPageLine);
            DashPattern(points(kPageDash), points(kPageDashPeriod)).line(from, to, [&](glm::dvec2 a, glm::dvec2 b) {
                stroke({a, b}, glm::vec4(shown.color, 1), kPageLine);
            });
        };
        for (const double x : {left, right})
            if (x > x0_ && x < x1_) edge({x, high}, {x, low});
        for (const double y : {low, high})
            if (y > y1_ && y < y0_) edge({left, y}, {right, y});
    }
    /// From zero to their heights: side by side, or a single one between those of other series one unit away.
    void bars(const PlotSeries& series) {
        constexpr double kSingle = 0.4;
        const bool several = series.points.size() > 1;
        const double half = several ? (px(series.points[1].x) - px(series.points[0].x)) / 2 : kSingle * (px(1) - px(0));
        const auto within = [&](double y) { return std::clamp(py(y), y1_, y0_); };
        for (const glm::dvec2& bar : series.points) {
            if (!std::isfinite(bar.y) || within(bar.y) == within(0)) continue;
            rect({px(bar.x) - half, within(std::max(bar.y, 0.0))}, {px(bar.x) + half, within(std::min(bar.y, 0.0))},
                 glm::vec4(series.color, 1));
        }
    }
    void flow(const PlotFlow& shown) {
        std::vector<glm::dvec2> outline, back;
        for (std::size_t i = 0; i < shown.points.size(); ++i) {
            const glm::dvec2 middle = at(shown.points[i]);
            const double half = std::max(points(kPageLine) / 2, std::abs(py(shown.half[i]) - py(0)));
            outline.emplace_back(middle.x, middle.y - half);
            back.emplace_back(middle.x, middle.y + half);
        }
        outline.insert(outline.end(), back.rbegin(), back.rend());
        if (outline.size() > 2) out_.push_back({Polygon{.points = std::move(outline), .color = shown.color}});
    }
    void line(const PlotSeries& series) {
        const Range up = plot_.upOf(series).range;
        const auto on = [&](const glm::dvec2& point) { return glm::dvec2(px(point.x), share(up, point.y, y0_, y1_)); };
        std::vector<glm::dvec2> way;
        const auto end = [&] {
            if (way.size() > 1) stroke(way, glm::vec4(series.color, 1), kPageLine);
            if (way.size() == 1 && !series.dots)
                out_.push_back(
                    {Circle{.center = way[0], .radius = points(kPageLine), .color = glm::vec4(series.color, 1)}});
            way.clear();
        };
        for (const glm::dvec2& point : series.points)
            if (std::isfinite(point.x) && std::isfinite(point.y))
                way.push_back(on(point));
            else
                end();
        end();
        if (!series.dots) return;
        for (const glm::dvec2& point : series.points)
            if (std::isfinite(point.x) && std::isfinite(point.y))
                out_.push_back(
                    {Circle{.center = on(point), .radius = points(1.8), .color = glm::vec4(series.color, 1)}});
    }
    void cursor() {
        if (plot_.cursorX && *plot_.cursorX >= plot_.x.range.lo && *plot_.cursorX <= plot_.x.range.hi)
            stroke({{px(*plot_.cursorX), y1_}, {px(*plot_.cursorX), y0_}}, inks_.cursor, kPageThin);
        if (plot_.cursorY && *plot_.cursorY >= plot_.y.range.lo && *plot_.cursorY <= plot_.y.range.hi)
            stroke({{x0_, py(*plot_.cursorY)}, {x1_, py(*plot_.cursorY)}}, inks_.cursor, kPageThin);
        for (const glm::dvec2& mark : plot_.marks) circle(mark, 4.5, inks_.cursor, kPageLine);
    }
    /// A picture with one pixel per cell, seen as they are.
    void image() {
        const PlotImage& image = plot_.image;
        if (image.width <= 0 || image.height <= 0) return;
        out_.push_back({Picture{
            .box = {{x0_, y1_}, {x1_, y0_}}, .image = {{image.width, image.height}, image.rgba}, .smooth = false}});
    }

    void colorKey() {
        const PlotColorKey& key = plot_.key;
        const glm::dvec2 lo{x1_ + points(kRampGap), y1_}, hi{x1_ + points(kRampGap + kRampWidth), y0_};
        out_.push_back({Picture{.box = {lo, hi}, .image = {{1, static_cast<int>(key.rgba.size() / 4)}, key.rgba}}});
        rect(lo, hi, inks_.frame, kPageThin);
        words(hi.x + points(kRampText), y1_ + text_ * 2 * kMiddle, key.highest, 0);
        words(hi.x + points(kRampText), y0_, key.lowest, 0);
    }

    const Plot& plot_;
    const PlotPlace& place_;
    const PageForm& form_;
    PageInks inks_;
    double text_, scale_, x0_, x1_, y0_, y1_;
    std::vector<Mark>& out_;
};

} // namespace

PageInks pageInks(const PageForm& form) {
    const auto grey = [](float value) { return glm::vec4(glm::vec3(value), 1); };
    if (form.dark) return {grey(0.075f), grey(0.9f), grey(0.5f), {0.37f, 0.84f, 1, 1}};
    return {grey(1), grey(0.133f), grey(0.267f), {0, 0.44f, 0.69f, 1}};
}

std::string wholeAxisTitle(const PlotAxis& axis) {
    return titleWithUnit(axis.title, axis.unit);
}

std::string fittedAxisTitle(const PlotAxis& axis, double length, double text) {
    const auto fits = [&](const std::string& each) { return pageTextWidth(each, text) <= length; };
    std::string shown = axis.title;
    if (shown.empty() || fits(wholeAxisTitle(axis))) return wholeAxisTitle(axis);
    while (!shown.empty() && !fits(titleWithUnit(shown + "...", axis.unit))) {
        while ((static_cast<unsigned char>(shown.back()) & 0xc0) == 0x80) shown.pop_back(); // whole UTF-8 characters
        shown.pop_back();
    }
    if (!shown.empty() || axis.unit.empty()) return titleWithUnit(shown + "...", axis.unit);
    return fittedAxisTitle({.title = axis.title, .range = axis.range}, length,
                           text); // rather the name than the unit alone
}

double titleLine(std::size_t lines, const PageForm& form) {
    return form.text * (lines > 2 ? kLineHeight : 1);
}

std::vector<std::string> titleLines(const Plot& plot, double width, const PageForm& form) {
    std::vector<std::string> lines;
    if (!form.title) return lines;
    for (const std::string* whole : {&plot.title, &plot.note}) {
        if (whole->empty()) continue;
        std::string line;
        for (std::size_t from = 0; from < whole->size();) {
            const std::size_t end = std::min(whole->find(' ', from), whole->size());
            const std::string word = whole->substr(from, end - from);
            const std::string longer = line.empty() ? word : line + " " + word;
            if (!line.empty() && form.size.x > 0 && pageTextWidth(longer, form.text) > width) {
                lines.push_back(line);
                line = word;
            } else {
                line = longer;
            }
            from = end + 1;
        }
        lines.push_back(line);
    }
    return lines;
}

double keyRoom(const Plot& plot, const PageForm& form) {
    const double scale = form.text / kFigureText;
    if (plot.right && form.axes) {
        double widest = 0;
        for (const int most : {3, 5, 8, 12})
            for (const std::string& text : styledTickLabels(plot.right->range, most, true, form.figure.ticks).texts)
                widest = std::max(widest, pageTextWidth(text, form.text));
        return widest + (6 + kRampText) * scale + 1.6 * form.text;
    }
    if (plot.key.rgba.empty() || !form.legend) return 0;
    return (kRampGap + kRampWidth + kRampText) * scale +
           std::max(pageTextWidth(plot.key.highest, form.text), pageTextWidth(plot.key.lowest, form.text));
}

std::size_t addPlot(std::vector<Mark>& out, const Plot& plot, const PlotPlace& place, const PageForm& form) {
    return PlotMarks(plot, place, form, out).draw();
}

} // namespace tessera::app
