#include "app/pane/figure.h"

#include "app/drawing/free_place.h"
#include "app/drawing/line_pieces.h"
#include "app/pane/view_parts.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/vec4.hpp>
#include <optional>
#include <span>

namespace tessera::app {

namespace {

// Size of a panel in points, with margins for numbers and titles.
constexpr double kLeft = 62, kBottom = 42, kTop = 22, kRight = 12, kBeside = 8;
constexpr double kWidth = kLeft + kFigurePlot.x + kRight, kHeight = kTop + kFigurePlot.y + kBottom;

constexpr glm::vec4 kInk{0.133f, 0.133f, 0.133f, 1}, kFrame{0.267f, 0.267f, 0.267f, 1}, kWhite{1};
constexpr double kThin = 0.7, kLine = 1.2, kHaloWidth = 1.8; // widths of lines
constexpr double kLegendLine = 11, kKey = 8, kKeyGap = 3;    // the list of series: lines, and keys beside the names
constexpr double kDash = 5, kDashPeriod = 8, kDot = 2.2;

class Panel {
public:
    Panel(const FigurePanel& panel, double left, double top, std::vector<shapes::Mark>& out)
        : panel_(panel), x0_(left + kLeft), x1_(left + kWidth - kRight), y0_(top + kHeight - kBottom), y1_(top + kTop),
          out_(out) {}

    void draw() {
        image();
        axes();
        drawn_ = out_.size();
        for (const std::vector<glm::dvec2>& contour : panel_.contours) haloed(contour);
        for (const FigureLabel& each : panel_.labels)
            out_.push_back({shapes::Words{.text = each.text,
                                          .at = at(each.at),
                                          .size = kFigureText,
                                          .color = kInk,
                                          .anchor = 0.5,
                                          .angle = each.angle,
                                          .halo = kHaloWidth,
                                          .middle = true}});
        for (const FigureOutline& each : panel_.outlines) outline(each);
        for (const FigureSeries& series : panel_.series) series.bars ? bars(series) : line(series);
        if (std::ranges::any_of(panel_.series, &FigureSeries::bars) && panel_.y.range.lo < 0 && panel_.y.range.hi > 0)
            stroke({{x0_, py(0)}, {x1_, py(0)}}, kFrame, kThin);
        for (const glm::dvec2& mark : panel_.marks) circle(mark, 4.5, {0, 0, 0, 1}, kLine);
        if (panel_.series.size() < 2) return;
        place_ = freePlace(legendSize(), {{x0_, y1_}, {x1_, y0_}}, std::span(out_).subspan(drawn_));
        legend();
    }
    /// The width that the list of series takes beside the plot; 0 where it stands in it.
    double beside() const { return panel_.series.size() < 2 || place_ ? 0 : legendSize().x + kBeside; }

private:
    static double place(Range range, double value, double from, double to) {
        const double span = range.hi > range.lo ? range.hi - range.lo : 1;
        return from + (value - range.lo) / span * (to - from);
    }
    double px(double value) const { return place(panel_.x.range, value, x0_, x1_); }
    double py(double value) const { return place(panel_.y.range, value, y0_, y1_); }
    glm::dvec2 at(glm::dvec2 values) const { return {px(values.x), py(values.y)}; }

