#pragma once

#include "vis/bricks/residency.h"
#include "vis/demand/choose_bricks.h"
#include "vis/demand/hidden_bricks.h"
#include "vis/passes/render_tools.h"
#include "volume/base/cached.h"

namespace tessera::vis {

/// The frames that a plan's fields show at a time: one each or, where one lies between two stored times, two each: the
/// earlier of all, then the later of all.
struct PlanFrames {
    std::vector<ChannelKey> keys;
    std::vector<double> weights; ///< of the later frame, per field; empty: all are on stored times
};

/// What the bricks that a picture wants were chosen for.
struct DemandKey {
    Scene scene;
    DemandSettings settings;
    std::vector<ChannelKey> frames;
    std::vector<ChannelKey> known;       ///< frames of which something is known
    std::optional<std::uint64_t> hidden; ///< HiddenInView::revision(); none: nothing is taken to be hidden
    bool operator==(const DemandKey&) const = default;
};

/// The stage that asks for what a picture samples and binds its plan to what is here.
class ViewDemand {
public:
    /// Asks for what the plan samples and binds the plan to what is here; false when it cannot be drawn yet. `hidden`:
    /// what the last picture hid, null where that does not count. `status` is told what is missing.
    bool bind(Residency& residency, const RenderCall& call, const HiddenInView* hidden, FrameStatus& status);
    /// Chooses the bricks that a picture of the frames shown last needs; true when these are others than before.
    bool chooseAgain(const Residency& residency, const RenderCall& call, const HiddenInView* hidden) {
        return choose(residency, call, hidden, frames_);
    }
    /// Wants only that share of the bricks, the most urgent ones: less than 1 while a picture is only probed.
    void setShare(double share) { share_ = share; }
    bool probing() const { return share_ < 1; }

    /// Edge of a cell of the finest level wanted, in cells of full resolution.
    double cell() const { return cell_; }
    /// The time of the data shown, and the frames that are; none before something was.
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
    PlanFrames showFrames(Residency& residency, const RenderCall& call, const PlanFrames& wanted, double& time) const;
    void wantNext(Residency& residency, const RenderCall& call, bool settled);
    void bindRanges(const Residency& residency, RayPlan& plan, const std::vector<ChannelKey>& frames);

    volume::Cached<DemandKey, Demands> chosen_;
    Demands demands_; ///< chosen last, the former ones where they are equal
    double cell_ = 1, share_ = 1;
    std::optional<double> time_;
    std::vector<ChannelKey> frames_;
    int wantedTime_ = -1, timeStep_ = 0; ///< which way the time runs, in stored times
    /// Of all parts and both times, per field.
    volume::Cached<RangesKey, std::vector<BlockRanges>> ranges_;
};

} // namespace tessera::vis
