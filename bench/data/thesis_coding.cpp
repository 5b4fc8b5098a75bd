#include "bench/data/thesis_coding.h"

#include "bench/data/run_length.h"
#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tessera::app {

namespace {

/// A subband of the transformed field.
struct Part {
    glm::ivec3 begin{0}, end{0};
    glm::ivec3 size() const { return end - begin; }
};

/// The seven bands of every level, the finest first.
std::vector<Part> detailBands(glm::ivec3 size, int levels) {
    std::vector<Part> bands;
    for (int level = 0; level < levels; ++level) {
        const glm::ivec3 whole = codec::levelSize(size, level), low = codec::levelSize(size, level + 1);
        for (int band = 1; band < 8; ++band) {
            Part part{{0, 0, 0}, low};
            for (int axis = 0; axis < 3; ++axis)
                if ((band >> axis & 1) != 0) part.begin[axis] = low[axis], part.end[axis] = whole[axis];
            const glm::ivec3 extent = part.size();
            if (extent.x > 0 && extent.y > 0 && extent.z > 0) bands.push_back(part);
        }
    }
    return bands;
}

/// A band read with `axis` fastest.
std::vector<std::int32_t> along(int axis, const Part& part, glm::ivec3 size, std::span<const std::uint32_t> values) {
    const int second = axis == 0 ? 1 : 0, third = axis == 2 ? 1 : 2;
    std::vector<std::int32_t> out;
    glm::ivec3 at(0);
    for (at[third] = part.begin[third]; at[third] < part.end[third]; ++at[third])
        for (at[second] = part.begin[second]; at[second] < part.end[second]; ++at[second])
            for (at[axis] = part.begin[axis]; at[axis] < part.end[axis]; ++at[axis])
                out.push_back(static_cast<std::int32_t>(
                    values[(std::size_t(at.z) * std::size_t(size.y) + std::size_t(at.y)) * std::size_t(size.x) +
                           std::size_t(at.x)]));
    return out;
}

/// Bytes of a band as run lengths: of its bytes, or, if details are larger, of planes of their three low bytes.
std::size_t runBytes(std::span<const std::int32_t> details) {
    const bool wide = std::any_of(details.begin(), details.end(), [](std::int32_t d) { return d < -128 || d > 127; });
    std::size_t sum = 0;
    for (int plane = 0; plane < (wide ? 3 : 1); ++plane) {
        codec::Bytes bytes;
        for (const std::int32_t detail : details)
            bytes.push_back(static_cast<std::byte>(static_cast<std::uint32_t>(detail) >> (8 * plane)));
        sum += encodeRuns(bytes).size();
    }
    return sum;
}

} // namespace

ThesisResult thesisCode(const volume::Field& field, const ThesisCoding& coding) {
    using volume::ScalarType;
    const bool fits = field.type == ScalarType::U8 || field.type == ScalarType::U16 || field.type == ScalarType::I16;
    if (!fits || field.mask || field.lattice.kind != volume::LatticeKind::CC)
        throw Error("run lengths need 8-bit or 16-bit samples on CC without absent ones");
    const glm::ivec3 size = field.lattice.size;
    std::vector<std::uint32_t> values(field.count());
    volume::dispatch(field.type, [&]<class T>(T) {
        const auto samples = field.as<T>();
        std::transform(samples.begin(), samples.end(), values.begin(),
                       [](T sample) { return static_cast<std::uint32_t>(static_cast<std::int32_t>(sample)); });
    });
    const std::vector<std::uint32_t> original = values;
    codec::forward(values, {}, size, coding.levels, coding.wavelet, codec::Arithmetic::Wide);

    ThesisResult result;
    const glm::ivec3 low = codec::levelSize(size, coding.levels);
    result.bytes = std::size_t(low.x) * std::size_t(low.y) * std::size_t(low.z) * volume::byteSize(field.type);
    const std::vector<Part> bands = detailBands(size, coding.levels);
    // A quantile refers to all details of the field.
    std::vector<std::size_t> places;
    std::vector<std::int32_t> details;
    for (const Part& part : bands)
        for (int z = part.begin.z; z < part.end.z; ++z)
            for (int y = part.begin.y; y < part.end.y; ++y)
                for (int x = part.begin.x; x < part.end.x; ++x) {
                    places.push_back((std::size_t(z) * std::size_t(size.y) + std::size_t(y)) * std::size_t(size.x) +
                                     std::size_t(x));
                    details.push_back(static_cast<std::int32_t>(values[places.back()]));
                }
    codec::applyThreshold(details, coding.threshold, coding.value);
    for (std::size_t i = 0; i < places.size(); ++i) values[places[i]] = static_cast<std::uint32_t>(details[i]);
    for (const Part& part : bands) {
        std::size_t best = runBytes(along(0, part, size, values));
        for (int axis = 1; coding.threeDirections && axis < 3; ++axis)
            best = std::min(best, runBytes(along(axis, part, size, values)));
        result.bytes += best;
    }
    if (coding.threeDirections) result.bytes += (2 * bands.size() + 7) / 8;

    codec::inverse(values, {}, size, coding.levels, coding.wavelet, codec::Arithmetic::Wide);
    double squares = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
        squares +=
            std::pow(double(static_cast<std::int32_t>(values[i])) - double(static_cast<std::int32_t>(original[i])), 2);
    result.rms = std::sqrt(squares / double(values.size()));
    return result;
}

} // namespace tessera::app
