#include "volume/resample/resample.h"

#include "volume/resample/resample_bcc.h"
#include "volume/resample/resample_cc.h"
#include "volume/resample/slice_filter.h"
#include "volume/resample/spline_prefilter.h"

#include <algorithm>

namespace tessera::volume {

namespace {

/// A CC source, all of it at once.
Field fromCc(const Field& source, const Lattice& target, const ResampleOptions& options, const Progress& progress) {
    const CcTaps taps(source.lattice, target, options);
    StoredExtent extent;
    extent.add(source);
    const auto run = [&](const void* coefficients) {
        return resampleCc(taps, {source, 0, coefficients}, extent, 0, target.size.z, progress);
    };
    const int degree = splineDegree(options.filter);
    if (degree == 0) return run(nullptr);
    return dispatch(source.type, [&]<class T>(T) {
        const auto coefficients = splineCoefficients<SumOf<T>>(source, degree);
        return run(coefficients.data());
    });
}

} // namespace

Field resample(const Field& source, const Lattice& target, const ResampleOptions& asked, const Progress& progress) {
    checkOrder(asked);
    const ResampleOptions options = optionsBetween(source.lattice.axes, target.axes, asked);
    if (options.sharpen > 0) {
        ResampleOptions plain = options;
        plain.sharpen = 0;
        if (options.sharpenWhen == SharpenWhen::Before)
            return resample(sharpened(source, options.sharpen), target, plain, progress);
        return sharpened(resample(source, target, plain, progress), options.sharpen);
    }
    if (source.lattice == target) {
        progress.advance(1, "resample");
        return source;
    }
    Field out = source.lattice.kind == LatticeKind::CC ? fromCc(source, target, options, progress)
                                                       : resampleBcc(source, target, options.filter, progress);
    const auto isPlain = [](std::uint8_t number) { return number == 1; };
    if (out.mask && std::all_of(out.mask->begin(), out.mask->end(), isPlain)) out.mask.reset();
    return out;
}

Field resampleOnto(const Field& bcc, const Lattice& target, std::shared_ptr<const Mask> own) {
    Field out = resampleBcc(bcc, target, ResampleFilter::Cubic, {}, own.get());
    out.mask = std::move(own);
    return out;
}

Field toBcc(const Field& source, bool categorical, const ResampleOptions& options, const Progress& progress) {
    if (source.lattice.kind == LatticeKind::BCC) return source;
    return resample(source, bccFor(source.lattice), optionsFor(categorical, options), progress);
}

} // namespace tessera::volume
