#pragma once

#include "codec/fitted/fitted_weights.h"
#include "codec/fitted/pass_rows.h"

#include <cstdint>
#include <vector>

/// Weights by least squares, one set for each class of activity.
namespace tessera::codec {

/// Largest code width in bits for which all sums are exact, so that their order does not matter.
inline constexpr int kBitsOfFit = 16;

class WeightFit {
public:
    WeightFit();
    /// Adds the samples of a row of a pass. `shift`: as for predictRow.
    template <class Word> void add(int level, PassRows<Word>& rows, int z, int y, const Word* samples, int shift);
    void add(const WeightFit& other);
    /// The weights of all passes that samples were added for; of others, those of plainWeights, as another frame may
    /// need them.
    FittedWeights solved() const;

private:
    /// Sums of products of the differences of all taps from the guess, 1, and the difference of the sample.
    struct Sums {
        double count = 0;
        std::vector<double> products; ///< upper triangle of a square matrix
    };
    std::vector<Sums> sums_; ///< [place of the pass * kActivityClasses + class]
};

} // namespace tessera::codec
