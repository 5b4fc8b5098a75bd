#pragma once

#include "app/pane/view_context.h"
#include "vis/gl/plot_texture.h"

#include <list>
#include <string>

namespace tessera::app {

/// Small pictures of a channel by one transfer function each, drawn by the window's renderer one after the other while
/// nothing else is to be drawn and the mouse rests. All from one side, as a volume.
class LibraryPictures {
public:
    /// What the pictures of this frame show, `side` pixels wide and high. Pictures of other data are forgotten.
    void begin(const ViewContext& context, int channel, int side);
    /// GL name of the picture of a function, 0 while there is none; it will be drawn.
    vis::TextureName get(const vis::TransferFunction& function);
    /// Draws on one that was asked for in this frame; sets context.answers.postponed while there are more. Headless,
    /// draws all.
    void work(ViewContext& context);

private:
    struct Subject {
        std::string channel;
        int time = 0, side = 0;
        glm::dvec3 stretch{1};
        glm::vec3 background{0};
        bool operator==(const Subject&) const = default;
    };
    struct Picture {
        Subject of;
        vis::TransferFunction function;
        vis::PlotTexture texture;
        bool wanted = false; ///< in this frame
    };
    vis::Scene sceneOf(const ViewContext& context, const Picture& picture) const;
    /// Draws on a picture; true when it is done.
    bool draw(ViewContext& context, Picture& picture);

    std::shared_ptr<const volume::BrickSource> source_;
    Subject subject_;
    std::list<Picture> pictures_; ///< last asked for first
    vis::ViewTargetPtr target_;   ///< of the one that is being drawn
};

} // namespace tessera::app