    void text(double x, double y, const std::string& what, double anchor, double angle = 0) {
        out_.push_back({shapes::Words{
            .text = what, .at = {x, y}, .size = kFigureText, .color = kInk, .anchor = anchor, .angle = angle}});
    }
    void stroke(std::vector<glm::dvec2> points, glm::vec4 color, double width) {
        out_.push_back({shapes::Stroke{.points = std::move(points), .width = width, .color = color}});
    }
    void rect(glm::dvec2 lo, glm::dvec2 hi, glm::vec4 color, double line = 0) {
        out_.push_back({shapes::Rect{.box = {lo, hi}, .color = color, .line = line}});
    }
    void axes() {
        rect({x0_, y1_}, {x1_, y0_}, kFrame, kThin);
        const TickLabels across = panel_.x.numbered ? tickLabels(panel_.x.range, 5) : TickLabels{},
                         up = tickLabels(panel_.y.range, 5);
        for (std::size_t i = 0; i < across.values.size(); ++i) {
            const double x = px(across.values[i]);
            stroke({{x, y0_}, {x, y0_ + 4}}, kFrame, kThin);
            text(x, y0_ + 14, across.texts[i], 0.5);
        }
        for (std::size_t i = 0; i < up.values.size(); ++i) {
            const double y = py(up.values[i]);
            stroke({{x0_ - 4, y}, {x0_, y}}, kFrame, kThin);
            text(x0_ - 6, y + 3, up.texts[i], 1);
        }
        const auto noted = [](const FigureAxis& axis, const TickLabels& ticks) {
            return axis.title + (ticks.note.empty() ? "" : "  " + ticks.note);
        };
        text((x0_ + x1_) / 2, y0_ + 30, noted(panel_.x, across), 0.5);
        text(x0_ - 46, (y0_ + y1_) / 2, noted(panel_.y, up), 0.5, -90);
        text(x0_, y1_ - (panel_.note.empty() ? 7 : 13), panel_.title, 0);
        if (!panel_.note.empty()) text(x0_, y1_ - 4, panel_.note, 0);
    }
    /// A dark line with a light outline, seen on any colour.
    void haloed(const std::vector<glm::dvec2>& values) {
        std::vector<glm::dvec2> points;
        for (const glm::dvec2& each : values) points.push_back(at(each));
        stroke(points, shapes::kHalo, kHaloWidth);
        stroke(std::move(points), kInk, kThin);
    }
    void outline(const FigureOutline& shown) {
        std::vector<glm::dvec2> points;
        for (const glm::dvec2& each : shown.points) points.push_back(at(each));
        if (!points.empty()) points.push_back(points.front());
        const std::vector<glm::dvec2> frame{{x0_, y1_}, {x1_, y1_}, {x1_, y0_}, {x0_, y0_}};
        for (std::vector<glm::dvec2>& piece : piecesWithin(points, frame)) {
            if (!shown.dashed) {
                stroke(std::move(piece), shown.color, kLine);
                continue;
            }
            DashPattern dashes(kDash, kDashPeriod);
            for (std::size_t i = 1; i < piece.size(); ++i)
                dashes.line(piece[i - 1], piece[i], [&](glm::dvec2 a, glm::dvec2 b) {
                    stroke({a, b}, shown.color, kLine);
                });
        }
        if (!shown.dot) return;
        const glm::dvec2 dot = at(*shown.dot);
        if (dot.x >= x0_ && dot.x <= x1_ && dot.y >= y1_ && dot.y <= y0_) circle(*shown.dot, kDot, shown.color);
    }
    /// From zero to their heights: side by side, or a single one between those of other series one unit away.
    void bars(const FigureSeries& series) {
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
    void line(const FigureSeries& series) {
        std::vector<glm::dvec2> points;
        const auto end = [&] {
            if (points.size() > 1) stroke(points, glm::vec4(series.color, 1), kLine);
            points.clear();
        };
        for (const glm::dvec2& point : series.points)
            if (std::isfinite(point.x) && std::isfinite(point.y))
                points.push_back(at(point));
            else
                end();
        end();
        if (!series.dots) return;
        for (const glm::dvec2& point : series.points) circle(point, 1.8, glm::vec4(series.color, 1));
    }
    void circle(glm::dvec2 center, double radius, glm::vec4 color, double line = 0) {
        if (!std::isfinite(center.x) || !std::isfinite(center.y)) return;
        out_.push_back({shapes::Circle{.center = at(center), .radius = radius, .color = color, .line = line}});
    }
    /// A picture with one pixel per cell, seen as they are.
    void image() {
        const FigureImage& image = panel_.image;
        if (image.width <= 0 || image.height <= 0) return;
        out_.push_back({shapes::Picture{
            .box = {{x0_, y1_}, {x1_, y0_}}, .image = {{image.width, image.height}, image.rgba}, .smooth = false}});
    }
    glm::dvec2 legendSize() const {
        double width = 0;
        for (const FigureSeries& series : panel_.series) width = std::max(width, figureTextWidth(series.name));
        return {width + kKey + kKeyGap, kLegendLine * static_cast<double>(panel_.series.size())};
    }
    void legend() {
        const glm::dvec2 at = place_ ? place_->lo : glm::dvec2{x1_ + kBeside, y1_};
        const bool right = place_ && place_->lo.x > (x0_ + x1_ - legendSize().x) / 2 + 1; // keys at the edge
        const double edge = right ? place_->hi.x - kKey : at.x;
        double y = at.y + 9;
        for (const FigureSeries& series : panel_.series) {
            rect({edge, y - 6}, {edge + kKey, y - 2}, glm::vec4(series.color, 1));
            text(right ? edge - kKeyGap : edge + kKey + kKeyGap, y, series.name, right ? 1 : 0);
            y += kLegendLine;
        }
    }

    const FigurePanel& panel_;
    double x0_, x1_, y0_, y1_;
    std::vector<shapes::Mark>& out_;
    std::size_t drawn_ = 0;                ///< marks before those of the data
    std::optional<shapes::PageBox> place_; ///< of the list of series within the plot
};

} // namespace

double figureTextWidth(const std::string& text) {
    double width = 0; // in em: Helvetica's digits are wider than its points and minus signs
    for (const char c : text) width += c == '.' ? 0.28 : c == '-' ? 0.34 : 0.56;
    return width * kFigureText;
}

VectorPage drawingOf(const std::vector<FigurePanel>& panels, int columns) {
    const int across = std::max(1, std::min(columns, static_cast<int>(panels.size())));
    const int rows = (static_cast<int>(panels.size()) + across - 1) / across;
    double beside = 0;
    for (const FigurePanel& panel : panels) {
        if (panel.series.size() < 2) continue;
        std::vector<shapes::Mark> marks;
        Panel tried(panel, 0, 0, marks);
        tried.draw();
        beside = std::max(beside, tried.beside());
    }
    const double width = kWidth + beside;
    VectorPage out;
    out.size = {across * width, std::max(1, rows) * kHeight};
    out.marks.push_back({shapes::Rect{.box = {{0, 0}, out.size}, .color = kWhite}});
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const int column = static_cast<int>(i) % across, row = static_cast<int>(i) / across;
        Panel(panels[i], column * width, row * kHeight, out.marks).draw();
    }
    return out;
}

std::string csvNumber(double value) {
    if (!std::isfinite(value)) return {};
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

void exportMenu(ViewContext& context, ToolRow& tools, ViewExport asked, bool atOneTime, const std::string& numbers) {
    std::string& name = asked.name; // as a file
    const std::string title = name;
    std::replace(name.begin(), name.end(), '/', '_');
    if (asked.table && !asked.csv)
        asked.csv = [table = asked.table](const Progress& progress) { return csvOf(table(progress)); };
    const auto described = [&]() -> ViewExport { // tables and pictures state the origin of their numbers
        if (!context.numbers) return asked;
        const volume::DatasetInfo& info = context.numbers->info();
        std::string origin = numbers.empty() ? originText(context.origin, info) : numbers;
        if (atOneTime && info.times.size() > 1) origin += ", at " + timeText(info, context.session.time);
        ViewExport made = asked;
        if (asked.csv)
            made.csv = [csv = asked.csv, origin](const Progress& progress) {
                return "# numbers: " + origin + "\n" + csv(progress);
            };
        if (asked.figure)
            made.figure = [figure = asked.figure, origin](const PageForm& form, const Progress& progress) {
                VectorPage drawing = figure(form, progress);
                drawing.numbers = origin;
                return drawing;
            };
        return made;
    };
    if (context.offerExport) context.offerExport(described());
    if (!tools.next(buttonWidth("Export"))) return;
    ImGui::BeginDisabled(!context.exportText);
    if (ImGui::Button("Export")) ImGui::OpenPopup("export");
    ImGui::EndDisabled();
    if (!ImGui::BeginPopup("export")) return;
    const ViewExport made = described();
    if (ImGui::MenuItem("Picture (PNG)...") && context.runCommand) context.runCommand("Save picture...");
    for (const auto& [item, suffix] :
         {std::pair{"Vector graphics (SVG)...", "svg"}, {"Vector graphics (PDF)...", "pdf"}})
        if (made.figure && context.exportFigure && ImGui::MenuItem(item))
            context.exportFigure(name + "." + suffix,
                                 [figure = made.figure](const Progress& progress) { return figure({}, progress); });
    if (made.csv && ImGui::MenuItem("Copy table (CSV)"))
        context.jobs.start("copy " + title, "Copying " + title,
                           [csv = made.csv](const Progress& progress) -> Jobs::Finish {
                               return [text = csv(progress)] { ImGui::SetClipboardText(text.c_str()); };
                           });
    if (made.csv && ImGui::MenuItem("Table (CSV)...")) context.exportText(name + ".csv", made.csv);
    ImGui::EndPopup();
}

} // namespace tessera::app
