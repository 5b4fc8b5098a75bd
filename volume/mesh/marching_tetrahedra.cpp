#include "volume/mesh/cell_triangles.h"

#include <algorithm>
#include <array>

/// The tetrahedra of BCC: around the long edge between two neighbouring odd samples stand four even ones, an
/// octahedron; two of them next to each other and the long edge make one tetrahedron. The octahedra along the three
/// axes fill space, each face between two tetrahedra is theirs alone.
namespace tessera::volume {

namespace {

struct PlacedEdge {
    int kind = 0;
    glm::ivec3 first{0}; ///< storage index of its first end, from that of the octahedron's first odd sample
};

/// Storage step from an odd sample (whose index counts as (0, 0, 1)) to a point given in half cells from it.
glm::ivec3 storageStep(glm::ivec3 halves) {
    const glm::ivec3 h = halves + 1; // the odd sample lies at half cells (1, 1, 1)
    return {h.x >> 1, h.y >> 1, h.z - 1};
}

PlacedEdge edgeOf(glm::ivec3 a, glm::ivec3 b) { // half cells from the odd sample
    for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}}) {
        const bool odd = (from.z & 1) == 0; // an even way from the odd sample
        const glm::ivec3 first = storageStep(from), step = storageStep(to) - first;
        for (int kind = 0; kind < edgeKinds(LatticeKind::BCC); ++kind)
            if (edgeStep(LatticeKind::BCC, kind, odd) == step) return {kind, first};
    }
    return {};
}

struct Tetrahedron {
    std::array<int, 4> points;       ///< 0, 1: the odd samples, 2..5: the ring; positively oriented
    std::array<PlacedEdge, 6> edges; ///< of the pairs 01 02 03 12 13 23
};
struct Octahedron {
    std::array<glm::ivec3, 6> points; ///< storage steps
    std::array<Tetrahedron, 4> parts;
};

constexpr int kPair[4][4] = {{-1, 0, 1, 2}, {0, -1, 3, 4}, {1, 3, -1, 5}, {2, 4, 5, -1}};

std::array<Octahedron, 3> makeOctahedra() {
    std::array<Octahedron, 3> out;
    for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 along(0), u(0), v(0);
        along[axis] = 1;
        u[(axis + 1) % 3] = 1;
        v[(axis + 2) % 3] = 1;
        const std::array<glm::ivec3, 6> halves = {glm::ivec3(0), 2 * along,     along + u + v,
                                                  along - u + v, along - u - v, along + u - v};
        Octahedron& own = out[std::size_t(axis)];
        for (std::size_t i = 0; i < 6; ++i) own.points[i] = storageStep(halves[i]);
        for (int part = 0; part < 4; ++part) {
            Tetrahedron& t = own.parts[std::size_t(part)];
            t.points = {0, 1, 2 + part, 2 + (part + 1) % 4};
            for (int a = 0; a < 4; ++a)
                for (int b = a + 1; b < 4; ++b)
                    t.edges[std::size_t(kPair[a][b])] = edgeOf(halves[std::size_t(t.points[std::size_t(a)])],
                                                               halves[std::size_t(t.points[std::size_t(b)])]);
        }
    }
    return out;
}

/// Triangles of a tetrahedron by which of its corners are inside: pairs of corners, in kPair's numbers.
struct TetrahedronCase {
    int count = 0;
    std::array<std::array<int, 3>, 2> triangles{};
};

