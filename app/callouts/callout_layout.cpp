#include "app/callouts/callout_layout.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>

namespace tessera::app {

namespace {

constexpr double kKeptLength = 4.0 / 3; ///< of the shortest lines: up to there a layout is kept
constexpr double kUneven = 0.1;         ///< penalty for a box more in one column, in widths of the picture

int rowsOf(const CalloutBox& column, const CalloutRoom& room) {
    if (column.empty() || column.max.x - column.min.x < room.least.x) return 0;
    return std::max(0, int((column.max.y - column.min.y + room.gap) / (room.least.y + room.gap)));
}

/// The boxes of a column with `count` rows, each in the middle of an equal part of it.
CalloutBox rowBox(const CalloutBox& column, int row, int count, const CalloutRoom& room) {
    const float part = (column.max.y - column.min.y + room.gap) / float(count);
    const float height = std::floor(std::min(part - room.gap, room.most));
    const float top = std::round(column.min.y + part * float(row) + (part - room.gap - height) / 2);
    return {{column.min.x, top}, {column.max.x, top + height}};
}

CalloutLayout layoutFrom(std::vector<CalloutSlot> slots, const CalloutRoom& room) {
    CalloutLayout layout;
    const int right = int(std::ranges::count_if(slots, &CalloutSlot::right)), left = int(slots.size()) - right;
    for (const CalloutSlot& slot : slots)
        layout.boxes.push_back(slot.right ? rowBox(room.right, slot.row, right, room)
                                          : rowBox(room.left, slot.row, left, room));
    layout.slots = std::move(slots);
    return layout;
}

double lengthOfLines(const CalloutLayout& layout, const std::vector<glm::vec2>& anchors) {
    double length = 0;
    for (std::size_t i = 0; i < layout.slots.size(); ++i) length += double(glm::distance(layout.port(i), anchors[i]));
    return length;
}

bool anyCross(const CalloutLayout& layout, const std::vector<glm::vec2>& anchors) {
    for (std::size_t i = 0; i < layout.slots.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (linesCross(layout.port(i), anchors[i], layout.port(k), anchors[k])) return true;
    return false;
}

/// The shortest lines from `left` and `right` rows to as many anchors: the best set of anchors for the first rows, by
/// the best for one row fewer.
CalloutLayout shortestLines(const std::vector<glm::vec2>& anchors, int left, int right, const CalloutRoom& room) {
    const int count = left + right;
    std::vector<CalloutSlot> rows;
    for (int i = 0; i < count; ++i) rows.push_back({i >= left, i >= left ? i - left : i});
    const CalloutLayout all = layoutFrom(rows, room);
    const std::uint32_t sets = 1u << count;
    std::vector<double> length(sets, std::numeric_limits<double>::infinity());
    std::vector<int> last(sets, 0);
    length[0] = 0;
    for (std::uint32_t set = 1; set < sets; ++set) {
        const int row = std::popcount(set) - 1;
        last[set] = std::countr_zero(set); // of anchors without end, too
        for (int i = 0; i < count; ++i) {
            if (!(set >> i & 1u)) continue;
            const double own =
                length[set ^ (1u << i)] + double(glm::distance(all.port(std::size_t(row)), anchors[std::size_t(i)]));
            if (own < length[set]) length[set] = own, last[set] = i;
        }
    }
    std::vector<CalloutSlot> slots(std::size_t(count), CalloutSlot{});
    for (std::uint32_t set = sets - 1; set != 0; set ^= 1u << last[set])
        slots[std::size_t(last[set])] = rows[std::size_t(std::popcount(set) - 1)];
    return layoutFrom(std::move(slots), room);
}

/// Callouts with one anchor stand in their order: exchanging them leaves the lines as they are.
void sortEqual(CalloutLayout& layout, const std::vector<glm::vec2>& anchors) {
    const auto before = [](const CalloutSlot& a, const CalloutSlot& b) {
        return a.right != b.right ? b.right : a.row < b.row;
    };
    for (std::size_t i = 0; i < layout.slots.size(); ++i)
        for (std::size_t k = i + 1; k < layout.slots.size(); ++k)
            if (anchors[i] == anchors[k] && before(layout.slots[k], layout.slots[i])) {
                std::swap(layout.slots[i], layout.slots[k]);
                std::swap(layout.boxes[i], layout.boxes[k]);
            }
}

/// Whether slots fill the rows of both columns without gaps, as many as have room.
bool suits(const std::vector<CalloutSlot>& slots, std::size_t count, const CalloutRoom& room) {
    if (slots.size() != count) return false;
    const int right = int(std::ranges::count_if(slots, &CalloutSlot::right)), left = int(count) - right;
    if (left > rowsOf(room.left, room) || right > rowsOf(room.right, room)) return false;
    std::vector<char> taken(count, 0);
    for (const CalloutSlot& slot : slots) {
        if (slot.row < 0 || slot.row >= (slot.right ? right : left)) return false;
        char& own = taken[std::size_t(slot.right ? left + slot.row : slot.row)];
        if (own) return false;
        own = 1;
    }
    return true;
}

} // namespace

glm::vec2 CalloutLayout::port(std::size_t callout) const {
    const CalloutBox& box = boxes[callout];
    return {slots[callout].right ? box.min.x : box.max.x, (box.min.y + box.max.y) / 2};
}

CalloutRoom calloutRoom(glm::vec2 min, glm::vec2 max, const std::vector<CalloutBox>& taken, float em) {
    const glm::vec2 size = max - min;
    CalloutRoom room{.least = {em * 5.5f, em * 4.5f}, .gap = std::round(em * 0.6f)};
    const float margin = std::round(em * 0.5f);
    const float width = std::round(std::clamp(size.x * 0.25f, room.least.x, em * 24));
    if (size.x < 2 * width + em * 6 || size.y < room.least.y + 2 * margin + em * 2) return room;
    room.most = std::round(width * 0.95f + em * 1.5f);
    const auto column = [&](float left) {
        CalloutBox box{{left, min.y + margin}, {left + width, max.y - margin}};
        for (const CalloutBox& other : taken) {
            if (other.max.x <= box.min.x - margin || other.min.x >= box.max.x + margin) continue;
            if (other.min.y + other.max.y < min.y + max.y)
                box.min.y = std::max(box.min.y, other.max.y + margin);
            else
                box.max.y = std::min(box.max.y, other.min.y - margin);
        }
        return box;
    };
    room.left = column(min.x + margin);
    room.right = column(max.x - margin - width);
    return room;
}

bool linesCross(glm::vec2 a, glm::vec2 b, glm::vec2 c, glm::vec2 d) {
    const auto side = [](glm::dvec2 p, glm::dvec2 q, glm::dvec2 r) {
        return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    };
    const double ca = side(a, b, c), da = side(a, b, d), ac = side(c, d, a), bc = side(c, d, b);
    return ca * da < 0 && ac * bc < 0;
}

CalloutLayout placeCallouts(const std::vector<glm::vec2>& anchors, const CalloutRoom& room,
                            const std::vector<CalloutSlot>& before, bool moving) {
    const int mostLeft = rowsOf(room.left, room), mostRight = rowsOf(room.right, room);
    const int count = std::min(int(anchors.size()), mostLeft + mostRight);
    const std::vector<glm::vec2> placed(anchors.begin(), anchors.begin() + count);
    const bool known = suits(before, placed.size(), room);
    if (known && moving)
        if (CalloutLayout kept = layoutFrom(before, room); !anyCross(kept, placed)) return kept;
    CalloutLayout best;
    double least = std::numeric_limits<double>::infinity();
    const double width = double(std::max(room.right.max.x - room.left.min.x, 1.0f));
    for (int left = std::max(0, count - mostRight); left <= std::min(count, mostLeft); ++left) {
        CalloutLayout own = shortestLines(placed, left, count - left, room);
        const double uneven = std::max(0, std::abs(count - 2 * left) - 1) * kUneven * width;
        const double length = lengthOfLines(own, placed) + uneven;
        if (length < least) least = length, best = std::move(own);
    }
    sortEqual(best, placed);
    if (!known) return best;
    CalloutLayout kept = layoutFrom(before, room);
    const bool good = lengthOfLines(kept, placed) <= kKeptLength * lengthOfLines(best, placed);
    return good && !anyCross(kept, placed) ? kept : best;
}

} // namespace tessera::app
