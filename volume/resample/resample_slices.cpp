#include "volume/resample/resample_slices.h"

#include "volume/resample/resample.h"
#include "volume/resample/resample_cc.h"
#include "volume/resample/sharpen.h"
#include "volume/resample/slice_filter.h"
#include "volume/resample/spline_prefilter.h"
#include "volume/system/scratch_file.h"

#include <algorithm>

namespace tessera::volume {

namespace {

/// Calls `visit(first, count)` for runs of slices.
template <class Visit> void forRuns(int slices, int step, const Progress& progress, Visit&& visit) {
    for (int first = 0; first < slices; first += step) {
        progress.advance(double(first) / slices, "resample");
        visit(first, std::min(step, slices - first));
    }
}

/// Slices have a mask if any slice of the frame has one: the order of summation must not depend on how the frame is
/// divided.
Field maskedAlike(Field part, bool masked) {
    if (masked && !part.mask) part.mask = std::make_shared<const Mask>(part.count(), std::uint8_t(1));
    return part;
}

/// Slices of a frame out of a part of it that begins at slice `begin`.
Field cut(const Field& part, int begin, const Lattice& frame, int first, int count) {
    Field out = slicesOf(part, first - begin, count);
    out.lattice = slicesOf(frame, first, count); // from the whole frame, to avoid rounding twice
    return out;
}

/// Coefficients of a B-spline for every sample of a frame, in a scratch file.
class SlicedCoefficients {
public:
    SlicedCoefficients(const SlicedFrame& source, ScalarType type, int degree, const SliceMemory& memory,
                       const Progress& progress)
        : slice_(std::size_t(source.lattice.size.x) * std::size_t(source.lattice.size.y)), values_(memory.folder) {
        dispatch(type, [&]<class T>(T) { make<SumOf<T>>(source, degree, memory, progress); });
    }

    /// Those of some slices, as bytes.
    std::vector<std::byte> read(int first, int count) const {
        std::vector<std::byte> bytes(slice_ * std::size_t(count) * valueBytes_);
        values_.read(slice_ * std::size_t(first) * valueBytes_, bytes);
        return bytes;
    }

private:
    template <class Real>
    void make(const SlicedFrame& source, int degree, const SliceMemory& memory, const Progress& progress) {
        valueBytes_ = sizeof(Real);
        const glm::ivec3 size = source.lattice.size;
        ScratchFile flags(memory.folder);
        forRuns(size.z, memory.step, progress.part(0, 0.5), [&](int first, int count) {
            const Field part = maskedAlike(source.read(first, count), source.extent.masked);
            std::vector<Real> values = splineValues<Real>(part);
            for (const int axis : {0, 1})
                splineFilterAxis<Real>(part.lattice.size, flagsOf(part), values, axis, degree);
            values_.write(slice_ * std::size_t(first) * sizeof(Real), std::as_bytes(std::span(values)));
            if (part.mask) flags.write(slice_ * std::size_t(first), std::as_bytes(std::span(*part.mask)));
        });
        // Whole lines along z, as many rows of every slice as make up the samples of a step.
        const int rows = std::clamp(int(double(memory.step) * size.y / size.z), 1, size.y);
        const std::size_t nx = std::size_t(size.x);
        for (int y = 0; y < size.y; y += rows) {
            progress.advance(0.5 + 0.5 * y / size.y, "resample");
            const glm::ivec3 block(size.x, std::min(rows, size.y - y), size.z);
            const std::size_t run = nx * std::size_t(block.y);
            std::vector<Real> values(run * std::size_t(size.z));
            Mask mask(source.extent.masked ? values.size() : 0);
            const auto forSlicesOf = [&](auto&& body) {
                for (std::size_t z = 0; z < std::size_t(size.z); ++z)
                    body(slice_ * z + nx * std::size_t(y), std::span(values).subspan(run * z, run),
                         mask.empty() ? std::span<std::uint8_t>() : std::span(mask).subspan(run * z, run));
            };
            forSlicesOf([&](std::size_t at, std::span<Real> to, std::span<std::uint8_t> present) {
                values_.read(at * sizeof(Real), std::as_writable_bytes(to));
                if (!present.empty()) flags.read(at, std::as_writable_bytes(present));
            });
            splineFilterAxis<Real>(block, mask, values, 2, degree);
            forSlicesOf([&](std::size_t at, std::span<Real> from, std::span<std::uint8_t>) {
                values_.write(at * sizeof(Real), std::as_bytes(from));
            });
        }
    }
    static std::span<const std::uint8_t> flagsOf(const Field& part) {
        return part.mask ? std::span<const std::uint8_t>(*part.mask) : std::span<const std::uint8_t>();
    }

