#pragma once

#include "vis/gl/draw_timer.h"

namespace tessera::vis {

/// Predicts the cost of drawing a view from measurements, to fit each call into a time budget. Times in milliseconds,
/// areas in pixels of the full picture. With timer queries the driver is never waited for: results arrive later, and
/// only work that is expected to fit is submitted.
class Pace {
public:
    explicit Pace(bool timerQueries) : timer_(timerQueries) {}
    Pace(const Pace&) = delete; // callbacks of measurements refer to this object
    Pace& operator=(const Pace&) = delete;

    /// Begins a call of the renderer. False if the driver has fallen so far behind that nothing should be submitted.
    bool beginCall();
    /// Collects finished measurements; `wait`: all of them.
    void collect(bool wait) { timer_.collect(wait); }
    /// Whether another `area` pixels fit, with `left` of the budget remaining by the clock.
    bool fits(double area, double left) const;

    /// Whether anything was measured.
    bool known() const { return perPixel_ > 0; }
    /// Expected cost of a full pass over `area` pixels; 0 if nothing was measured.
    double expected(double area) const { return perPixel_ * area; }

    /// How to draw a reduced picture: resolution divided by `shrink` along each axis, steps longer by `stepFactor`.
    struct Reduction {
        double shrink = 6, stepFactor = 2;
    };
    /// The smallest reduction for which a picture of `area` pixels fits the budget; a guess for the first picture of a
    /// view. `geometry`: it includes rasterised layers.
    Reduction reduction(double area, double budget, bool geometry) const;
    /// Draws and measures the rasterised geometry of a reduced picture.
    void timeGeometry(const std::function<void()>& draw);
    /// Draws and measures the rays of a reduced picture; `area` in its own pixels.
    void timeReduced(const std::function<void()>& draw, double stepFactor, double area);

    /// Begins a full pass with a tile size, fixed for the pass, that takes a third of the budget per tile; large tiles
    /// if the caller waits for the picture.
    void beginPass(bool wait, double budget);
    int tileEdge() const { return tileEdge_; }
    /// Draws and measures a tile; `counts` is false for the further passes of a supersampled frame.
    void timeTile(const std::function<void()>& draw, double area, bool counts);
    /// Ends a pass: it drew `area` of `whole` pixels of the picture.
    void finishPass(double area, double whole);
    /// Cost of the last full pass, extrapolated to the whole picture; for a pass in progress, the cost so far.
    double pass() const { return pass_ * scale_; }

private:
    void learn(double perPixel);
    void tookTile(double milliseconds, double area, int pass);
    void settle();

    DrawTimer timer_;
    double perPixel_ = 0; ///< cost of a full pass; 0 = not measured
    double geometry_ = 0; ///< cost for a reduced picture
    double given_ = 0;    ///< expected cost of work submitted in this call, with timer queries
    int passNumber_ = 0;
    double pass_ = 0, measured_ = 0; ///< of the current pass so far: time and area
    double area_ = 0, scale_ = 1; ///< of a finished pass: area, and factor to the whole picture; area 0: not finished
    int tileEdge_ = 256;
};

} // namespace tessera::vis