std::array<TetrahedronCase, 16> makeCases() {
    std::array<TetrahedronCase, 16> out;
    // Even permutations that begin with each corner and with each pair of corners.
    constexpr int kEven[8][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 0, 3, 2},
                                 {1, 3, 2, 0}, {1, 2, 0, 3}, {2, 3, 0, 1}, {3, 2, 1, 0}};
    for (int mask = 1; mask < 15; ++mask)
        for (const auto& p : kEven) {
            const auto in = [&](int i) { return (mask >> p[i] & 1) != 0; };
            const auto edge = [&](int a, int b) { return kPair[p[a]][p[b]]; };
            TetrahedronCase& own = out[std::size_t(mask)];
            if (in(0) && !in(1) && !in(2) && !in(3)) own = {1, {{{edge(0, 1), edge(0, 2), edge(0, 3)}}}};
            if (!in(0) && in(1) && in(2) && in(3)) own = {1, {{{edge(0, 1), edge(0, 3), edge(0, 2)}}}};
            if (in(0) && in(1) && !in(2) && !in(3))
                own = {2, {{{edge(0, 2), edge(0, 3), edge(1, 3)}, {edge(0, 2), edge(1, 3), edge(1, 2)}}}};
            if (own.count > 0) break;
        }
    return out;
}

} // namespace

std::vector<std::array<glm::ivec3, 4>> bccTetrahedra() {
    std::vector<std::array<glm::ivec3, 4>> out;
    for (const Octahedron& octahedron : makeOctahedra())
        for (const Tetrahedron& t : octahedron.parts) {
            std::array<glm::ivec3, 4>& own = out.emplace_back();
            for (std::size_t i = 0; i < 4; ++i) own[i] = octahedron.points[std::size_t(t.points[i])];
        }
    return out;
}

CellTriangles tetrahedronTriangles(const CrossedEdges& edges, int slab) {
    static const std::array<Octahedron, 3> octahedra = makeOctahedra();
    static const std::array<TetrahedronCase, 16> cases = makeCases();
    CellTriangles out;
    const BitRows &inside = edges.inside(), &present = edges.present();
    const int z = 2 * slab + 1; // of the first odd sample
    for (const Octahedron& octahedron : octahedra)
        for (int y = 0; y < inside.size.y; ++y) {
            const bool exists = std::all_of(octahedron.points.begin(), octahedron.points.end(), [&](glm::ivec3 step) {
                return y + step.y < inside.size.y && z + step.z < inside.size.z;
            });
            for (std::size_t w = 0; exists && w < inside.words; ++w) {
                std::uint64_t corners[6], there[6], any = 0, all = ~std::uint64_t(0);
                for (std::size_t c = 0; c < 6; ++c) {
                    const glm::ivec3 step = octahedron.points[c];
                    corners[c] = inside.word(y + step.y, z + step.z, w, step.x);
                    any |= corners[c];
                    all &= corners[c];
                    there[c] = present.word(y + step.y, z + step.z, w, step.x);
                }
                for (std::uint64_t active = any & ~all & there[0] & there[1]; active != 0; active &= active - 1) {
                    const int bit = std::countr_zero(active), x = int(w) * 64 + bit;
                    for (const Tetrahedron& t : octahedron.parts) {
                        int mask = 0;
                        const auto isThere = [&](int point) { return (there[point] >> bit & 1) != 0; };
                        if (!isThere(t.points[2]) || !isThere(t.points[3])) continue;
                        for (int i = 0; i < 4; ++i) mask |= int(corners[t.points[std::size_t(i)]] >> bit & 1) << i;
                        const TetrahedronCase& found = cases[std::size_t(mask)];
                        for (int n = 0; n < found.count; ++n) {
                            glm::uvec3 triangle(0);
                            for (int i = 0; i < 3; ++i) {
                                const PlacedEdge& edge =
                                    t.edges[std::size_t(found.triangles[std::size_t(n)][std::size_t(i)])];
                                triangle[i] =
                                    edges.vertex(edge.kind, x + edge.first.x, y + edge.first.y, z + edge.first.z);
                            }
                            out.triangles.push_back(triangle);
                        }
                    }
                }
            }
        }
    return out;
}

int slabCount(const SampleGrid& grid) {
    const glm::ivec3 size = grid.lattice.size;
    return grid.lattice.kind == LatticeKind::CC ? std::max(0, size.z - 1) : size.z / 2;
}

} // namespace tessera::volume
