#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

/// Where callouts stand: in a column at the left and one at the right of a picture, joined to their anchors by lines
/// that do not cross. Pixels; y runs down.
namespace tessera::app {

struct CalloutBox {
    glm::vec2 min{0}, max{0};
    bool empty() const { return !(max.x > min.x && max.y > min.y); }
    bool operator==(const CalloutBox&) const = default;
};

/// The room of both columns, either may be empty, and the sizes that boxes may have.
struct CalloutRoom {
    CalloutBox left = {}, right = {};
    glm::vec2 least{0}; ///< of a box; a column takes no more boxes than have that height
    float most = 1e6f;  ///< height of a box
    float gap = 0;      ///< between the boxes of a column
};

/// The columns of a picture without what is `taken` at its upper and lower end. `em`: height of the font. Both are
/// empty in a picture that is too small.
CalloutRoom calloutRoom(glm::vec2 min, glm::vec2 max, const std::vector<CalloutBox>& taken, float em);

/// The place of a callout: its column, and how many boxes are above it there.
struct CalloutSlot {
    bool right = false;
    int row = 0;
    bool operator==(const CalloutSlot&) const = default;
};

/// Of each callout that has room, in the order of the anchors; those beyond have none.
struct CalloutLayout {
    std::vector<CalloutSlot> slots;
    std::vector<CalloutBox> boxes;
    /// Where the line of a callout begins: in the middle of the inner edge of its box.
    glm::vec2 port(std::size_t callout) const;
};

/// Whether two lines cross; lines that only touch, or share an end, do not.
bool linesCross(glm::vec2 a, glm::vec2 b, glm::vec2 c, glm::vec2 d);

/// Places as many callouts as have room, the first ones, so that the lines from boxes to anchors are shortest in total:
/// then none cross, for two that did would be longer than the two with their ends exchanged. Callouts with one anchor
/// stand in their order. Of all numbers of boxes at the left and right it takes the best, with a penalty for uneven
/// ones. `before` is kept as long as it suits the room, no lines cross, and, unless `moving`, the lines are at most a
/// third longer than the shortest.
CalloutLayout placeCallouts(const std::vector<glm::vec2>& anchors, const CalloutRoom& room,
                            const std::vector<CalloutSlot>& before = {}, bool moving = false);

} // namespace tessera::app
