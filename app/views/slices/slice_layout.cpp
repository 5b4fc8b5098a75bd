#include "app/views/slices/slice_layout.h"

#include "app/pane/plot.h"

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

namespace tessera::app {

namespace {

constexpr glm::vec2 kRoomy{20, 14};         // em: from here on always quarters
constexpr glm::vec2 kAxesRoom{3.2f, 1.45f}; // em: what axes take at the left and below
constexpr float kApart = 1;                 // em: between slices without axes
constexpr float kTitleAside = 1.3f;         // em: an upright title at the left of an axis
constexpr float kPlaceBeside = 6.2f;        // em: the place of a slice at its right
constexpr float kNumbers = 26;              // em: width from which on there are numbers beside a row
constexpr float kValues = 2.4f;             // em: two lines of values
constexpr float kLegend = 3.7f;             // em: a legend
constexpr double kMuchLarger = 1.3;
// The longest edge of a box that is looked at along it, by the next: in a roomy pane, quarters have more room for
// numbers.
constexpr double kLongEdge = 1.8, kLongEdgeRoomy = 4;

/// What stands above the picture of a slice, in em.
float topOf(bool beside, bool axes) {
    return beside ? 0.3f : axes ? kTitleAbove : 1.35f;
}

int longestEdge(glm::dvec3 half) {
    int longest = 0;
    for (const int axis : {1, 2})
        if (half[axis] > half[longest]) longest = axis;
    return longest;
}

/// Size of the first of two columns or rows whose plots share `room` in proportion to the box, none too narrow to
/// read; each has `around` pixels of axes besides.
float split(double first, double second, float room, float around, double least) {
    const double share = first + second > 0 ? first / (first + second) : 0.5;
    const float plots = std::max(0.0f, room - 2 * around);
    return std::round(around + plots * static_cast<float>(std::clamp(share, least, 1 - least)));
}

SliceLayout quarters(ImVec2 min, ImVec2 room, glm::dvec3 half, float em) {
    const ImVec2 max{min.x + room.x, min.y + room.y};
    const float columns = split(half.x, half.z, room.x, em * 3.2f, 0.3);
    // The head lines of both columns need some room.
    const float least = std::min(em * 12.5f, room.x / 2);
    const float x = min.x + std::clamp(columns, least, std::max(least, room.x - em * 8)),
                y = min.y + split(half.y, half.z, room.y, std::min(em * 2.8f, room.y / 4), 0.4);
    const float gap = em * 0.3f;
    return {SliceOrder::Quarters,
            {{{min, {x - gap, y - gap}}, {{x + gap, min.y}, {max.x, y - gap}}, {{min.x, y + gap}, {x - gap, max.y}}}},
            {{x + gap * 2, y + gap}, max}};
}

/// Beside each other, as wide as they are high together; in a wide pane with the numbers at the end.
SliceLayout inRow(ImVec2 min, ImVec2 room, glm::dvec3 half, float em) {
    SliceLayout out{.order = SliceOrder::Row, .planes = {}, .numbers = {}};
    const ImVec2 max{min.x + room.x, min.y + room.y};
    const float gap = em * 0.6f;
    const float numbers = room.x < kNumbers * em ? 0 : std::clamp(room.x * 0.25f, em * 8, em * 14);
    const float plots = room.x - (numbers > 0 ? numbers + gap : 0) - 2 * gap;
    std::array<double, 3> wide{};
    double all = 0;
    for (std::size_t i = 0; i < 3; ++i) all += wide[i] = std::max(half[kSlicePlanes[i].right], 1e-9);
    double least = 0;
    for (double& each : wide) least += each = std::max(each / all, 0.25);
    float x = min.x;
    for (std::size_t i = 0; i < 3; ++i) {
        const float width = std::floor(plots * static_cast<float>(wide[i] / least));
        out.planes[i] = {{x, min.y}, {x + width, max.y}};
        x += width + gap;
    }
    if (numbers > 0) out.numbers = {{max.x - numbers, min.y}, max};
    return out;
}

SliceLayout inColumn(ImVec2 min, ImVec2 room, float em) {
    SliceLayout out{.order = SliceOrder::Column, .planes = {}, .numbers = {}};
    const float gap = em * 0.4f, height = std::floor((room.y - 2 * gap) / 3);
    for (std::size_t i = 0; i < 3; ++i) {
        const float y = min.y + (height + gap) * static_cast<float>(i);
        out.planes[i] = {{min.x, y}, {min.x + room.x, y + height}};
    }
    return out;
}

/// Heights of the layout of two slices below each other that share an axis, with `around` pixels above each picture and
/// those of the axis below the last. `heights`: those of their pictures where they take the whole width; less where
/// these have no room.
std::array<float, 2> rowHeights(std::array<double, 2> heights, float around, float axis, float room) {
    const float pictures = room - axis - 2 * around;
    const double sum = heights[0] + heights[1], share = sum > 0 ? heights[0] / sum : 0.5;
    const float first = sum < double(pictures) ? std::ceil(float(heights[0]))
                                               : std::round(pictures * float(std::clamp(share, 0.25, 0.75)));
    const float second = sum < double(pictures) ? std::ceil(float(heights[1])) : pictures - first;
    return {around + first, around + second + axis};
}

/// The slices along the longest edge, which all have to the right, below each other, beside the one across it with the
/// numbers below. What the slices leave of their column is the room of values. Nothing where there is no room for two
/// columns.
std::optional<SliceLayout> inRows(ImVec2 min, ImVec2 room, glm::dvec3 half, float em, bool beside, bool axes) {
    const int longest = longestEdge(half);
    const float gap = em * 0.5f, column = std::clamp(room.x * 0.3f, em * 8, em * 16);
    if (room.x < column + em * 12 || room.y < em * 7) return std::nullopt;
    SliceLayout out{.order = SliceOrder::Rows, .planes = {}, .numbers = {}, .values = {}, .axes = axes};
    const ImVec2 max{min.x + room.x, min.y + room.y};
    const double scale = (room.x - column - gap - (beside ? kPlaceBeside : 0) * em) / half[longest];
    std::array<double, 2> heights{};
    for (std::size_t i = 0, row = 0; i < 3; ++i)
        if (const SliceAxes& plane = kSlicePlanes[i]; plane.normal != longest)
            heights[row++] = scale * half[plane.right + plane.up - longest];
    const auto rows = rowHeights(heights, topOf(beside, axes) * em, (axes ? kAxesRoom.y : 0) * em, room.y - gap);
    const float values = min.y + rows[0] + rows[1] + gap;
    const bool apart = max.y - values >= kValues * em;
    const float across = std::max(room.y * 0.6f, apart ? room.y - gap - kLegend * em : 0.0f);
    float y = min.y;
    for (std::size_t i = 0, row = 0; i < 3; ++i) {
        const SliceAxes& plane = kSlicePlanes[i];
        if (plane.normal == longest) {
            out.planes[i] = {min, {min.x + column, min.y + across}};
            continue;
        }
        out.turned[i] = {longest, plane.right + plane.up - longest, plane.normal};
        out.beside[i] = beside;
        out.shared[i] = row == 0;
        out.planes[i] = {{min.x + column + gap, y}, {max.x, y + rows[row]}};
        y += rows[row++] + gap;
    }
    out.numbers = {{min.x, min.y + across + gap}, {min.x + column, max.y}};
    if (apart) out.values = {{min.x + column + gap, values}, max};
    return out;
}

/// The same upright: beside each other, above the slice across and the numbers.
std::optional<SliceLayout> inColumns(ImVec2 min, ImVec2 room, int longest, float em) {
    const float gap = em * 0.5f, low = std::clamp(room.y * 0.28f, em * 7, em * 14), width = (room.x - gap) / 2;
    if (room.y < low + em * 12 || room.x < em * 12) return std::nullopt;
    SliceLayout out{.order = SliceOrder::Columns, .planes = {}, .numbers = {}};
    const ImVec2 max{min.x + room.x, min.y + room.y};
    const float middle = max.y - low;
    float x = min.x;
    for (std::size_t i = 0; i < 3; ++i) {
        const SliceAxes& plane = kSlicePlanes[i];
        if (plane.normal == longest) {
            out.planes[i] = {{min.x, middle + gap}, {min.x + width, max.y}};
            continue;
        }
        out.turned[i] = {plane.right + plane.up - longest, longest, plane.normal};
        out.planes[i] = {{x, min.y}, {x + width, middle}};
        x += width + gap;
    }
    out.numbers = {{min.x + width + gap, middle + gap}, max};
    return out;
}

/// Pixels of the pictures of all slices.
double area(const SliceLayout& layout, glm::dvec3 half, float em) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
        const std::size_t at = std::size_t(i);
        const ImVec2 size = layout.planes[at].size();
        const double wide = half[layout.turned[at].right], high = half[layout.turned[at].up];
        if (!(wide > 0) || !(high > 0)) continue;
        const float axis = kAxesRoom.x + (layout.beside[at] ? kTitleAside : 0);
        const SliceMargins around = sliceMargins(layout, i, axis, kAxesRoom.y);
        const float apart = layout.axes ? 0 : kApart; // pictures without axes between them
        const ImVec2 left{size.x - (around.left + around.right + apart) * em,
                          size.y - (around.top + around.bottom + apart / 4) * em};
        if (std::min(left.x, left.y) < leastPicture(layout, em)) continue;
        const double scale = std::min(left.x / wide, left.y / high);
        sum += scale * scale * wide * high;
    }
    return sum;
}

