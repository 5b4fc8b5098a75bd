#include "app/command/bench.h"

#include "volume/lattice_error.h"
#include "volume/synthetic/marschner_lobb.h"

#include <cmath>
#include <cstdio>

namespace tessera::app {

namespace {

std::string decimal(double value, int digits) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

struct LatticeRow {
    const char* name;
    volume::LatticeKind kind;
    double spacing; ///< in cells of the CC grid
    volume::LatticeFilter filter;
};

} // namespace

BenchTable benchLattice() {
    using volume::LatticeFilter;
    using volume::LatticeKind;
    // Cell edges of a BCC sublattice, in CC cells: sqrt 2 for 70.7 % of the samples, cbrt 2 for as many.
    const double sparse = volume::kBccSpacing, equal = std::cbrt(2.0);
    const LatticeRow rows[] = {
        {"CC trilinear", LatticeKind::CC, 1, LatticeFilter::Linear},
        {"CC quasi", LatticeKind::CC, 1, LatticeFilter::Quasi},
        {"BCC average", LatticeKind::BCC, sparse, LatticeFilter::Linear},
        {"BCC quasi", LatticeKind::BCC, sparse, LatticeFilter::Quasi},
        {"BCC tetrahedral", LatticeKind::BCC, sparse, LatticeFilter::Tetrahedral},
        {"BCC average", LatticeKind::BCC, equal, LatticeFilter::Linear},
        {"BCC quasi", LatticeKind::BCC, equal, LatticeFilter::Quasi},
        {"BCC tetrahedral", LatticeKind::BCC, equal, LatticeFilter::Tetrahedral},
    };
    BenchTable table;
    table.name = "lattice";
    table.columns = {"Marschner-Lobb fM", "lattice and filter", "samples %",
                     "RMS error",         "largest error",      "RMS / CC trilinear"};
    // 41^3 samples over [-1, 1]^3; the corners beyond 0.8 are left out, where the rings pass the Nyquist frequency.
    const volume::Box box{glm::dvec3(-0.8), glm::dvec3(0.8)};
    const double cell = 2.0 / 40;
    for (const double fM : {3.0, 6.0}) {
        const volume::MarschnerLobb signal{0.25, fM};
        volume::LatticeError trilinear;
        for (const LatticeRow& row : rows) {
            const auto error = volume::latticeError([&](glm::dvec3 p) { return signal(p); }, row.kind,
                                                    row.spacing * cell, row.filter, box);
            if (row.kind == LatticeKind::CC && row.filter == LatticeFilter::Linear) trilinear = error;
            table.rows.push_back({decimal(fM, 0), row.name, decimal(100 * error.samples / trilinear.samples, 1),
                                  decimal(error.rms, 5), decimal(error.max, 4), decimal(error.rms / trilinear.rms, 2)});
        }
    }
    return table;
}

} // namespace tessera::app
