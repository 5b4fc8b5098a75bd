#pragma once

#include "app/callouts/callout_layout.h"
#include "app/callouts/callout_picture.h"
#include "app/pane/axes3d.h"

#include <memory>
#include <string>
#include <vector>

/// The callouts of a volume view: in columns at its sides, joined to their placeholders by lines, one enlarged under
/// the mouse.
namespace tessera::app {

/// What stays while something moves.
struct CalloutsCache {
    std::vector<std::unique_ptr<CalloutState>> states; ///< by place in the session's list
    std::vector<CalloutSlot> slots;
    std::vector<std::size_t> shown; ///< to which callouts these belong
    std::vector<CalloutBox> taken;  ///< by other things at the sides of the picture, in the former frame
    int held = -1;                  ///< callout under the mouse or held
};

class CalloutsBeside {
public:
    CalloutsBeside(ViewContext& context, CalloutsCache& cache, bool shown, const PictureBox& picture, std::string pane);

    /// Takes the mouse over callouts; before the item of the picture, which lies below. `free`: nothing else holds it.
    /// True while something moves.
    bool take(const SpaceFrame& space, bool free);

    /// Whether the mouse lies over one, as found by `take`, or holds it.
    bool held() const { return !context_.session.callouts.empty() && cache_.held >= 0; }

    /// Finds their places beside what is `taken`, to which the boxes are added.
    void reserve(const SpaceFrame& space, bool moving, Rectangles& taken);
    /// Draws them there, over the picture of a scene and its axes.
    void draw(const SpaceFrame& space, const vis::Scene& view, bool moving);

private:
    struct Shown {
        std::size_t index = 0; ///< in the session's list
        CalloutPlace place;
        glm::vec2 anchor{0};
        bool seen = false; ///< the anchor is before the eye
    };
    void place(const SpaceFrame& space, bool moving);
    PictureBox boxOf(std::size_t at) const;
    PictureBox innerOf(const PictureBox& box) const;
    CalloutPart partOf(std::size_t at) const;
    void hold(bool free);
    bool takeOne(std::size_t at);
    void drawLine(ImDrawList& draw, const SpaceFrame& space, std::size_t at) const;
    void drawFrame(ImDrawList& draw, const SpaceFrame& space, const Shown& shown) const;
    void drawBox(ImDrawList& draw, std::size_t at, const vis::Scene& view, bool moving);
    void sayHidden(ImDrawList& draw) const;

    ViewContext& context_;
    CalloutsCache& cache_;
    bool wanted_;
    PictureBox picture_;
    std::string pane_;
    std::vector<Shown> shown_;
    std::size_t beyond_ = 0; ///< callouts beyond kMostCallouts
    CalloutLayout layout_;
};

} // namespace tessera::app
