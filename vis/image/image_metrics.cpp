#include "vis/image/image_metrics.h"

#include "volume/base/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tessera::vis {

namespace {

constexpr int kWindow = 11;
constexpr double kSigma = 1.5;
constexpr double kC1 = (0.01 * 255) * (0.01 * 255), kC2 = (0.03 * 255) * (0.03 * 255);

void check(const Image& a, const Image& b) {
    if (a.size != b.size || a.size.x < 1 || a.size.y < 1 || a.rgba.size() != b.rgba.size())
        throw Error("pictures can be compared only if they have the same size; they have " + std::to_string(a.size.x) +
                    "x" + std::to_string(a.size.y) + " and " + std::to_string(b.size.x) + "x" +
                    std::to_string(b.size.y));
}

std::vector<double> luma(const Image& image) {
    std::vector<double> out(image.rgba.size() / 4);
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = 0.299 * image.rgba[4 * i] + 0.587 * image.rgba[4 * i + 1] + 0.114 * image.rgba[4 * i + 2];
    return out;
}

std::array<double, kWindow> gaussian() {
    std::array<double, kWindow> weights{};
    double sum = 0;
    for (int i = 0; i < kWindow; ++i) {
        const int x = i - kWindow / 2;
        sum += weights[std::size_t(i)] = std::exp(-x * x / (2 * kSigma * kSigma));
    }
    for (double& weight : weights) weight /= sum;
    return weights;
}

/// Gaussian-weighted means over all windows that lie inside the picture.
std::vector<double> smoothed(const std::vector<double>& in, glm::ivec2 size) {
    static const std::array<double, kWindow> weights = gaussian();
    const int width = size.x - kWindow + 1, height = size.y - kWindow + 1;
    std::vector<double> rows(std::size_t(width) * std::size_t(size.y), 0.0),
        out(std::size_t(width) * std::size_t(height), 0.0);
    for (int y = 0; y < size.y; ++y)
        for (int k = 0; k < kWindow; ++k) {
            const double weight = weights[std::size_t(k)];
            const double* from = in.data() + std::size_t(y) * std::size_t(size.x) + std::size_t(k);
            double* to = rows.data() + std::size_t(y) * std::size_t(width);
            for (int x = 0; x < width; ++x) to[x] += weight * from[x];
        }
    for (int y = 0; y < height; ++y)
        for (int k = 0; k < kWindow; ++k) {
            const double weight = weights[std::size_t(k)];
            const double* from = rows.data() + std::size_t(y + k) * std::size_t(width);
            double* to = out.data() + std::size_t(y) * std::size_t(width);
            for (int x = 0; x < width; ++x) to[x] += weight * from[x];
        }
    return out;
}

double similarity(double meanA, double meanB, double squareA, double squareB, double product) {
    const double varianceA = squareA - meanA * meanA, varianceB = squareB - meanB * meanB;
    const double covariance = product - meanA * meanB;
    return (2 * meanA * meanB + kC1) * (2 * covariance + kC2) /
           ((meanA * meanA + meanB * meanB + kC1) * (varianceA + varianceB + kC2));
}

double structuralSimilarity(const Image& picture, const Image& reference) {
    const std::vector<double> a = luma(picture), b = luma(reference);
    std::vector<double> aa(a.size()), bb(a.size()), ab(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) aa[i] = a[i] * a[i], bb[i] = b[i] * b[i], ab[i] = a[i] * b[i];
    const glm::ivec2 size = picture.size;
    if (size.x < kWindow || size.y < kWindow) {
        const auto mean = [](const std::vector<double>& values) {
            double sum = 0;
            for (const double value : values) sum += value;
            return sum / double(values.size());
        };
        return similarity(mean(a), mean(b), mean(aa), mean(bb), mean(ab));
    }
    const std::vector<double> ma = smoothed(a, size), mb = smoothed(b, size), maa = smoothed(aa, size),
                              mbb = smoothed(bb, size), mab = smoothed(ab, size);
    double sum = 0;
    for (std::size_t i = 0; i < ma.size(); ++i) sum += similarity(ma[i], mb[i], maa[i], mbb[i], mab[i]);
    return sum / double(ma.size());
}

} // namespace

ImageDifference difference(const Image& picture, const Image& reference) {
    check(picture, reference);
    ImageDifference out;
    double squares = 0;
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
        if (i % 4 == 3) continue;
        const double apart = double(picture.rgba[i]) - double(reference.rgba[i]);
        out.maximum = std::max(out.maximum, std::abs(apart));
        squares += apart * apart;
    }
    out.rmse = std::sqrt(squares / (double(picture.rgba.size()) * 3 / 4));
    out.psnr = out.rmse > 0 ? 20 * std::log10(255 / out.rmse) : std::numeric_limits<double>::infinity();
    out.ssim = structuralSimilarity(picture, reference);
    return out;
}

std::vector<std::uint8_t> differenceMap(const Image& picture, const Image& reference) {
    check(picture, reference);
    std::vector<std::uint8_t> out(picture.rgba.size() / 4);
    for (std::size_t i = 0; i < out.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const int apart = std::abs(int(picture.rgba[4 * i + c]) - int(reference.rgba[4 * i + c]));
            out[i] = std::uint8_t(std::max(int(out[i]), apart));
        }
    return out;
}

} // namespace tessera::vis