/// The other arrangements of the box in a pane: along its longest edge where that is much longer than the others, and
/// in a pane that is not `roomy` a row or a column.
std::vector<SliceLayout> others(ImVec2 min, ImVec2 room, glm::dvec3 half, float em, bool roomy) {
    std::vector<SliceLayout> out;
    if (!roomy) {
        out.push_back(inRow(min, room, half, em));
        out.push_back(inColumn(min, room, em));
    }
    const int longest = longestEdge(half);
    if (half[longest] <
        (roomy ? kLongEdgeRoomy : kLongEdge) * std::max(half[(longest + 1) % 3], half[(longest + 2) % 3]))
        return out;
    for (const bool beside : {true, false})
        if (auto rows = inRows(min, room, half, em, beside, roomy)) out.push_back(*rows);
    if (auto columns = inColumns(min, room, longest, em)) out.push_back(*columns);
    return out;
}

} // namespace

float leastPicture(const SliceLayout& layout, float em) {
    return layout.order == SliceOrder::Rows ? 1 : em * 2;
}

SliceMargins sliceMargins(const SliceLayout& layout, int index, float leftAxis, float bottomAxis) {
    const bool beside = layout.beside[std::size_t(index)], shared = layout.shared[std::size_t(index)];
    SliceMargins out{0, topOf(beside, layout.axes), beside ? kPlaceBeside : 0, 0};
    if (!layout.axes) return out;
    return {leftAxis, out.top, std::max(out.right, 0.8f), shared ? 0 : bottomAxis};
}

SliceLayout sliceLayout(ImVec2 min, ImVec2 room, glm::dvec3 half, float em, bool whole) {
    SliceLayout best = quarters(min, room, half, em);
    if (whole) return best;
    const bool roomy = room.x >= kRoomy.x * em && room.y >= kRoomy.y * em;
    const auto bare = [&](SliceLayout layout) {
        layout.axes = roomy;
        return area(layout, half, em);
    };
    double most = bare(best), least = most * kMuchLarger;
    for (const SliceLayout& other : others(min, room, half, em, roomy)) {
        const double own = bare(other);
        if (own < least) continue;
        best = other;
        most = least = own;
    }
    if (roomy) return best;
    best.axes = true;
    const bool beside = std::ranges::find(best.beside, true) != best.beside.end();
    if (best.order == SliceOrder::Rows) best = *inRows(min, room, half, em, beside, true);
    if (area(best, half, em) * 2 > most) return best;
    best.axes = false;
    return best.order == SliceOrder::Rows ? *inRows(min, room, half, em, beside, false) : best;
}

} // namespace tessera::app
