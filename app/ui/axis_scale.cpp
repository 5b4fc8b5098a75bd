#include "app/ui/axis_scale.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera::app {

double AxisScale::number(double place) const {
    if (!map) return place;
    const double sign = reversed ? -1 : 1;
    return sign * map->toSpace(sign * place / perUnit) * perUnit;
}

double AxisScale::place(double number) const {
    if (!map) return number;
    const double sign = reversed ? -1 : 1;
    return sign * map->toSheet(sign * number / perUnit) * perUnit;
}

bool AxisScale::operator==(const AxisScale& other) const {
    const bool same = map == other.map || (map && other.map && *map == *other.map);
    return same && perUnit == other.perUnit && reversed == other.reversed && blank == other.blank;
}

namespace {

/// Chooses ticks from round numbers to finer ones, where they keep their distance on the axis.
class ScaledTicks {
public:
    ScaledTicks(Range range, const AxisScale& scale, double length, double gap,
                const std::function<double(const std::string&)>& extent)
        : range_(range), scale_(scale), perPlace_(length / (range.hi - range.lo)), gap_(gap),
          least_(std::max(2 * gap, extent("0") / 4)),
          extent_(extent), numbers_{scale.number(range.lo), scale.number(range.hi)} {}

    TickLabels choose() {
        const double span = numbers_.hi - numbers_.lo;
        if (!(span > 0) || !std::isfinite(span) || !(perPlace_ > 0)) return {};
        const double largest = std::max(std::abs(numbers_.lo), std::abs(numbers_.hi));
        finest_ = std::max(largest * 1e-12, span * 1e-9);
        // All lies between two multiples of this step, or around 0.
        const double step = std::pow(10.0, std::ceil(std::log10(std::max(span, 1e-300))));
        const double first = std::floor(numbers_.lo / step), last = std::ceil(numbers_.hi / step);
        for (double i = first; i <= last; ++i) add(i * step, step);
        for (double i = first; i < last; ++i) divide(i * step, step);
        std::ranges::sort(ticks_, {}, &Tick::place);
        TickLabels out;
        for (Tick& tick : ticks_) {
            out.values.push_back(tick.place);
            out.texts.push_back(std::move(tick.text));
        }
        return out;
    }

private:
    struct Tick {
        double place, half; ///< half the extent of its text
        std::string text;
    };

    /// A multiple of `step` as a tick; nothing outside of the range or too near to another one.
    std::optional<Tick> fitting(double number, double step, const std::vector<Tick>& beside) const {
        const double slack = 1e-9 * (numbers_.hi - numbers_.lo);
        if (number < numbers_.lo - slack || number > numbers_.hi + slack) return std::nullopt;
        Tick tick{std::clamp(scale_.place(number), range_.lo, range_.hi), 0,
                  std::abs(number) < step / 2 ? "0" : formatNumber(number, step)};
        tick.half = extent_(tick.text) / 2;
        for (const std::vector<Tick>* list : {&ticks_, &beside})
            for (const Tick& other : *list)
                if (std::abs(other.place - tick.place) * perPlace_ < other.half + tick.half + gap_) return std::nullopt;
        return tick;
    }
    bool add(double number, double step) {
        auto tick = fitting(number, step, {});
        if (tick) ticks_.push_back(std::move(*tick));
        return tick.has_value();
    }
    bool inRange(double number) const { return number > numbers_.lo && number < numbers_.hi; }

    /// Adds ticks between two multiples of a power of ten: in tenths, fifths or halves where all of them fit, else
    /// those of the tenths that do; then the same in the parts that are drawn large.
    void divide(double from, double step) {
        const double lo = std::max(from, numbers_.lo), hi = std::min(from + step, numbers_.hi);
        if (!(hi > lo) || step < finest_) return;
        const double drawn = std::abs(scale_.place(hi) - scale_.place(lo)) * perPlace_;
        if (drawn < least_) return;
        const double tenth = step / 10;
        for (const int parts : {10, 5, 2}) {
            std::vector<Tick> made;
            bool all = true;
            for (int i = 1; i < parts && all; ++i) {
                const double number = from + step * i / parts;
                if (!inRange(number)) continue;
                auto tick = fitting(number, tenth, made);
                all = tick.has_value();
                if (tick) made.push_back(std::move(*tick));
            }
            if (!all || made.empty()) continue;
            ticks_.insert(ticks_.end(), made.begin(), made.end());
            break;
        }
        static constexpr std::array<int, 9> kRoundest{5, 2, 8, 4, 6, 1, 9, 3, 7};
        const bool uneven = !isEvenBetween(lo, hi);
        if (uneven)
            for (const int i : kRoundest)
                if (inRange(from + tenth * i)) add(from + tenth * i, tenth);
        for (int i = 0; i < 10; ++i) divide(from + tenth * i, tenth);
    }
    /// Whether places are proportional to numbers there: then ticks at regular steps are all that is wanted.
    bool isEvenBetween(double lo, double hi) const {
        const double a = scale_.place(lo), b = scale_.place(hi);
        for (int i = 1; i < 8; ++i) {
            const double expected = std::lerp(a, b, i / 8.0), at = scale_.place(std::lerp(lo, hi, i / 8.0));
            if (std::abs(at - expected) > 0.02 * std::abs(b - a)) return false;
        }
        return true;
    }

    Range range_;
    const AxisScale& scale_;
    double perPlace_, gap_;
    double least_; ///< no part is divided that is drawn shorter
    double finest_ = 0;
    const std::function<double(const std::string&)>& extent_;
    Range numbers_;
    std::vector<Tick> ticks_;
};

} // namespace

TickLabels scaledTicks(Range range, const AxisScale& scale, double length, double gap, bool noted,
                       const std::function<double(const std::string&)>& extent, const TickStyle& style) {
    if (scale.isEven()) return fittingTicks(range, length, gap, noted, extent, style);
    if (scale.blank) return {};
    return ScaledTicks(range, scale, length, gap, extent).choose();
}

} // namespace tessera::app
