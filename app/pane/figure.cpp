#include "app/pane/figure.h"

#include "app/pane/view_parts.h"
#include "app/ui/ticks.h"
#include "vis/image/image_io.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tessera::app {

namespace {

// Size of a panel in points, with margins for numbers and titles.
constexpr double kLeft = 62, kBottom = 42, kTop = 22, kRight = 12;
constexpr double kWidth = kLeft + kFigurePlot.x + kRight, kHeight = kTop + kFigurePlot.y + kBottom;

std::string twoDecimals(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", value);
    return text;
}

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '<')
            out += "&lt;";
        else if (c == '&')
            out += "&amp;";
        else if (c == '"')
            out += "&quot;";
        else
            out += c;
    }
    return out;
}

std::string colorOf(glm::vec3 color) {
    char text[16];
    const auto byte = [](float v) { return static_cast<int>(std::lround(std::clamp(v, 0.0f, 1.0f) * 255)); };
    std::snprintf(text, sizeof text, "#%02x%02x%02x", byte(color.r), byte(color.g), byte(color.b));
    return text;
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto byte = [&](std::size_t k) {
            return i + k < bytes.size() ? static_cast<std::uint32_t>(bytes[i + k]) : 0u;
        };
        const std::uint32_t bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for (std::size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

class Panel {
public:
    Panel(const FigurePanel& panel, double left, double top)
        : panel_(panel), x0_(left + kLeft), x1_(left + kWidth - kRight), y0_(top + kHeight - kBottom), y1_(top + kTop) {
    }

    std::string svg() {
        image();
        axes();
        for (const std::vector<glm::dvec2>& contour : panel_.contours) haloed(contour);
        for (const FigureLabel& each : panel_.labels) label(each);
        for (const FigureSeries& series : panel_.series) series.bars ? bars(series) : line(series);
        for (const glm::dvec2& mark : panel_.marks) ring(mark, 4.5, "none", "black");
        legend();
        return out_;
    }

private:
    static double place(Range range, double value, double from, double to) {
        const double span = range.hi > range.lo ? range.hi - range.lo : 1;
        return from + (value - range.lo) / span * (to - from);
    }
    double px(double value) const { return place(panel_.x.range, value, x0_, x1_); }
    double py(double value) const { return place(panel_.y.range, value, y0_, y1_); }

    void text(double x, double y, const std::string& what, const char* anchor, double turn = 0) {
        out_ += "<text x=\"" + twoDecimals(x) + "\" y=\"" + twoDecimals(y) + "\" text-anchor=\"" + anchor + "\"";
        if (turn != 0)
            out_ += " transform=\"rotate(" + twoDecimals(turn) + " " + twoDecimals(x) + " " + twoDecimals(y) + ")\"";
        out_ += ">" + escaped(what) + "</text>\n";
    }
    void stroke(double ax, double ay, double bx, double by, const char* color) {
        out_ += "<line x1=\"" + twoDecimals(ax) + "\" y1=\"" + twoDecimals(ay) + "\" x2=\"" + twoDecimals(bx) +
                "\" y2=\"" + twoDecimals(by) + "\" stroke=\"" + color + "\" stroke-width=\"0.7\"/>\n";
    }
    void axes() {
        out_ += "<rect x=\"" + twoDecimals(x0_) + "\" y=\"" + twoDecimals(y1_) + "\" width=\"" +
                twoDecimals(x1_ - x0_) + "\" height=\"" + twoDecimals(y0_ - y1_) +
                "\" fill=\"none\" stroke=\"#444\" stroke-width=\"0.7\"/>\n";
        const TickLabels across = tickLabels(panel_.x.range, 5), up = tickLabels(panel_.y.range, 5);
        for (std::size_t i = 0; i < across.values.size(); ++i) {
            stroke(px(across.values[i]), y0_, px(across.values[i]), y0_ + 4, "#444");
            text(px(across.values[i]), y0_ + 14, across.texts[i], "middle");
        }
        for (std::size_t i = 0; i < up.values.size(); ++i) {
            stroke(x0_ - 4, py(up.values[i]), x0_, py(up.values[i]), "#444");
            text(x0_ - 6, py(up.values[i]) + 3, up.texts[i], "end");
        }
        const auto noted = [](const FigureAxis& axis, const TickLabels& ticks) {
            return axis.title + (ticks.note.empty() ? "" : "  " + ticks.note);
        };
        text((x0_ + x1_) / 2, y0_ + 30, noted(panel_.x, across), "middle");
        text(x0_ - 46, (y0_ + y1_) / 2, noted(panel_.y, up), "middle", -90);
        text(x0_, y1_ - (panel_.note.empty() ? 7 : 13), panel_.title, "start");
        if (!panel_.note.empty()) text(x0_, y1_ - 4, panel_.note, "start");
    }
    /// Dark text with a light outline, legible on any colour.
    void haloed(const std::vector<glm::dvec2>& points) {
        std::string path;
        for (const glm::dvec2& point : points)
            path += (path.empty() ? "M" : "L") + twoDecimals(px(point.x)) + " " + twoDecimals(py(point.y));
        for (const char* stroke : {"stroke=\"white\" stroke-opacity=\"0.5\" stroke-width=\"1.8\"",
                                   "class=\"contour\" stroke=\"#111\" stroke-width=\"0.7\""})
            out_ += "<path d=\"" + path + "\" fill=\"none\" " + stroke + "/>\n";
    }
    void label(const FigureLabel& label) {
        const std::string x = twoDecimals(px(label.at.x)), y = twoDecimals(py(label.at.y));
        out_ += "<text class=\"contour\" x=\"" + x + "\" y=\"" + y + "\" dy=\"0.35em\" text-anchor=\"middle\"" +
                " transform=\"rotate(" + twoDecimals(label.angle) + " " + x + " " + y +
                ")\" stroke=\"white\" stroke-opacity=\"0.5\" stroke-width=\"1.8\" paint-order=\"stroke\">" +
                escaped(label.text) + "</text>\n";
    }
    void bars(const FigureSeries& series) {
        if (series.points.size() < 2) return;
        const double half = (px(series.points[1].x) - px(series.points[0].x)) / 2;
        for (const glm::dvec2& bar : series.points) {
            if (!(bar.y > 0)) continue;
            const double top = std::max(py(bar.y), y1_);
            out_ += "<rect x=\"" + twoDecimals(px(bar.x) - half) + "\" y=\"" + twoDecimals(top) + "\" width=\"" +
                    twoDecimals(2 * half) + "\" height=\"" + twoDecimals(y0_ - top) + "\" fill=\"" +
                    colorOf(series.color) + "\"/>\n";
        }
    }
    void line(const FigureSeries& series) {
        std::string path;
        bool down = false;
        for (const glm::dvec2& point : series.points) {
            const bool is = std::isfinite(point.x) && std::isfinite(point.y);
            if (is) path += (down ? "L" : "M") + twoDecimals(px(point.x)) + " " + twoDecimals(py(point.y));
            down = is;
        }
        out_ +=
            "<path d=\"" + path + "\" fill=\"none\" stroke=\"" + colorOf(series.color) + "\" stroke-width=\"1.2\"/>\n";
        if (!series.dots) return;
        for (const glm::dvec2& point : series.points) ring(point, 1.8, colorOf(series.color), "none");
    }
    void ring(const glm::dvec2& at, double radius, const std::string& fill, const std::string& stroke) {
        if (!std::isfinite(at.x) || !std::isfinite(at.y)) return;
        out_ += "<circle cx=\"" + twoDecimals(px(at.x)) + "\" cy=\"" + twoDecimals(py(at.y)) + "\" r=\"" +
                twoDecimals(radius) + "\" fill=\"" + fill + "\" stroke=\"" + stroke + "\" stroke-width=\"1.2\"/>\n";
    }
    /// Embeds a picture with one pixel per cell, scaled without smoothing.
    void image() {
        const FigureImage& image = panel_.image;
        if (image.width <= 0 || image.height <= 0) return;
        out_ += "<image x=\"" + twoDecimals(x0_) + "\" y=\"" + twoDecimals(y1_) + "\" width=\"" +
                twoDecimals(x1_ - x0_) + "\" height=\"" + twoDecimals(y0_ - y1_) +
                "\" preserveAspectRatio=\"none\" image-rendering=\"pixelated\" xlink:href=\"data:image/png;base64," +
                base64(vis::encodePng({{image.width, image.height}, image.rgba})) + "\"/>\n";
    }
    void legend() {
        if (panel_.series.size() < 2) return;
        double y = y1_ + 12;
        for (const FigureSeries& series : panel_.series) {
            out_ += "<rect x=\"" + twoDecimals(x1_ - 12) + "\" y=\"" + twoDecimals(y - 6) +
                    "\" width=\"8\" height=\"4\" fill=\"" + colorOf(series.color) + "\"/>\n";
            text(x1_ - 15, y, series.name, "end");
            y += 11;
        }
    }

    const FigurePanel& panel_;
    double x0_, x1_, y0_, y1_;
    std::string out_;
};

} // namespace

double figureTextWidth(const std::string& text) {
    double width = 0; // in em: Helvetica's digits are wider than its points and minus signs
    for (const char c : text) width += c == '.' ? 0.28 : c == '-' ? 0.34 : 0.56;
    return width * kFigureText;
}

std::string figureSvg(const std::vector<FigurePanel>& panels, int columns) {
    const int across = std::max(1, std::min(columns, static_cast<int>(panels.size())));
    const int rows = (static_cast<int>(panels.size()) + across - 1) / across;
    const std::string width = twoDecimals(across * kWidth), height = twoDecimals(std::max(1, rows) * kHeight);
    std::string out =
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"" + width +
        "pt\" height=\"" + height + "pt\" viewBox=\"0 0 " + width + " " + height +
        "\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"" + twoDecimals(kFigureText) +
        "\" fill=\"#222\">\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
    for (std::size_t i = 0; i < panels.size(); ++i)
        out += Panel(panels[i], static_cast<int>(i) % across * kWidth, static_cast<int>(i) / across * kHeight).svg();
    return out + "</svg>\n";
}

std::string withDescription(std::string svg, const std::string& numbers) {
    std::string text = "<desc>numbers: ";
    for (const char c : numbers) text += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
    const std::size_t at = svg.find("<rect ");
    return at == std::string::npos ? svg : svg.insert(at, text + "</desc>\n");
}

std::string csvField(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
}

std::string csvNumber(double value) {
    if (!std::isfinite(value)) return {};
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

void exportMenu(ViewContext& context, const std::string& title, std::function<std::string(const Progress&)> svg,
                std::function<std::string(const Progress&)> csv) {
    std::string name = title; // as a file
    std::replace(name.begin(), name.end(), '/', '_');
    const auto described = [&]() -> ViewExport { // tables and pictures state the origin of their numbers
        if (!context.numbers) return {name, svg, csv};
        const std::string origin = originText(context.origin, context.numbers->info());
        ViewExport made{name, {}, {}};
        if (csv)
            made.csv = [csv, origin](const Progress& progress) {
                return "# numbers: " + origin + "\n" + csv(progress);
            };
        if (svg) made.svg = [svg, origin](const Progress& progress) { return withDescription(svg(progress), origin); };
        return made;
    };
    if (context.offerExport) context.offerExport(described());
    ImGui::BeginDisabled(!context.exportText);
    if (ImGui::Button("Export")) ImGui::OpenPopup("export");
    ImGui::EndDisabled();
    if (!ImGui::BeginPopup("export")) return;
    const ViewExport made = described();
    if (ImGui::MenuItem("Picture (PNG)...") && context.runCommand) context.runCommand("Save picture...");
    if (made.svg && ImGui::MenuItem("Vector graphics (SVG)...")) context.exportText(name + ".svg", made.svg);
    if (made.csv && ImGui::MenuItem("Copy table (CSV)"))
        context.jobs.start("copy " + title, "Copying " + title,
                           [csv = made.csv](const Progress& progress) -> Jobs::Finish {
                               return [text = csv(progress)] { ImGui::SetClipboardText(text.c_str()); };
                           });
    if (made.csv && ImGui::MenuItem("Table (CSV)...")) context.exportText(name + ".csv", made.csv);
    ImGui::EndPopup();
}

} // namespace tessera::app
