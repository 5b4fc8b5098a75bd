#include "volume/four/isosurface4.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/four/lattice_tetrahedra.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <unordered_map>
#include <utility>

namespace tessera::volume {

namespace {

/// The samples of a time, and for each what it is to the surface.
struct Layer4 {
    double time = 0;
    SampleGrid grid;
    std::vector<std::uint8_t> states; ///< 0: absent, 1: below the value, 2: inside
    /// Vertices on edges within this time, by the samples of their ends.
    std::unordered_map<std::uint64_t, std::uint32_t> vertices;
};

/// A corner of a simplex: a sample at the earlier or the later of two times.
struct Corner4 {
    bool later = false;
    std::size_t sample = 0;
    glm::ivec3 at{0};
};

/// Tetrahedra of a simplex by which of its corners are inside (bits): pairs of an inside and an outside corner.
using Pair4 = std::pair<int, int>;
using Tetrahedra4 = std::vector<std::array<Pair4, 4>>;

/// Between the corners of a simplex inside and those outside the surface is a product of two simplices. It is cut along
/// paths that rise in both, so that neighbours agree on the cuts of their common face.
Tetrahedra4 tetrahedraOf(unsigned inside) {
    std::vector<int> in, out;
    for (int i = 0; i < 5; ++i) (inside >> i & 1 ? in : out).push_back(i);
    Tetrahedra4 all;
    if (in.empty() || out.empty()) return all;
    std::vector<int> steps(in.size() - 1, 0); // 0: the next inside corner, 1: the next outside one
    steps.insert(steps.end(), out.size() - 1, 1);
    do {
        std::size_t a = 0, b = 0;
        std::array<Pair4, 4> path{Pair4{in[0], out[0]}};
        for (std::size_t s = 0; s < steps.size(); ++s) {
            (steps[s] == 0 ? a : b) += 1;
            path[s + 1] = {in[a], out[b]};
        }
        all.push_back(path);
    } while (std::ranges::next_permutation(steps).found);
    return all;
}

class Marcher4 {
public:
    Marcher4(double value, const Progress& progress) : value_(value), progress_(progress) {}

    /// Adds the surface between the time added before and this one.
    void add(double time, SampleGrid grid) {
        Layer4 next{time, std::move(grid), {}, {}};
        next.states.resize(next.grid.values.size());
        parallelRanges(
            next.states.size(),
            [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i)
                    next.states[i] = !next.grid.isPresent(i) ? 0 : double(next.grid.values[i]) >= value_ ? 2 : 1;
            },
            65536);
        std::swap(layers_[0], layers_[1]);
        layers_[1] = std::move(next);
        if (++count_ == 1) {
            const Lattice& lattice = layers_[1].grid.lattice;
            tetrahedra_ = latticeTetrahedra(lattice.kind);
            if (lattice.count() > 0xffffffffu) throw Error("surfaces in space and time need fewer samples a time");
            for (const glm::ivec3 step : tetrahedra_.corners)
                offsets_.push_back((std::int64_t(step.z) * lattice.size.y + step.y) * lattice.size.x + step.x);
            return;
        }
        between_.clear();
        march();
    }

    TetraMesh take() { return std::move(mesh_); }

private:
    void march() {
        const Lattice& lattice = layers_[1].grid.lattice;
        const bool bcc = lattice.kind == LatticeKind::BCC;
        for (int z = bcc ? 1 : 0; z < lattice.size.z; z += bcc ? 2 : 1) {
            if (progress_.stop.stop_requested()) throw Cancelled();
            for (int y = 0; y < lattice.size.y; ++y)
                for (int x = 0; x < lattice.size.x; ++x) marchAround({x, y, z});
        }
    }

    bool exists(glm::ivec3 at) const {
        const glm::ivec3 size = layers_[1].grid.lattice.size;
        return at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < size.x && at.y < size.y && at.z < size.z;
    }

    void marchAround(glm::ivec3 first) {
        const auto origin = std::int64_t(layers_[1].grid.lattice.index(first));
        unsigned seen = 0; // states of all corners there are
        for (std::size_t c = 0; c < offsets_.size(); ++c) {
            if (!exists(first + tetrahedra_.corners[c])) continue;
            const auto sample = std::size_t(origin + offsets_[c]);
            seen |= 1u << layers_[0].states[sample] | 1u << layers_[1].states[sample];
        }
        if ((seen & 6u) != 6u) return; // none inside, or none below
        for (const std::array<int, 4>& solid : tetrahedra_.solids) {
            std::array<Corner4, 4> corners{};
            bool all = true;
            for (std::size_t i = 0; i < 4 && all; ++i) {
                const auto c = std::size_t(solid[i]);
                corners[i] = {false, std::size_t(origin + offsets_[c]), first + tetrahedra_.corners[c]};
                all = exists(corners[i].at);
            }
            if (all) marchPrism(corners);
        }
    }

