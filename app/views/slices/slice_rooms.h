#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <imgui.h>

/// Where the three slices of a pane lie, and the numbers at the cross-hair.
namespace tessera::app {

enum class SliceOrder { Quarters, Row, Column };

/// A part of the pane, pixels; without extent where nothing is shown.
struct SliceRoom {
    ImVec2 min{0, 0}, max{0, 0};
    ImVec2 size() const { return {max.x - min.x, max.y - min.y}; }
};

struct SliceRooms {
    SliceOrder order = SliceOrder::Quarters;
    std::array<SliceRoom, 3> planes; ///< by index of kSlicePlanes
    SliceRoom numbers;
    bool axes = true; ///< numbers along the slices
};

/// Places them in a pane of `room` pixels whose box has these half sizes. Quarters, so that slices share their axes,
/// but in a small pane a row or a column where slices are much larger in it; without axes where these would take most
/// of the room. `em`: height of the font. `whole`: always quarters with axes, as in figures.
SliceRooms sliceRooms(ImVec2 min, ImVec2 room, glm::dvec3 half, float em, bool whole = false);

} // namespace tessera::app
