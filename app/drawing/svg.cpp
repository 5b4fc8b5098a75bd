#include "app/drawing/drawing.h"

#include "app/drawing/embedded_session.h"
#include "volume/base/printable.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tessera::app {

using namespace shapes;

namespace {

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", value);
    return text;
}

/// " name="number"".
std::string attribute(const char* name, double value) {
    return std::string(" ") + name + "=\"" + number(value) + "\"";
}

/// A colour as the attribute `what`, with its opacity as another.
std::string paint(const std::string& what, const std::string& opacity, glm::vec4 color) {
    char text[16];
    const auto byte = [](float v) { return static_cast<int>(std::lround(std::clamp(v, 0.0f, 1.0f) * 255)); };
    std::snprintf(text, sizeof text, "=\"#%02x%02x%02x\"", byte(color.r), byte(color.g), byte(color.b));
    return " " + what + text + (color.a < 0.999f ? attribute(opacity.c_str(), double(color.a)) : "");
}
std::string fill(glm::vec4 color) {
    return paint("fill", "fill-opacity", color);
}
std::string stroke(glm::vec4 color, double width) {
    return paint("stroke", "stroke-opacity", color) + attribute("stroke-width", width);
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

std::string path(const std::vector<glm::dvec2>& points) {
    std::string out;
    for (const glm::dvec2& point : points) out += (out.empty() ? "M" : "L") + number(point.x) + " " + number(point.y);
    if (points.size() > 2 && points.front() == points.back()) out += "Z";
    return out;
}

std::string placed(const PageBox& box) {
    return attribute("x", box.lo.x) + attribute("y", box.lo.y) + attribute("width", box.hi.x - box.lo.x) +
           attribute("height", box.hi.y - box.lo.y);
}

/// `fill` of what is filled, else `stroke` of its edge.
std::string filledOrEdged(glm::vec4 color, double line) {
    return line > 0 ? " fill=\"none\"" + stroke(color, line) : fill(color);
}

class Writer {
public:
    explicit Writer(const VectorPage& drawing) : drawing_(drawing) {}

    std::string write() {
        const std::string width = number(drawing_.size.x), height = number(drawing_.size.y);
        std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" "
                          "width=\"" +
                          width + "pt\" height=\"" + height + "pt\" viewBox=\"0 0 " + width + " " + height + "\">\n";
        if (!drawing_.numbers.empty()) out += "<desc>numbers: " + escapedXml(printable(drawing_.numbers)) + "</desc>\n";
        if (!drawing_.session.empty()) out += sessionElement(drawing_.session);
        for (const Mark& mark : drawing_.marks) std::visit([&](const auto& shape) { draw(shape); }, mark.shape);
        return out + body_ + "</svg>\n";
    }

private:
    void draw(const Stroke& line) {
        if (line.points.size() == 2) {
            const glm::dvec2 a = line.points[0], b = line.points[1];
            body_ +=
                "<line" + attribute("x1", a.x) + attribute("y1", a.y) + attribute("x2", b.x) + attribute("y2", b.y);
        } else {
            body_ += "<path d=\"" + path(line.points) + "\" fill=\"none\" stroke-linejoin=\"round\"";
        }
        body_ += stroke(line.color, line.width) + "/>\n";
    }
    void draw(const Polygon& polygon) {
        body_ += "<path d=\"" + path(polygon.points) + "Z\"" + fill(polygon.color) + "/>\n";
    }
    void draw(const Rect& rect) { body_ += "<rect" + placed(rect.box) + filledOrEdged(rect.color, rect.line) + "/>\n"; }
    void draw(const Circle& circle) {
        body_ += "<circle" + attribute("cx", circle.center.x) + attribute("cy", circle.center.y) +
                 attribute("r", circle.radius) + filledOrEdged(circle.color, circle.line) + "/>\n";
    }
    void draw(const Words& words) {
        const Typeface& face = typeface(words.face);
        body_ += "<text" + attribute("x", words.at.x) + attribute("y", words.at.y);
        if (words.middle) body_ += attribute("dy", kMiddle * words.size);
        if (words.halo > 0) body_ += stroke(kHalo, words.halo) + " paint-order=\"stroke\"";
        if (words.anchor > 0) body_ += words.anchor < 0.75 ? " text-anchor=\"middle\"" : " text-anchor=\"end\"";
        if (words.angle != 0)
            body_ += " transform=\"rotate(" + number(words.angle) + " " + number(words.at.x) + " " +
                     number(words.at.y) + ")\"";
        body_ += std::string(" font-family=\"") + face.family + ", Helvetica, Arial, sans-serif\" font-weight=\"" +
                 face.weight + "\"" + attribute("font-size", words.size) + fill(words.color);
        body_ += " xml:space=\"preserve\">" + escapedXml(printable(words.text)) + "</text>\n";
    }
    void draw(const Picture& picture) {
        body_ += "<image" + placed(picture.box) + " preserveAspectRatio=\"none\"" +
                 (picture.smooth ? "" : " image-rendering=\"pixelated\"") + " xlink:href=\"data:image/png;base64," +
                 base64(vis::encodePng({picture.image.size, picture.image.rgba})) + "\"/>\n";
    }

    const VectorPage& drawing_;
    std::string body_;
};

} // namespace

std::string svgOf(const VectorPage& drawing) {
    return Writer(drawing).write();
}

} // namespace tessera::app
