#pragma once

#include "app/pane/view_context.h"
#include "vis/passes/renderer.h"

#include <memory>
#include <optional>
#include <string>

/// Difference of the values of the first layer's parameter between two variants of a comparison: variant minus
/// reference, in their unit, at the same position, drawn on the three planes through the cross-hair.
namespace tessera::app {

/// One of the two: a session and the data it shows.
struct CompareSide {
    const Session& session;
    std::shared_ptr<const volume::BrickSource> source;
};

class CompareValues {
public:
    /// Finds the difference, in the background under `jobKey` unless headless. Sets context.busy while it is on its
    /// way.
    void find(ViewContext& context, const std::string& jobKey, const CompareSide& own, const CompareSide& reference);
    /// Draws it in diverging colours from -top to top; false while there is nothing to show.
    bool draw(ViewContext& context, const Session& session, double top, glm::ivec2 size, bool moving);

    /// "T", "K": of the parameter; "" while not known.
    std::string name() const;
    std::string unit() const;
    /// The largest difference either way, 0 while not known.
    double largest() const;
    /// Why there is none: not the same unit, or nothing that differs.
    const std::string& failure() const { return state_->failure; }
    std::uint32_t texture() const { return status_.texture; }
    bool hasRenderer() const { return renderer_ != nullptr; }

private:
    /// What is subtracted from what.
    struct Query {
        std::shared_ptr<const volume::BrickSource> own, reference;
        std::string channel, referenceChannel;
        double time = 0, referenceTime = 0;
        bool operator==(const Query&) const = default;
    };
    struct State {
        std::optional<Query> wanted, answered;
        std::shared_ptr<const volume::BrickSource> difference;
        std::string failure;
    };
    std::shared_ptr<State> state_ = std::make_shared<State>();
    std::shared_ptr<const volume::BrickSource> drawnOf_;
    std::unique_ptr<vis::Renderer> renderer_;
    vis::ViewTargetPtr target_;
    vis::FrameStatus status_;
};

} // namespace tessera::app
