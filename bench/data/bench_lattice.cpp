#include "bench/bench.h"

#include "volume/analysis/lattice_error.h"
#include "volume/synthetic/marschner_lobb.h"

#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

namespace tessera::app {

namespace {

struct LatticeRow {
    const char* name;
    volume::LatticeKind kind;
    double spacing; ///< in cells of the CC grid
    volume::LatticeFilter filter;
};

/// A blob that moves through the unit cube of space and time, as wide as six samples of CC.
double movingBlob(glm::dvec4 p) {
    const glm::dvec3 apart = glm::dvec3(p) - glm::dvec3(0.3 + 0.4 * p.w, 0.5, 0.6 - 0.2 * p.w);
    return std::exp(-glm::dot(apart, apart) / (2 * 0.14 * 0.14));
}

/// Two regions beside a slanted plane, of Marschner-Lobb signals that jump there by three ranges: errors up to two
/// cells of CC from the plane, of what each region's own samples give.
void addRowsOfRegions(BenchTable& table) {
    using volume::LatticeFilter;
    using volume::LatticeKind;
    const LatticeRow rows[] = {
        {"CC trilinear", LatticeKind::CC, 1, LatticeFilter::Linear},
        {"CC quasi", LatticeKind::CC, 1, LatticeFilter::Quasi},
        {"BCC quasi", LatticeKind::BCC, volume::kBccSpacing, LatticeFilter::Quasi},
        {"BCC quasi, resampled from CC", LatticeKind::BCC, volume::kBccSpacing, LatticeFilter::Resampled},
        {"BCC quasi, of CC with one step (pictures)", LatticeKind::BCC, volume::kBccSpacing, LatticeFilter::Corrected},
    };
    const volume::MarschnerLobb signal{0.25, 3};
    const auto inRegion = [&](glm::dvec3 p, int region) { return region == 0 ? signal(p) : 3 + signal(-p); };
    const glm::dvec3 normal = glm::normalize(glm::dvec3(1, 0.6, 0.35));
    const auto border = [&](glm::dvec3 p) { return glm::dot(normal, p) - 0.1; };
    const volume::Box box{glm::dvec3(-0.8), glm::dvec3(0.8)};
    const double cell = 2.0 / 40;
    volume::LatticeError trilinear;
    for (const LatticeRow& row : rows) {
        const auto error = volume::latticeErrorOfRegions(inRegion, border, row.kind, row.spacing * cell, row.filter,
                                                         box, 2 * cell, 400000);
        if (row.kind == LatticeKind::CC && row.filter == LatticeFilter::Linear) trilinear = error;
        table.rows.push_back({"border of regions", row.name, row.kind == LatticeKind::CC ? "100.0" : "70.7",
                              decimals(error.rms, 5), decimals(error.max, 4), decimals(error.rms / trilinear.rms, 2),
                              "", ""});
    }
}

struct LatticeRow4 {
    const char* name;
    volume::LatticeKind4 kind;
    double spacing; ///< in cells of the CC grid
    volume::LatticeFilter4 filter;
};

void addRows4(BenchTable& table) {
    using volume::LatticeFilter4;
    using volume::LatticeKind4;
    const LatticeRow4 rows[] = {
        {"CC x t quadrilinear", LatticeKind4::CC, 1, LatticeFilter4::Linear},
        {"D4* average", LatticeKind4::D4, volume::kBccSpacing, LatticeFilter4::Linear},
        {"D4* quasi", LatticeKind4::D4, volume::kBccSpacing, LatticeFilter4::Quasi},
        {"D4* as drawn", LatticeKind4::D4, volume::kBccSpacing, LatticeFilter4::Drawn},
    };
    volume::LatticeError quadrilinear;
    for (const LatticeRow4& row : rows) {
        const auto error = volume::latticeError4(movingBlob, row.kind, row.spacing / 20, row.filter);
        if (row.kind == LatticeKind4::CC) quadrilinear = error;
        table.rows.push_back({"moving blob", row.name, decimals(100 * error.samples / quadrilinear.samples, 1),
                              decimals(error.rms, 5), decimals(error.max, 4), decimals(error.rms / quadrilinear.rms, 2),
                              "", ""});
    }
}

} // namespace

BenchTable benchLattice() {
    using volume::LatticeFilter;
    using volume::LatticeKind;
    // Cell edges of a BCC sublattice, in CC cells: sqrt 2 for 70.7 % of the samples, cbrt 2 for as many.
    const double sparse = volume::kBccSpacing, equal = std::cbrt(2.0);
    const LatticeRow rows[] = {
        {"CC trilinear", LatticeKind::CC, 1, LatticeFilter::Linear},
        {"CC quasi", LatticeKind::CC, 1, LatticeFilter::Quasi},
        {"CC cubic", LatticeKind::CC, 1, LatticeFilter::Cubic},
        {"BCC average", LatticeKind::BCC, sparse, LatticeFilter::Linear},
        {"BCC quasi", LatticeKind::BCC, sparse, LatticeFilter::Quasi},
        {"BCC tetrahedral", LatticeKind::BCC, sparse, LatticeFilter::Tetrahedral},
        {"BCC cosine", LatticeKind::BCC, sparse, LatticeFilter::Cosine},
        {"BCC quintic box", LatticeKind::BCC, sparse, LatticeFilter::Quintic},
        {"BCC cubic", LatticeKind::BCC, sparse, LatticeFilter::Cubic},
        {"BCC quasi, resampled from CC", LatticeKind::BCC, sparse, LatticeFilter::Resampled},
        {"BCC quasi, of CC with one step (pictures)", LatticeKind::BCC, sparse, LatticeFilter::Corrected},
        {"BCC average", LatticeKind::BCC, equal, LatticeFilter::Linear},
        {"BCC quasi", LatticeKind::BCC, equal, LatticeFilter::Quasi},
        {"BCC tetrahedral", LatticeKind::BCC, equal, LatticeFilter::Tetrahedral},
    };
    BenchTable table;
    table.name = "lattice";
    table.columns = {"signal",        "lattice and filter", "samples %",   "RMS error",
                     "largest error", "RMS / CC linear",    "normals deg", "wide deg"};
    // 41^3 samples over [-1, 1]^3; the corners beyond 0.8 are left out, where the rings pass the Nyquist frequency.
    const volume::Box box{glm::dvec3(-0.8), glm::dvec3(0.8)};
    const double cell = 2.0 / 40;
    for (const double fM : {3.0, 6.0}) {
        const volume::MarschnerLobb signal{0.25, fM};
        volume::LatticeError trilinear;
        for (const LatticeRow& row : rows) {
            const auto error = volume::latticeError([&](glm::dvec3 p) { return signal(p); }, row.kind,
                                                    row.spacing * cell, row.filter, box);
            const auto angle = [&](volume::GradientSpan span) {
                return decimals(volume::latticeGradientError([&](glm::dvec3 p) { return signal(p); },
                                                             [&](glm::dvec3 p) { return signal.gradient(p); }, row.kind,
                                                             row.spacing * cell, row.filter, span, box),
                                2);
            };
            if (row.kind == LatticeKind::CC && row.filter == LatticeFilter::Linear) trilinear = error;
            table.rows.push_back({"Marschner-Lobb " + decimals(fM, 0), row.name,
                                  decimals(100 * error.samples / trilinear.samples, 1), decimals(error.rms, 5),
                                  decimals(error.max, 4), decimals(error.rms / trilinear.rms, 2),
                                  angle(volume::GradientSpan::Neighbours), angle(volume::GradientSpan::Wide)});
        }
    }
    addRowsOfRegions(table);
    addRows4(table);
    return table;
}

} // namespace tessera::app
