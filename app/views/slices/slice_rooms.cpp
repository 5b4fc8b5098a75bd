#include "app/views/slices/slice_rooms.h"

#include "app/views/slices/slice_figure.h"

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>

namespace tessera::app {

namespace {

constexpr glm::vec2 kRoomy{20, 14};       // em: from here on always quarters
constexpr glm::vec2 kAround{4, 2.8f};     // em: what axes and head line of a slice take
constexpr glm::vec2 kAroundBare{1, 1.6f}; // em: the head line alone
constexpr float kNumbers = 26;            // em: width from which on there are numbers beside a row
constexpr double kMuchLarger = 1.3;

/// Size of the first of two columns or rows whose plots share `room` in proportion to the box, none too narrow to
/// read; each has `around` pixels of axes besides.
float split(double first, double second, float room, float around, double least) {
    const double share = first + second > 0 ? first / (first + second) : 0.5;
    const float plots = std::max(0.0f, room - 2 * around);
    return std::round(around + plots * static_cast<float>(std::clamp(share, least, 1 - least)));
}

SliceRooms quarters(ImVec2 min, ImVec2 room, glm::dvec3 half, float em) {
    const ImVec2 max{min.x + room.x, min.y + room.y};
    const float columns = split(half.x, half.z, room.x, em * 3.2f, 0.3);
    // The head lines of both columns need some room.
    const float least = std::min(em * 12.5f, room.x / 2);
    const float x = min.x + std::clamp(columns, least, std::max(least, room.x - em * 8)),
                y = min.y + split(half.y, half.z, room.y, std::min(em * 2.8f, room.y / 4), 0.4);
    const float gap = em * 0.3f;
    return {SliceOrder::Quarters,
            {{{min, {x - gap, y - gap}}, {{x + gap, min.y}, {max.x, y - gap}}, {{min.x, y + gap}, {x - gap, max.y}}}},
            {{x + gap * 2, y + gap}, max},
            true};
}

/// Beside each other, as wide as they are high together; in a wide pane with the numbers at the end.
SliceRooms inRow(ImVec2 min, ImVec2 room, glm::dvec3 half, float em) {
    SliceRooms out{SliceOrder::Row, {}, {}, true};
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

SliceRooms inColumn(ImVec2 min, ImVec2 room, float em) {
    SliceRooms out{SliceOrder::Column, {}, {}, true};
    const float gap = em * 0.4f, height = std::floor((room.y - 2 * gap) / 3);
    for (std::size_t i = 0; i < 3; ++i) {
        const float y = min.y + (height + gap) * static_cast<float>(i);
        out.planes[i] = {{min.x, y}, {min.x + room.x, y + height}};
    }
    return out;
}

/// Pixels of the pictures of all slices.
double area(const SliceRooms& rooms, glm::dvec3 half, float em, glm::vec2 around) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const ImVec2 size = rooms.planes[i].size();
        const double wide = half[kSlicePlanes[i].right], high = half[kSlicePlanes[i].up];
        if (!(wide > 0) || !(high > 0)) continue;
        const double scale =
            std::min(std::max(0.0f, size.x - around.x * em) / wide, std::max(0.0f, size.y - around.y * em) / high);
        sum += scale * scale * wide * high;
    }
    return sum;
}

} // namespace

SliceRooms sliceRooms(ImVec2 min, ImVec2 room, glm::dvec3 half, float em, bool whole) {
    SliceRooms best = quarters(min, room, half, em);
    if (whole) return best;
    if (room.x >= kRoomy.x * em && room.y >= kRoomy.y * em) return best;
    double most = area(best, half, em, kAroundBare), least = most * kMuchLarger;
    for (const SliceRooms& other : {inRow(min, room, half, em), inColumn(min, room, em)}) {
        const double own = area(other, half, em, kAroundBare);
        if (own < least) continue;
        best = other;
        most = least = own;
    }
    best.axes = area(best, half, em, kAround) * 2 > most;
    return best;
}

} // namespace tessera::app
