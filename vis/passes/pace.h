#pragma once

namespace tessera::vis {

/// What drawing a view has cost, and what of its next picture fits into a budget. Times in milliseconds, areas in
/// pixels of the picture at rest.
class Pace {
public:
    /// Whether anything was measured.
    bool known() const { return perPixel_ > 0; }
    /// What a full pass over so many pixels costs; 0 where nothing was measured.
    double expected(double area) const { return perPixel_ * area; }

    /// How a reduced picture is drawn: 1 / shrink of the pixels along each axis, steps so many times as long.
    struct Reduction {
        double shrink = 6, stepFactor = 2;
    };
    /// The least that makes a picture of so many pixels fit; the first of a view is a guess.
    Reduction reduction(double area, double budget) const;
    /// A reduced picture took so long: its rasterised geometry, and its rays over `area` pixels of its own.
    void tookReduced(double geometry, double rays, double stepFactor, double area);

    /// A full pass begins: tiles as large as a third of the budget allows, which stay so until it is done; or, where
    /// the picture is waited for, large ones.
    void beginPass(bool wait, double budget);
    int tileEdge() const { return tileEdge_; }
    void tookTile(double milliseconds) { pass_ += milliseconds; }
    /// The pass is done, over `area` pixels of a picture of `whole`.
    void finishPass(double area, double whole);
    /// The last full pass, as if it had gone over the whole picture; of one under way what it took so far.
    double pass() const { return pass_; }

private:
    double perPixel_ = 0; ///< of a full pass; 0 = not measured
    double geometry_ = 0; ///< of a reduced picture
    double pass_ = 0;
    int tileEdge_ = 256;
};

} // namespace tessera::vis
