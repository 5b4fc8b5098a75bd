#pragma once

#include "vis/bricks/residency.h"
#include "vis/demand/choose_bricks.h"
#include "vis/demand/hidden_bricks.h"
#include "vis/view/render_tools.h"
#include "volume/base/cached.h"

namespace tessera::vis {

/// The channels of a plan's fields at a time: one stored time each or, between two stored times, all at the earlier one
/// followed by all at the later one. A channel that is computed between stored times is at that time in both.
struct PlanFrames {
    std::vector<ChannelKey> keys;
    std::vector<double> weights; ///< weight of the later time per field; empty: all at stored times
};

/// Everything that the choice of bricks depends on.
struct DemandKey {
    Scene scene;
    DemandSettings settings;
    std::vector<ChannelKey> frames;
    std::vector<ChannelKey> known;       ///< channels whose summary is known
    std::optional<std::uint64_t> hidden; ///< HiddenInView::revision(); none: occlusion is not used
    bool operator==(const DemandKey&) const = default;
};

/// The stage that requests the data of a picture and binds its plan to the resident part.
class ViewDemand {
public:
    /// Requests what the plan samples and binds the plan to resident data; false if it cannot be drawn yet. `hidden`:
    /// bricks occluded in the last picture, null if unusable. Sets the missing bricks in `status`.
    bool bind(Residency& residency, const RenderCall& call, const HiddenInView* hidden, FrameStatus& status);
    /// Chooses bricks again for the times shown last; true if the choice changed.
    bool chooseAgain(const Residency& residency, const RenderCall& call, const HiddenInView* hidden) {
        return choose(residency, call, hidden, frames_);
    }
    /// Restricts the demand to the most urgent fraction of bricks; less than 1 for probing pictures.
    void setShare(double share) { share_ = share; }
    bool probing() const { return share_ < 1; }

    /// Cell edge of the finest level wanted, in full-resolution cells.
    double cell() const { return cell_; }
    /// The time shown, and the channels at it; none before the first picture.
    std::optional<double> time() const { return time_; }
    const std::vector<ChannelKey>& frames() const { return frames_; }

private:
    struct RangesKey {
        std::vector<ChannelKey> frames;
        std::uint64_t resident = 0; ///< Residency::revision()
        bool operator==(const RangesKey&) const = default;
    };
    using Demands = std::vector<std::shared_ptr<const BrickDemand>>; ///< per field of the plan

    bool choose(const Residency& residency, const RenderCall& call, const HiddenInView* hidden,
                const std::vector<ChannelKey>& frames);
    PlanFrames wantFrames(Residency& residency, const RenderCall& call, const HiddenInView* hidden);
    PlanFrames showFrames(Residency& residency, const RenderCall& call, const PlanFrames& wanted, double& time,
                          bool& mixed) const;
    void wantNext(Residency& residency, const RenderCall& call, bool settled);
    void bindRanges(const Residency& residency, RayPlan& plan, const std::vector<ChannelKey>& frames);

    volume::Cached<DemandKey, Demands> chosen_;
    Demands demands_; ///< last choice; equal demands keep their address
    double cell_ = 1, share_ = 1;
    std::optional<double> time_;
    bool mixed_ = false; ///< what is computed between stored times was mixed instead
    std::vector<ChannelKey> frames_;
    int wantedTime_ = -1, timeStep_ = 0; ///< direction of an animation, in stored times
    /// United over parts and both times, per field.
    volume::Cached<RangesKey, std::vector<BlockRanges>> ranges_;
};

} // namespace tessera::vis
