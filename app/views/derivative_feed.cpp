#include "app/views/derivative_feed.h"

#include "volume/error.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tessera::app {

namespace {

bool same(const volume::DerivativeQuery& a, const volume::DerivativeQuery& b) {
    return a.channel == b.channel && a.time == b.time && a.gradientTop == b.gradientTop;
}

std::shared_ptr<const DerivativeResult> compute(const volume::BrickSource& source, const volume::DerivativeQuery& query,
                                                const Progress& progress) {
    auto result = std::make_shared<DerivativeResult>();
    result->query = query;
    result->histogram = volume::derivativeHistogram(source, query, progress);
    result->curves = volume::boundaryCurves(result->histogram);
    return result;
}

/// sRGB byte of a grey of lightness L* (CIE 1976), 0..100.
std::uint8_t greyOf(double lightness) {
    const double f = (lightness + 16) / 116, y = f > 6.0 / 29 ? f * f * f : lightness / 903.3;
    const double s = y <= 0.0031308 ? 12.92 * y : 1.055 * std::pow(y, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(s, 0.0, 1.0)));
}

} // namespace

struct DerivativeFeed::State {
    const volume::BrickSource* source = nullptr;
    std::shared_ptr<const DerivativeResult> last;
    std::optional<volume::DerivativeQuery> failed;
};

DerivativeFeed::DerivativeFeed() : state_(std::make_shared<State>()) {}

bool DerivativeFeed::failed() const {
    return state_->failed.has_value();
}

std::shared_ptr<const DerivativeResult> DerivativeFeed::get(ViewContext& context, const std::string& jobKey,
                                                            const volume::DerivativeQuery& query) {
    if (state_->source != context.source.get()) {
        context.jobs.cancel(jobKey);
        state_ = std::make_shared<State>(); // a job of the old source finds its state gone
        state_->source = context.source.get();
    }
    State& state = *state_;
    const auto usable = state.last && state.last->query.channel == query.channel ? state.last : nullptr;
    if (state.last && same(state.last->query, query)) return state.last;
    if (state.failed && same(*state.failed, query)) return usable;
    if (context.headless) {
        try {
            state.last = compute(*context.source, query, {});
            return state.last;
        } catch (const Error&) {
            state.failed = query;
            return usable;
        }
    }
    context.busy = true;
    // While something is dragged or played the running answer is waited for: cancelling it each frame would show none.
    if (context.jobs.running(jobKey) && usable) return usable;
    if (context.interacting && usable) return usable;
    if (context.jobs.running(jobKey) && !state.last) return nullptr;
    context.jobs.start(
        jobKey, "Gradients",
        [weak = std::weak_ptr(state_), source = context.source, query](const Progress& progress) -> Jobs::Finish {
            std::shared_ptr<const DerivativeResult> result;
            std::string failure;
            try {
                result = compute(*source, query, progress);
            } catch (const Error& error) {
                failure = error.what();
            }
            return [weak, result, query, failure] {
                const auto owner = weak.lock();
                if (!owner) return;
                if (result) {
                    owner->last = result;
                    owner->failed.reset();
                } else {
                    owner->failed = query; // not tried again every frame
                    throw Error(failure);
                }
            };
        });
    return usable;
}

std::vector<std::uint8_t> derivativeImage(const volume::DerivativeHistogram& histogram, bool dark) {
    const auto width = static_cast<std::size_t>(histogram.valueBins);
    const auto height = static_cast<std::size_t>(histogram.gradientBins);
    std::uint64_t most = 1;
    for (std::uint64_t count : histogram.count) most = std::max(most, count);
    std::vector<std::uint8_t> rgba(width * height * 4);
    for (std::size_t row = 0; row < height; ++row)
        for (std::size_t v = 0; v < width; ++v) {
            const std::uint64_t count = histogram.count[(height - 1 - row) * width + v];
            if (count == 0) continue;
            const double share = std::log1p(double(count)) / std::log1p(double(most));
            const std::uint8_t grey = greyOf(dark ? 28 + 60 * share : 80 - 65 * share);
            std::uint8_t* pixel = &rgba[(row * width + v) * 4];
            pixel[0] = pixel[1] = pixel[2] = grey;
            pixel[3] = 255;
        }
    return rgba;
}

} // namespace tessera::app