    std::size_t slice_, valueBytes_ = 0;
    ScratchFile values_;
};

} // namespace

SlicedFrame inMemory(Field field) {
    const auto whole = std::make_shared<Field>(std::move(field));
    return {whole->lattice, [whole](int first, int count) { return slicesOf(*whole, first, count); }, {}, whole};
}

StoredExtent extentOf(const Lattice& lattice, const SliceReader& read, int step, const Progress& progress) {
    StoredExtent extent;
    forRuns(lattice.size.z, step, progress, [&](int first, int count) { extent.add(read(first, count)); });
    return extent;
}

SlicedFrame sharpened(const SlicedFrame& source, double amount, int step, const Progress& progress) {
    SlicedFrame out = source;
    out.read = [source, amount](int first, int count) {
        constexpr int kReach = 2; // one slice suffices, but in BCC the first one must be even
        const int begin = std::max(first - kReach, 0), end = std::min(first + count + kReach, source.lattice.size.z);
        return cut(sharpened(source.read(begin, end - begin), amount, source.extent), begin, source.lattice, first,
                   count);
    };
    out.extent = extentOf(out.lattice, out.read, step, progress);
    return out;
}

SlicedFrame resampled(const SlicedFrame& source, const Lattice& target, const ResampleOptions& asked,
                      const SliceMemory& memory, const Progress& progress) {
    if (source.whole) return inMemory(resample(*source.whole, target, asked, progress));
    checkOrder(asked);
    const ResampleOptions options = optionsBetween(source.lattice.axes, target.axes, asked);
    if (options.sharpen > 0) {
        ResampleOptions plain = options;
        plain.sharpen = 0;
        const bool before = options.sharpenWhen == SharpenWhen::Before;
        const SlicedFrame first =
            before ? sharpened(source, options.sharpen, memory.step, progress.part(0, 0.5)) : source;
        SlicedFrame out = resampled(first, target, plain, memory, progress.part(0.5, 1));
        if (before) return out;
        out.extent = extentOf(target, out.read, memory.step, progress.part(0.5, 1));
        return sharpened(out, options.sharpen, memory.step, progress.part(0.5, 1));
    }
    if (source.lattice == target) return source;
    if (source.lattice.kind != LatticeKind::CC) throw Error("only regular grids can be resampled slice by slice");
    const auto taps = std::make_shared<const CcTaps>(source.lattice, target, options);
    std::shared_ptr<const SlicedCoefficients> coefficients;
    if (const int degree = splineDegree(options.filter); degree > 0)
        coefficients =
            std::make_shared<const SlicedCoefficients>(source, source.read(0, 1).type, degree, memory, progress);
    SlicedFrame out{target, {}, source.extent};
    out.read = [source, target, taps, coefficients, stop = progress.stop](int first, int count) {
        // More slices than requested, by the reach of gaps.
        const int reach = source.extent.masked && target.kind == LatticeKind::BCC ? kGapSlices : 0;
        const int begin = std::max(first - reach, 0), end = std::min(first + count + reach, target.size.z);
        const auto [from, to] = taps->slicesFor(begin, end - begin, source.extent.masked);
        const Field part = maskedAlike(source.read(from, to - from), source.extent.masked);
        std::vector<std::byte> own;
        if (coefficients) own = coefficients->read(from, to - from);
        const Field made = resampleCc(*taps, {part, from, coefficients ? own.data() : nullptr}, source.extent, begin,
                                      end - begin, Progress{{}, stop});
        return cut(made, begin, target, first, count);
    };
    return out;
}

} // namespace tessera::volume
