#include "app/views/parallel/gap_raster.h"

#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr double kFaintest = 0.12;     ///< opacity of the least density
constexpr double kRounding = 1e-9;     ///< what differences leave of the greatest number
constexpr double kContextShare = 0.55; ///< of the opacity, beside what is selected

struct GapBand {
    Range left, right; ///< rows
    double all = 0;
    std::vector<double> selected;
};

/// Adds `amount` spread evenly over rows to the differences of a column from row to row.
void addRows(double* differences, int height, double from, double to, double amount) {
    from = std::clamp(from, 0.0, double(height));
    to = std::clamp(to, 0.0, double(height));
    if (to - from < 1e-9) return;
    const double density = amount / (to - from);
    const auto edge = [&](double at, double step) {
        const int row = std::min(static_cast<int>(at), height - 1);
        const double past = at - row;
        differences[row] += step * (1 - past);
        differences[row + 1] += step * past;
    };
    edge(from, density);
    edge(to, -density);
}

/// Places of an axis, where neighbouring bins are one if they are thinner than a row.
struct JoinedPlaces {
    std::vector<int> of;     ///< by place: which of those below, -1: none
    std::vector<Range> rows; ///< of each
};

JoinedPlaces joinedPlaces(const PlaceRows& rows, int bins) {
    JoinedPlaces out;
    const int each = binsTogether(bins, rows.axis);
    for (int place = 0; place < static_cast<int>(volume::placesOf(bins)); ++place) {
        const auto own = placeRows(rows, bins, place);
        if (own && place < bins && place % each > 0)
            out.rows.back() = {std::min(out.rows.back().lo, own->lo), std::max(out.rows.back().hi, own->hi)};
        else if (own)
            out.rows.push_back(*own);
        out.of.push_back(own ? static_cast<int>(out.rows.size()) - 1 : -1);
    }
    return out;
}

std::vector<GapBand> gapBands(const volume::PlaceCounts& counts, int bins, const PlaceRows& left,
                              const PlaceRows& right) {
    std::vector<GapBand> bands;
    const std::size_t places = volume::placesOf(bins), groups = counts.selected.size();
    const auto absent = static_cast<std::size_t>(volume::absentPlace(bins));
    const JoinedPlaces from = joinedPlaces(left, bins), to = joinedPlaces(right, bins);
    std::vector<int> bandOf(from.rows.size() * to.rows.size(), -1); // by what it runs from and to
    for (std::size_t a = 0; a < places; ++a)
        for (std::size_t b = 0; b < places; ++b) {
            const std::size_t at = a * places + b;
            if (counts.all[at] == 0 || from.of[a] < 0 || to.of[b] < 0 || (a == absent && b == absent)) continue;
            const auto i = static_cast<std::size_t>(from.of[a]), k = static_cast<std::size_t>(to.of[b]);
            int& known = bandOf[i * to.rows.size() + k];
            if (known < 0) {
                known = static_cast<int>(bands.size());
                bands.push_back({from.rows[i], to.rows[k], 0, std::vector<double>(groups)});
            }
            GapBand& band = bands[static_cast<std::size_t>(known)];
            band.all += double(counts.all[at]);
            for (std::size_t g = 0; g < groups; ++g) band.selected[g] += counts.selected[g][at];
        }
    return bands;
}

} // namespace

int binsTogether(int bins, double rows) {
    return std::max(1, static_cast<int>(std::ceil(bins / std::max(1.0, rows) - kRounding)));
}

std::optional<Range> placeRows(const PlaceRows& rows, int bins, int place) {
    if (place == volume::absentPlace(bins)) return Range{rows.markFrom, rows.markTo};
    if (place > bins) return {};
    const double bin = rows.flipped ? place : bins - 1 - place;
    return Range{rows.axis * bin / bins, rows.axis * (bin + 1) / bins};
}

GapDensity rasterGap(const volume::PlaceCounts& counts, int bins, const PlaceRows& left, const PlaceRows& right,
                     int width, int height) {
    GapDensity out{width, height, {}, {}};
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    out.all.resize(pixels);
    out.selected.assign(counts.selected.size(), std::vector<double>(pixels));
    const std::vector<GapBand> bands = gapBands(counts, bins, left, right);
    double most = 0;
    for (const GapBand& band : bands) most = std::max(most, band.all);
    const std::size_t layers = 1 + counts.selected.size(), line = static_cast<std::size_t>(height) + 1;
    parallelFor(static_cast<std::size_t>(width), [&](std::size_t column) {
        std::vector<double> differences(layers * line);
        const double u = (double(column) + 0.5) / width;
        for (const GapBand& band : bands) {
            const double from = band.left.lo + (band.right.lo - band.left.lo) * u,
                         to = band.left.hi + (band.right.hi - band.left.hi) * u;
            addRows(differences.data(), height, from, to, band.all);
            for (std::size_t g = 0; g < band.selected.size(); ++g)
                if (band.selected[g] > 0) addRows(&differences[(g + 1) * line], height, from, to, band.selected[g]);
        }
        for (std::size_t layer = 0; layer < layers; ++layer) {
            std::vector<double>& to = layer == 0 ? out.all : out.selected[layer - 1];
            double sum = 0;
            for (int row = 0; row < height; ++row) {
                sum += differences[layer * line + std::size_t(row)];
                to[std::size_t(row) * std::size_t(width) + column] = sum > most * kRounding ? sum : 0;
            }
        }
    });
    return out;
}

double greatestDensity(const GapDensity& density) {
    double most = 0;
    for (const double each : density.all) most = std::max(most, each);
    return most;
}

std::vector<std::uint8_t> gapPixels(const GapDensity& density, const GapLook& look) {
    std::vector<std::uint8_t> rgba(density.all.size() * 4);
    const auto share = [&](double of) {
        if (!look.logDensity) return std::min(1.0, of / look.most);
        return std::min(1.0, std::log1p(of * look.unit) / std::log1p(look.most * look.unit));
    };
    const bool selecting = !density.selected.empty();
    for (std::size_t i = 0; i < density.all.size(); ++i) {
        const double all = density.all[i];
        if (all <= 0) continue;
        double alpha = kFaintest + (1 - kFaintest) * share(all);
        GapInk color = selecting ? look.context : look.plain;
        if (selecting) {
            GapInk hot{};
            double focus = 0;
            for (std::size_t g = 0; g < density.selected.size() && g < look.focus.size(); ++g) {
                const double own = density.selected[g][i];
                focus += own;
                for (std::size_t k = 0; k < 3; ++k) hot[k] += own * look.focus[g][k];
            }
            alpha *= kContextShare;
            if (focus > 0) {
                // A few selected samples among many must still show: the square root lifts small shares.
                const double mix = std::sqrt(std::min(1.0, focus / all));
                for (std::size_t k = 0; k < 3; ++k) color[k] += (hot[k] / focus - color[k]) * mix;
                alpha = std::max(alpha, 2 * kFaintest + (1 - 2 * kFaintest) * share(focus));
            }
        }
        for (std::size_t k = 0; k < 3; ++k)
            rgba[i * 4 + k] = static_cast<std::uint8_t>(std::lround(std::clamp(color[k], 0.0, 255.0)));
        rgba[i * 4 + 3] = static_cast<std::uint8_t>(std::lround(255 * alpha));
    }
    return rgba;
}

} // namespace tessera::app
