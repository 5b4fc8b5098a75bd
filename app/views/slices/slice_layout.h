#pragma once

#include "app/planes/contour_data.h"

#include <array>
#include <glm/vec3.hpp>
#include <imgui.h>

/// Where the three slices of a pane lie, and the numbers at the cross-hair.
namespace tessera::app {

/// The three slices of a view, in its order.
inline constexpr std::array<SliceAxes, 3> kSlicePlanes{{{0, 1, 2}, {2, 1, 0}, {0, 2, 1}}};

enum class SliceOrder { Quarters, Row, Column, Rows, Columns };

/// A part of the pane, pixels; without extent where nothing is shown.
struct SliceArea {
    ImVec2 min{0, 0}, max{0, 0};
    ImVec2 size() const { return {max.x - min.x, max.y - min.y}; }
};

struct SliceLayout {
    SliceOrder order = SliceOrder::Quarters;
    std::array<SliceArea, 3> planes; ///< by index of kSlicePlanes
    SliceArea numbers, values = {};  ///< values have a room apart from the legend where they have an extent
    bool axes = true;                ///< numbers along the slices
    std::array<SliceAxes, 3> turned = kSlicePlanes; ///< to the right and up
    std::array<bool, 3> beside{};                   ///< the place of the slice stands at the right of it, not above
    std::array<bool, 3> shared{};                   ///< the slice below has the numbers of its lower axis
};

/// Places them in a pane of `room` pixels whose box has these half sizes. Quarters, so that slices share their axes. A
/// box with one long edge has the slices along it below each other in rows, or upright in columns, and in a small pane
/// slices lie in a row or a column, where they are much larger so; without axes where these would take most of the
/// room. `em`: height of the font. `whole`: always quarters with axes, as in figures.
SliceLayout sliceLayout(ImVec2 min, ImVec2 room, glm::dvec3 half, float em, bool whole = false);

/// The least side of the room for a picture, pixels: slices along a long edge have no more than their pictures need.
float leastPicture(const SliceLayout& layout, float em);

/// What the place of a slice and its axes take around its picture, in em, where the axes alone take this much.
struct SliceMargins {
    float left, top, right, bottom;
};
SliceMargins sliceMargins(const SliceLayout& layout, int index, float leftAxis, float bottomAxis);

} // namespace tessera::app
