#include "bench/bench.h"
#include "bench/data/bench_archives.h"

#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "codec/unpack/unpack.h"
#include "volume/resample/resample.h"
#include "volume/resample/series_dataset.h"

#include <cmath>
#include <limits>

namespace tessera::app {

namespace {

std::shared_ptr<const codec::Archive> packedAs(volume::Dataset& dataset, const codec::PackOptions& options) {
    const BenchFile file;
    codec::pack(dataset, options, file.path);
    return std::make_shared<const codec::Archive>(file.path);
}

/// Samples of the BCC lattice as if their slices were one regular grid.
volume::Dataset asOneArray(const volume::Dataset& dataset) {
    volume::Dataset one;
    one.info = dataset.info;
    one.info.lattice = volume::bccFor(dataset.info.lattice);
    one.info.lattice.kind = volume::LatticeKind::CC;
    one.read = [read = dataset.read](int parameter, int component, int time) {
        volume::Field field = volume::toBcc(read(parameter, component, time), false);
        field.lattice.kind = volume::LatticeKind::CC;
        return field;
    };
    return one;
}

/// Root of the mean square error of an archive at the samples of its source, as part of their range, all times of the
/// first parameter's first component. Labels aside, every parameter would say much the same.
double errorAtSource(const volume::Dataset& source, const std::shared_ptr<const codec::Archive>& archive) {
    const volume::Dataset back = codec::gridDataset(archive, 0);
    double squares = 0, count = 0, lo = std::numeric_limits<double>::infinity(), hi = -lo;
    for (int time = 0; time < int(source.info.times.size()); ++time) {
        const volume::Field truth = source.read(0, 0, time), shown = back.read(0, 0, time);
        for (std::size_t i = 0; i < truth.count(); ++i) {
            if (!truth.present(i) || !shown.present(i)) continue;
            const double value = truth.value(i), error = shown.value(i) - value;
            lo = std::min(lo, value), hi = std::max(hi, value);
            squares += error * error, count += 1;
        }
    }
    return std::sqrt(squares / std::max(count, 1.0)) / std::max(hi - lo, 1e-300);
}

/// The data set with its first parameter alone, one component.
volume::Dataset firstParameterOf(const volume::Dataset& dataset) {
    volume::Dataset one = dataset;
    one.info.parameters.resize(1);
    one.info.parameters[0].components = 1;
    one.info.parameters[0].ranges.clear();
    return one;
}

} // namespace

BenchTable benchBccTransforms() {
    BenchTable table;
    table.name = "lattice: archives on BCC, lossless, by transform";
    table.columns = {"data",         "each sublattice kB", "one array kB",
                     "predicted kB", "each / predicted",   "one array / predicted"};
    for (auto& [name, whole] : volumeFiles()) {
        volume::Dataset dataset = firstParameterOf(whole);
        const auto bytes = [&](volume::Dataset data, codec::BccTransform transform, codec::StoredLattice lattice) {
            codec::PackOptions options;
            options.lattice = lattice;
            options.bccTransform = transform;
            return double(packedAs(data, options)->fileBytes());
        };
        const double each = bytes(dataset, codec::BccTransform::Separable, codec::StoredLattice::BCC),
                     one = bytes(asOneArray(dataset), codec::BccTransform::Auto, codec::StoredLattice::CC),
                     centred = bytes(dataset, codec::BccTransform::BodyCentred, codec::StoredLattice::BCC);
        table.rows.push_back({name, decimals(each / 1e3, 1), decimals(one / 1e3, 1), decimals(centred / 1e3, 1),
                              decimals(each / centred, 3), decimals(one / centred, 3)});
    }
    return table;
}

BenchTable benchLatticeBytes() {
    BenchTable table;
    table.name = "lattice: bytes on BCC and D4* beside those on CC for the same error at the samples of the source";
    table.columns = {"data",    "lattice",           "bound of range",   "kB",
                     "PSNR dB", "CC kB, same bound", "CC kB, same PSNR", "CC same PSNR / this"};
    for (auto& [name, whole] : volumeFiles()) {
        volume::Dataset dataset = firstParameterOf(whole);
        for (const codec::StoredLattice lattice : {codec::StoredLattice::BCC, codec::StoredLattice::D4}) {
            if (lattice == codec::StoredLattice::D4 && !volume::whyNotD4(dataset.info).empty()) continue;
            for (const double bound : {0.0, 1e-3, 1e-2}) {
                codec::PackOptions options;
                options.lattice = lattice;
                options.maxError = bound;
                const auto archive = packedAs(dataset, options);
                const double psnr = -20 * std::log10(errorAtSource(dataset, archive));
                options.lattice = codec::StoredLattice::CC;
                const auto direct = packedAs(dataset, options);
                options.maxError = 0;
                options.psnr = psnr;
                const auto equal = packedAs(dataset, options);
                const double bytes = double(archive->fileBytes());
                table.rows.push_back({name, std::string(codec::kStoredLatticeNames[std::size_t(lattice)]),
                                      bound == 0 ? "lossless" : decimals(bound, 3), decimals(bytes / 1e3, 1),
                                      decimals(psnr, 1), decimals(double(direct->fileBytes()) / 1e3, 1),
                                      decimals(double(equal->fileBytes()) / 1e3, 1),
                                      decimals(double(equal->fileBytes()) / bytes, 2)});
            }
        }
    }
    return table;
}

} // namespace tessera::app
