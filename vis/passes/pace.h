#pragma once

#include "vis/gl/draw_timer.h"

namespace tessera::vis {

/// What drawing a view costs, and what of its next picture fits into a budget. Times in milliseconds, areas in pixels
/// of the picture at rest. Where the driver has timer queries it is not waited for: what was drawn before is measured
/// later, and no more is given to it than is expected to fit.
class Pace {
public:
    explicit Pace(bool timerQueries) : timer_(timerQueries) {}
    Pace(const Pace&) = delete; // measurements come back to it
    Pace& operator=(const Pace&) = delete;

    /// A call of the renderer begins. False where the driver is so far behind that nothing should be added.
    bool beginCall();
    /// Takes in what has been measured; `wait`: all of it.
    void collect(bool wait) { timer_.collect(wait); }
    /// Whether more of `area` pixels fit where so much of the budget is left by the clock.
    bool fits(double area, double left) const;

    /// Whether anything was measured.
    bool known() const { return perPixel_ > 0; }
    /// What a full pass over so many pixels costs; 0 where nothing was measured.
    double expected(double area) const { return perPixel_ * area; }

    /// How a reduced picture is drawn: 1 / shrink of the pixels along each axis, steps so many times as long.
    struct Reduction {
        double shrink = 6, stepFactor = 2;
    };
    /// The least that makes a picture of so many pixels fit; the first of a view is a guess. `geometry`: with
    /// rasterised layers.
    Reduction reduction(double area, double budget, bool geometry) const;
    /// Draws the rasterised geometry of a reduced picture.
    void timeGeometry(const std::function<void()>& draw);
    /// Draws the rays of a reduced picture, `area` pixels of its own.
    void timeReduced(const std::function<void()>& draw, double stepFactor, double area);

    /// A full pass begins: tiles as large as a third of the budget allows, which stay so until it is done; or, where
    /// the picture is waited for, large ones.
    void beginPass(bool wait, double budget);
    int tileEdge() const { return tileEdge_; }
    /// Draws a tile of the pass; one of a further pass of a supersampled still does not count.
    void timeTile(const std::function<void()>& draw, double area, bool counts);
    /// All tiles of the pass are drawn: `area` pixels of a picture of `whole`.
    void finishPass(double area, double whole);
    /// The last full pass, as if it had gone over the whole picture; of one under way what is known of it.
    double pass() const { return pass_ * scale_; }

private:
    void learn(double perPixel) { perPixel_ = known() ? 0.5 * (perPixel_ + perPixel) : perPixel; }
    void tookTile(double milliseconds, double area, int pass);
    void settle();

    DrawTimer timer_;
    double perPixel_ = 0; ///< of a full pass; 0 = not measured
    double geometry_ = 0; ///< of a reduced picture
    double given_ = 0;    ///< expected cost of what was given to the driver in this call, with timer queries
    int passNumber_ = 0;
    double pass_ = 0, measured_ = 0; ///< of it so far: time, and area
    double area_ = 0, scale_ = 1;    ///< of a finished pass: area, and factor to the whole picture; 0: not finished
    int tileEdge_ = 256;
};

} // namespace tessera::vis
