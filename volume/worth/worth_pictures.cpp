#include "volume/worth/worth_pictures.h"

#include <algorithm>
#include <cmath>

namespace tessera::volume {

namespace {

constexpr int kBinsOfPicture = 24;

std::size_t picturePosition(const WorthSamples& samples, int channel) {
    return std::size_t(std::ranges::find(samples.channels, channel) - samples.channels.begin());
}

std::size_t pictureGroup(const WorthSamples& samples, const Finding& finding) {
    if (!finding.region || samples.group.empty()) return 0;
    const auto found = std::ranges::find(samples.regions, *finding.region);
    return found == samples.regions.end() ? 0 : 1 + std::size_t(found - samples.regions.begin());
}

Range pictureRange(const WorthSamples& samples, const std::vector<float>& values, std::size_t group) {
    Range range{1e300, -1e300};
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!std::isnan(values[i]) && samples.isIn(i, group))
            range = {std::min(range.lo, double(values[i])), std::max(range.hi, double(values[i]))};
    return range;
}

int pictureBin(const Range& range, double value) {
    const double width = range.hi > range.lo ? range.hi - range.lo : 1;
    return std::clamp(int((value - range.lo) / width * kBinsOfPicture), 0, kBinsOfPicture - 1);
}

/// Counts by logarithm, so that few samples are seen beside many, up to 1.
std::vector<float> pictureHeights(const std::vector<double>& counts) {
    std::vector<float> out;
    const double most = counts.empty() ? 0 : *std::ranges::max_element(counts);
    for (const double count : counts) out.push_back(most > 0 ? float(std::log1p(count) / std::log1p(most)) : 0);
    return out;
}

WorthPicture pictureDensity(const WorthSamples& samples, const Finding& finding) {
    const std::vector<float>&x = samples.values[picturePosition(samples, finding.x)],
          &y = samples.values[picturePosition(samples, finding.y)];
    const std::size_t group = pictureGroup(samples, finding);
    const Range across = pictureRange(samples, x, group), up = pictureRange(samples, y, group);
    std::vector<double> counts(std::size_t(kBinsOfPicture) * kBinsOfPicture);
    for (std::size_t i = 0; i < x.size(); ++i)
        if (!std::isnan(x[i]) && !std::isnan(y[i]) && samples.isIn(i, group))
            counts[std::size_t(pictureBin(up, double(y[i])) * kBinsOfPicture + pictureBin(across, double(x[i])))] += 1;
    return {kBinsOfPicture, pictureHeights(counts)};
}

bool liesIn(const Box& box, glm::dvec3 at) {
    for (int axis = 0; axis < 3; ++axis)
        if (at[axis] < box.lo[axis] || at[axis] > box.hi[axis]) return false;
    return true;
}

WorthPicture pictureHistogram(const WorthSamples& samples, const Finding& finding) {
    const bool place = finding.kind == FindingKind::Outliers || finding.kind == FindingKind::Jump;
    const std::vector<float>& values = samples.values[picturePosition(samples, finding.x)];
    const std::size_t group = place ? pictureGroup(samples, finding) : 0;
    const Range range = pictureRange(samples, values, group);
    std::vector<double> all(kBinsOfPicture), part(kBinsOfPicture);
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isnan(values[i]) || !samples.isIn(i, group)) continue;
        const bool found = place ? liesIn(finding.box, samples.placeOf(i)) : samples.inside[i] != 0;
        (found ? part : all)[std::size_t(pictureBin(range, double(values[i])))] += 1;
    }
    return {0, pictureHeights(all), pictureHeights(part)};
}

} // namespace

WorthPicture pictureOf(const WorthSamples& samples, const Finding& finding) {
    if (!finding.series.empty()) {
        WorthPicture out;
        float most = 0;
        for (const float each : finding.series) most = std::max(most, std::isnan(each) ? 0 : each);
        for (const float each : finding.series) out.all.push_back(most > 0 || std::isnan(each) ? each / most : 0);
        out.mark = finding.kind == FindingKind::Change ? finding.time - 1 : finding.time;
        return out;
    }
    if (finding.kind == FindingKind::Region) return {0, {float(finding.other)}, {float(finding.number)}};
    return finding.y >= 0 ? pictureDensity(samples, finding) : pictureHistogram(samples, finding);
}

} // namespace tessera::volume