    /// The prism over a tetrahedron between both times: its corners up to one of them at the earlier time, that one and
    /// the others at the later.
    void marchPrism(const std::array<Corner4, 4>& corners) {
        for (std::size_t turn = 0; turn < 4; ++turn) {
            std::array<Corner4, 5> simplex{};
            unsigned inside = 0;
            bool there = true;
            for (std::size_t i = 0; i < 5 && there; ++i) {
                simplex[i] = corners[i <= turn ? i : i - 1];
                simplex[i].later = i > turn;
                const std::uint8_t state = layerOf(simplex[i]).states[simplex[i].sample];
                there = state != 0 && partOf(simplex[i]) == partOf(simplex[0]);
                inside |= unsigned(state == 2) << i;
            }
            if (there) addSimplex(simplex, inside);
        }
    }

    void addSimplex(const std::array<Corner4, 5>& simplex, unsigned inside) {
        static const std::array<Tetrahedra4, 32> cases = [] {
            std::array<Tetrahedra4, 32> all;
            for (unsigned i = 0; i < all.size(); ++i) all[i] = tetrahedraOf(i);
            return all;
        }();
        if (cases[inside].empty()) return;
        std::array<glm::dvec4, 5> places{}; // by cells: edges cross in the middle
        glm::dvec4 down(0);
        for (std::size_t i = 0; i < 5; ++i) {
            places[i] = cellOf(simplex[i]);
            const bool in = (inside >> i & 1) != 0;
            const int alike = in ? std::popcount(inside) : 5 - std::popcount(inside);
            down += places[i] * ((in ? -1.0 : 1.0) / alike);
        }
        for (const std::array<Pair4, 4>& each : cases[inside]) {
            glm::uvec4 tetrahedron(0);
            std::array<glm::dvec4, 4> middle{};
            for (int i = 0; i < 4; ++i) {
                const auto [from, to] = std::minmax(each[std::size_t(i)].first, each[std::size_t(i)].second);
                tetrahedron[i] = vertex(simplex[std::size_t(from)], simplex[std::size_t(to)]);
                middle[std::size_t(i)] = 0.5 * (places[std::size_t(from)] + places[std::size_t(to)]);
            }
            const glm::dmat4 edges(middle[1] - middle[0], middle[2] - middle[0], middle[3] - middle[0], down);
            if (glm::determinant(edges) < 0) std::swap(tetrahedron[2], tetrahedron[3]);
            mesh_.tetrahedra.push_back(tetrahedron);
        }
    }

    std::uint32_t vertex(const Corner4& from, const Corner4& to) {
        auto& known = from.later == to.later ? layerOf(from).vertices : between_;
        const std::uint64_t key = std::uint64_t(from.sample) << 32 | std::uint64_t(to.sample);
        const auto [entry, isNew] = known.try_emplace(key, std::uint32_t(mesh_.points.size()));
        if (!isNew) return entry->second;
        if (mesh_.points.size() >= 0xffffffffu) throw Error("the surface has more than 4 thousand million vertices");
        const double a = double(layerOf(from).grid.values[from.sample]), b = double(layerOf(to).grid.values[to.sample]);
        double share = (value_ - a) / (b - a);
        if (!(share >= 0 && share <= 1)) share = 0.5; // beside an infinite value
        const Lattice& lattice = layers_[1].grid.lattice;
        const double time =
            from.later == to.later ? layerOf(from).time : glm::mix(layerOf(from).time, layerOf(to).time, share);
        mesh_.points.emplace_back(glm::mix(lattice.position(from.at), lattice.position(to.at), share), time);
        return entry->second;
    }

    Layer4& layerOf(const Corner4& corner) { return layers_[corner.later ? 1 : 0]; }
    int partOf(const Corner4& corner) {
        const SampleGrid& grid = layerOf(corner).grid;
        return grid.parts.empty() ? 0 : grid.parts[corner.sample];
    }
    glm::dvec4 cellOf(const Corner4& corner) const {
        const Lattice& lattice = layers_[1].grid.lattice;
        return {lattice.cellsOfSheet(lattice.sheetPosition(corner.at)), corner.later ? 1.0 : 0.0};
    }

    double value_;
    const Progress& progress_;
    LatticeTetrahedra tetrahedra_;
    std::vector<std::int64_t> offsets_; ///< of the corners in storage
    std::array<Layer4, 2> layers_;      ///< earlier and later
    std::unordered_map<std::uint64_t, std::uint32_t> between_;
    int count_ = 0;
    TetraMesh mesh_;
};

} // namespace

TetraMesh extractIsosurface4(const std::vector<double>& times, const std::function<SampleGrid(int)>& read, double value,
                             const Progress& progress) {
    Marcher4 marcher(value, progress);
    for (std::size_t t = 0; t < times.size(); ++t) {
        progress.advance(double(t) / double(times.size()), "surface in space and time");
        marcher.add(times[t], read(int(t)));
    }
    return marcher.take();
}

TetraMesh extractIsosurface4(const BrickSource& source, int channel, double value, int level,
                             const Progress& progress) {
    const Progress inner{{}, progress.stop};
    return extractIsosurface4(
        source.info().times, [&](int time) { return readSamples(source, channel, time, level, inner); }, value,
        progress);
}

} // namespace tessera::volume
