#pragma once

#include <limits>
#include <optional>

namespace tessera::codec {

/// Searches for a quantum of coefficients with which the sum of squared errors is as large as is allowed, or slightly
/// less: the caller codes with a quantum, measures, and notes what came of it.
///
/// Errors grow with a power of the quantum: with the second power of the sum of squares where all coefficients matter,
/// with less where most of them are 0.
class QuantumSearch {
public:
    static constexpr double kUsualPower = 1.6;

    /// `allowed`: the largest sum; `trials`: most of them; `largest`: quantum; `power`: with which errors grow, as
    /// known from elsewhere.
    QuantumSearch(double allowed, int trials, double largest = std::numeric_limits<double>::infinity(),
                  double power = kUsualPower)
        : allowed_(allowed), largest_(largest), trials_(trials), power_(power) {}

    /// Notes the squares of a trial: of what was coded with the quantum, and of all else, which is not affected.
    /// Returns the quantum to try next; none: the search is over.
    std::optional<double> next(double quantum, double coded, double fixed = 0);

    /// The largest quantum tried with an allowed sum; 0: none.
    double best() const { return best_.quantum; }
    /// d log(squares) / d log(quantum), measured between the latest trials.
    double power() const { return power_; }

private:
    struct Trial {
        double quantum = 0, coded = 0;
    };
    double allowed_, largest_;
    int trials_;
    double power_;
    Trial best_, latest_, above_; ///< above: of the smallest quantum with too large a sum; 0: none
};

} // namespace tessera::codec
