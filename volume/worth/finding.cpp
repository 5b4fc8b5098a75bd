#include "volume/worth/finding.h"

#include "volume/worth/significance.h"

#include <algorithm>

namespace tessera::volume {

namespace {

int orderOf(FindingKind kind) {
    return kind == FindingKind::Outliers || kind == FindingKind::Jump || kind == FindingKind::Change ? 0 : 1;
}

} // namespace

void keepDiscoveries(Findings& findings, double rate) {
    std::vector<double> p;
    for (const Finding& each : findings.found) p.push_back(each.p);
    p.resize(std::max(findings.tests, p.size()), 1.0);
    const std::vector<double> q = falseDiscoveryRates(p);
    for (std::size_t i = 0; i < findings.found.size(); ++i) findings.found[i].q = q[i];
    std::erase_if(findings.found, [&](const Finding& each) { return !(each.q <= rate); });
    std::ranges::stable_sort(findings.found, [](const Finding& a, const Finding& b) {
        if (orderOf(a.kind) != orderOf(b.kind)) return orderOf(a.kind) < orderOf(b.kind);
        return a.strength != b.strength ? a.strength > b.strength : a.p < b.p;
    });
}

} // namespace tessera::volume
