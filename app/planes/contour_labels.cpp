#include "app/planes/contour_labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <optional>

namespace tessera::app {

namespace {

// In heights of a text, but for the first.
constexpr double kLeastLength = 2; ///< of a line that is labelled, in widths of its text
constexpr double kRepeat = 40;     ///< length of line for each further label
constexpr double kBend = 0.16;     ///< how far a line may leave the middle of its text
constexpr double kRoom = 0.3;      ///< on either side of a text
constexpr int kTries = 24;         ///< number of best places that are tested for collisions

double wedge(glm::dvec2 a, glm::dvec2 b) {
    return a.x * b.y - a.y * b.x;
}

/// A line with the length up to each of its points.
class Arc {
public:
    explicit Arc(const std::vector<glm::dvec2>& points) : points_(points) {
        for (std::size_t i = 0; i < points.size(); ++i)
            length_.push_back(i == 0 ? 0 : length_.back() + glm::distance(points[i - 1], points[i]));
    }
    double length() const { return length_.empty() ? 0 : length_.back(); }
    double upTo(std::size_t point) const { return length_[point]; }
    /// The first point that does not lie before a length.
    std::size_t pointFrom(double along) const {
        return static_cast<std::size_t>(std::ranges::lower_bound(length_, along) - length_.begin());
    }
    glm::dvec2 at(double along) const {
        const std::size_t next = std::clamp<std::size_t>(pointFrom(along), 1, points_.size() - 1);
        const double span = length_[next] - length_[next - 1];
        const double share = span > 0 ? std::clamp((along - length_[next - 1]) / span, 0.0, 1.0) : 0;
        return points_[next - 1] + (points_[next] - points_[next - 1]) * share;
    }

private:
    const std::vector<glm::dvec2>& points_;
    std::vector<double> length_;
};

std::array<glm::dvec2, 4> cornersOf(const LineLabel& label) {
    const glm::dvec2 right = glm::dvec2(std::cos(label.angle), std::sin(label.angle)) * label.half.x,
                     down = glm::dvec2(-std::sin(label.angle), std::cos(label.angle)) * label.half.y;
    return {label.at - right - down, label.at + right - down, label.at + right + down, label.at - right + down};
}

/// A place in the label's own frame.
glm::dvec2 inFrame(const LineLabel& label, glm::dvec2 point) {
    const glm::dvec2 right(std::cos(label.angle), std::sin(label.angle)), away = point - label.at;
    return {glm::dot(away, right), wedge(right, away)};
}

/// Whether a stretch of line meets the box: what is left of it after each pair of edges.
bool meets(const LineLabel& label, glm::dvec2 from, glm::dvec2 to) {
    const glm::dvec2 a = inFrame(label, from), step = inFrame(label, to) - a;
    double first = 0, last = 1;
    for (int axis = 0; axis < 2; ++axis) {
        const double half = label.half[axis];
        if (std::abs(step[axis]) < 1e-12) {
            if (std::abs(a[axis]) > half) return false;
            continue;
        }
        const double s = (-half - a[axis]) / step[axis], t = (half - a[axis]) / step[axis];
        first = std::max(first, std::min(s, t));
        last = std::min(last, std::max(s, t));
    }
    return first <= last;
}

/// Separating axis test: two boxes are disjoint if an edge of either has all of the other beyond it.
bool overlap(const LineLabel& a, const LineLabel& b) {
    const auto parted = [](const LineLabel& one, const LineLabel& other) {
        glm::dvec2 least(HUGE_VAL), most(-HUGE_VAL);
        for (const glm::dvec2 corner : cornersOf(other)) {
            const glm::dvec2 own = inFrame(one, corner);
            least = glm::min(least, own);
            most = glm::max(most, own);
        }
        return least.x > one.half.x || least.y > one.half.y || most.x < -one.half.x || most.y < -one.half.y;
    };
    return !parted(a, b) && !parted(b, a);
}

/// A label with its middle at a length of the line, and how far the line leaves the middle of its box; nothing where it
/// turns too much.
struct Candidate {
    LineLabel label;
    double cost = 0;
};
std::optional<Candidate> candidate(const PageLine& line, const Arc& arc, double along, LineLabel like, double height) {
    const double reach = like.half.x, from = along - reach, to = along + reach;
    const glm::dvec2 chord = arc.at(to) - arc.at(from);
    if (glm::length(chord) < 0.95 * 2 * reach) return std::nullopt;
    like.along = along;
    like.at = arc.at(along);
    like.angle = std::atan2(chord.y, chord.x);
    if (like.angle > std::numbers::pi / 2) like.angle -= std::numbers::pi;
    if (like.angle <= -std::numbers::pi / 2) like.angle += std::numbers::pi;
    double bend = std::max(std::abs(inFrame(like, arc.at(from)).y), std::abs(inFrame(like, arc.at(to)).y));
    for (std::size_t i = arc.pointFrom(from); i < line.points.size() && arc.upTo(i) <= to; ++i)
        bend = std::max(bend, std::abs(inFrame(like, line.points[i]).y));
    if (bend > kBend * height) return std::nullopt;
    return Candidate{std::move(like), bend / height};
}

bool onPage(const LineLabel& label, const LabelPage& page) {
    return std::ranges::all_of(cornersOf(label), [&](glm::dvec2 corner) {
        return corner.x >= page.lo.x && corner.y >= page.lo.y && corner.x <= page.hi.x && corner.y <= page.hi.y;
    });
}

/// Whether any line but the stretch beneath it runs through the box.
bool crossed(const LineLabel& label, const std::vector<PageLine>& lines, const std::vector<Arc>& arcs) {
    const double around = glm::length(label.half);
    for (std::size_t l = 0; l < lines.size(); ++l) {
        const std::vector<glm::dvec2>& points = lines[l].points;
        for (std::size_t i = 1; i < points.size(); ++i) {
            if (l == label.line && arcs[l].upTo(i) >= label.along - label.half.x &&
                arcs[l].upTo(i - 1) <= label.along + label.half.x)
                continue;
            const glm::dvec2 least = glm::min(points[i - 1], points[i]), most = glm::max(points[i - 1], points[i]);
            if (least.x > label.at.x + around || most.x < label.at.x - around || least.y > label.at.y + around ||
                most.y < label.at.y - around)
                continue;
            if (meets(label, points[i - 1], points[i])) return true;
        }
    }
    return false;
}

} // namespace

std::vector<LineLabel> placeLabels(const std::vector<PageLine>& lines, const LabelPage& page) {
    std::vector<Arc> arcs;
    for (const PageLine& line : lines) arcs.emplace_back(line.points);
    std::vector<std::size_t> order(lines.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return arcs[a].length() > arcs[b].length(); });
    std::vector<LineLabel> out;
    for (const std::size_t l : order) {
        const double length = arcs[l].length();
        LineLabel like{.text = lines[l].text, .line = l};
        like.half = {page.width(like.text) / 2 + kRoom * page.height, page.height / 2};
        if (length < kLeastLength * 2 * like.half.x) continue;
        const int stretches = 1 + static_cast<int>(length / (kRepeat * page.height));
        for (int k = 0; k < stretches; ++k) {
            const double from = std::max(length * k / stretches, like.half.x),
                         to = std::min(length * (k + 1) / stretches, length - like.half.x);
            std::vector<Candidate> found;
            for (double along = from; along <= to; along += page.height / 2)
                if (auto each = candidate(lines[l], arcs[l], along, like, page.height)) {
                    // The middle of a stretch is where a reader looks for it.
                    each->cost += 0.2 * std::abs(along - (from + to) / 2) / (to - from + page.height);
                    found.push_back(std::move(*each));
                }
            std::ranges::stable_sort(found, {}, &Candidate::cost);
            for (std::size_t i = 0, tries = 0; i < found.size() && tries < kTries; ++i) {
                const LineLabel& label = found[i].label;
                if (!onPage(label, page)) continue;
                ++tries;
                if (crossed(label, lines, arcs) ||
                    std::ranges::any_of(out, [&](const LineLabel& other) { return overlap(label, other); }))
                    continue;
                out.push_back(label);
                break;
            }
        }
    }
    return out;
}

std::vector<std::vector<glm::dvec2>> linesAround(const std::vector<PageLine>& lines,
                                                 const std::vector<LineLabel>& labels) {
    std::vector<std::vector<glm::dvec2>> out;
    for (std::size_t l = 0; l < lines.size(); ++l) {
        const std::vector<glm::dvec2>& points = lines[l].points;
        if (points.size() < 2) continue;
        const Arc arc(points);
        std::vector<const LineLabel*> own;
        for (const LineLabel& label : labels)
            if (label.line == l) own.push_back(&label);
        std::ranges::sort(own, {}, [](const LineLabel* label) { return label->along; });
        double from = 0;
        const auto piece = [&](double to) {
            if (to <= from) return;
            std::vector<glm::dvec2>& part = out.emplace_back();
            part.push_back(arc.at(from));
            for (std::size_t i = arc.pointFrom(from); i < points.size() && arc.upTo(i) < to; ++i)
                if (arc.upTo(i) > from) part.push_back(points[i]);
            part.push_back(arc.at(to));
        };
        for (const LineLabel* label : own) {
            piece(label->along - label->half.x);
            from = label->along + label->half.x;
        }
        piece(arc.length());
    }
    return out;
}

} // namespace tessera::app
