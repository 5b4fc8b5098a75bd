#include "codec/brick/quantum_search.h"

#include <algorithm>
#include <cmath>

namespace tessera::codec {

std::optional<double> QuantumSearch::next(double quantum, double coded, double fixed) {
    constexpr double kClose = 0.9333, kAim = 0.977; // parts of the sum: 0.3 dB and 0.1 dB
    constexpr double kLeastPower = 0.4, kMostPower = 2.2, kFurthest = 8, kSame = 1.003, kNoChange = 1.01, kMargin = 0.1;
    const Trial trial{quantum, coded}, before = latest_;
    latest_ = trial;
    const double apart = before.quantum > 0 ? std::log(quantum / before.quantum) : 0;
    if (coded > 0 && before.coded > 0 && apart != 0)
        power_ = std::clamp(std::log(coded / before.coded) / apart, kLeastPower, kMostPower);

    const bool fits = coded + fixed <= allowed_;
    // The error does not grow any more: nothing but the fixed part is left, or nothing is coded.
    const bool isFlat = before.quantum > 0 && apart > std::log(2.0) && coded <= kNoChange * before.coded;
    if (fits && quantum > best_.quantum) best_ = trial;
    if (!fits && (above_.quantum == 0 || quantum < above_.quantum)) above_ = trial;
    if (fits && (coded + fixed >= kClose * allowed_ || isFlat || quantum >= largest_)) return std::nullopt;
    const double aim = std::max(kAim * allowed_ - fixed, (allowed_ - fixed) / 2);
    if (--trials_ <= 0 || aim <= 0) return std::nullopt;

    if (best_.quantum == 0 || above_.quantum == 0) {
        const double factor = coded > 0 ? std::pow(aim / coded, 1 / power_) : kFurthest;
        const double next = quantum * std::clamp(factor, 1 / kFurthest, kFurthest);
        return std::min(next, largest_);
    }
    // Between a quantum that fits and a larger one that does not, errors may grow in jumps.
    const double all = std::log(above_.quantum / best_.quantum);
    if (all < std::log(kSame)) return std::nullopt; // or the errors do not even grow
    const double inside = best_.coded > 0 ? std::log(aim / best_.coded) / std::log(above_.coded / best_.coded) : 0.5;
    return best_.quantum * std::exp(all * std::clamp(inside, kMargin, 1 - kMargin));
}

} // namespace tessera::codec
