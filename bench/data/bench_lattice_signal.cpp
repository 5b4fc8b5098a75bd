#include "bench/bench.h"
#include "bench/data/bench_archives.h"

#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "volume/analysis/lattice_error.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

namespace tessera::app {

namespace {

/// A sum of plane waves of any direction, none shorter than `shortest`: a signal whose spectrum is a ball.
class RandomWaves {
public:
    explicit RandomWaves(double shortest) {
        std::mt19937 random(3);
        const auto uniform = [&] { return double(random() >> 5) * 0x1p-27; };
        while (waves_.size() < 48) {
            const glm::dvec3 k = 2.0 * glm::dvec3(uniform(), uniform(), uniform()) - 1.0;
            if (glm::length(k) > 1) continue;
            waves_.push_back({k * (2 * 3.141592653589793 / shortest), 6.283185307179586 * uniform()});
        }
    }
    double operator()(glm::dvec3 p) const {
        double sum = 0;
        for (const Wave& wave : waves_) sum += std::cos(glm::dot(wave.k, p) + wave.phase);
        return sum / double(waves_.size());
    }

private:
    struct Wave {
        glm::dvec3 k;
        double phase;
    };
    std::vector<Wave> waves_;
};

/// Samples of a signal over the unit cube as floats.
volume::Dataset sampledOver(const RandomWaves& signal, volume::LatticeKind kind, double spacing) {
    volume::Dataset dataset;
    dataset.info.name = "waves";
    dataset.info.lattice.kind = kind;
    dataset.info.lattice.spacing = glm::dvec3(spacing);
    dataset.info.lattice.size = glm::ivec3(int(std::lround(1 / spacing)));
    if (kind == volume::LatticeKind::BCC) dataset.info.lattice.size.z *= 2;
    volume::Parameter parameter;
    parameter.name = "w";
    dataset.info.parameters = {parameter};
    dataset.read = [&signal, lattice = dataset.info.lattice](int, int, int) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::F32);
        for (int z = 0; z < lattice.size.z; ++z)
            for (int y = 0; y < lattice.size.y; ++y)
                for (int x = 0; x < lattice.size.x; ++x)
                    field.as<float>()[lattice.index({x, y, z})] = float(signal(lattice.position({x, y, z})));
        return field;
    };
    return dataset;
}

} // namespace

BenchTable benchSignalBytes() {
    using volume::LatticeFilter, volume::LatticeKind;
    BenchTable table;
    table.name = "lattice: bytes on CC and BCC of signals whose spectrum is a ball, for the same RMS error of what is "
                 "shown (prefiltered)";
    table.columns = {"shortest wave, CC cells", "RMS error", "samples CC", "samples BCC",    "CC / BCC",
                     "bound of range",          "CC kB",     "BCC kB",     "CC / BCC, bytes"};
    const volume::Box box{glm::dvec3(0), glm::dvec3(1)};
    for (const double cells : {3.0, 4.0, 6.0}) {
        const double cc = 1.0 / 64;
        const RandomWaves signal(cells * cc);
        const auto errorOf = [&](LatticeKind kind, double spacing) {
            return volume::latticeError(signal, kind, spacing, LatticeFilter::Quasi, box, 4000);
        };
        const volume::LatticeError wanted = errorOf(LatticeKind::CC, cc);
        double lo = cc, hi = 2 * cc; // of the edge of a BCC cell
        for (int step = 0; step < 12; ++step) {
            const double middle = 0.5 * (lo + hi);
            (errorOf(LatticeKind::BCC, middle).rms > wanted.rms ? hi : lo) = middle;
        }
        volume::Dataset onCc = sampledOver(signal, LatticeKind::CC, cc),
                        onBcc = sampledOver(signal, LatticeKind::BCC, lo);
        const double samples[] = {double(onCc.info.lattice.count()), double(onBcc.info.lattice.count())};
        for (const double bound : {0.0, 1e-3, 1e-4}) {
            double bytes[2];
            for (int kind = 0; kind < 2; ++kind) {
                const BenchFile file;
                codec::PackOptions options;
                options.lattice = kind == 0 ? codec::StoredLattice::CC : codec::StoredLattice::BCC;
                options.maxError = bound;
                bytes[kind] = double(codec::pack(kind == 0 ? onCc : onBcc, options, file.path).archiveBytes);
            }
            table.rows.push_back({decimals(cells, 0), decimals(wanted.rms, 5), decimals(samples[0], 0),
                                  decimals(samples[1], 0), decimals(samples[0] / samples[1], 2),
                                  bound == 0 ? "lossless" : decimals(bound, 4), decimals(bytes[0] / 1e3, 1),
                                  decimals(bytes[1] / 1e3, 1), decimals(bytes[0] / bytes[1], 2)});
        }
    }
    return table;
}

} // namespace tessera::app
