#include "volume/mesh/cube_cases.h"

#include <algorithm>
#include <map>

namespace tessera::volume {

namespace {

using Loop = std::vector<std::uint8_t>;

int edgeBetween(int a, int b) {
    const int axis = (a ^ b) == 1 ? 0 : (a ^ b) == 2 ? 1 : 2, low = std::min(a, b);
    for (int k = 0; k < 4; ++k)
        if (edgeCorner(axis * 4 + k) == low) return axis * 4 + k;
    return -1;
}

/// The two faces an edge lies on, as bits.
int facesOf(int edge) {
    const int axis = edge / 4, corner = edgeCorner(edge);
    int faces = 0;
    for (int other = 0; other < 3; ++other)
        if (other != axis) faces |= 1 << (2 * other + (corner >> other & 1));
    return faces;
}

/// Triangles that fill the part first .. last of a loop, without a new edge on a face of the cell: the neighbouring
/// cell could create the same edge, which would then belong to four triangles.
bool fill(const Loop& loop, std::size_t first, std::size_t last, CubeCase& out) {
    if (last - first < 2) return true;
    const auto allowed = [&](std::size_t a, std::size_t b) {
        return b - a == 1 || b - a == loop.size() - 1 || (facesOf(loop[a]) & facesOf(loop[b])) == 0;
    };
    const std::size_t before = out.triangles.size();
    for (std::size_t apex = first + 1; apex < last; ++apex) {
        if (!allowed(first, apex) || !allowed(apex, last)) continue;
        out.triangles.push_back({loop[first], loop[apex], loop[last]});
        if (fill(loop, first, apex, out) && fill(loop, apex, last, out)) return true;
        out.triangles.resize(before);
    }
    return false;
}

CubeCase makeCase(int inside, int joined) {
    // Links each crossed edge to the next one of the outline. On each face, seen from outside, the outline runs from
    // where the walk around the face enters the inside to where it leaves it: the inside is to its right.
    std::array<int, 12> next;
    next.fill(-1);
    for (int face = 0; face < 6; ++face) {
        const std::array<int, 4> corners = faceCorners(face);
        const auto in = [&](int i) { return (inside >> corners[std::size_t(i & 3)] & 1) != 0; };
        const auto edge = [&](int i) {
            return edgeBetween(corners[std::size_t(i & 3)], corners[std::size_t((i + 1) & 3)]);
        };
        for (int i = 0; i < 4; ++i) {
            if (in(i) || !in(i + 1)) continue; // edge i enters
            int leave = i + 1;
            if ((joined >> face & 1) != 0)
                leave = i + 3; // around the outside corner i instead: back over its other edge
            while (!in(leave) || in(leave + 1)) ++leave;
            next[std::size_t(edge(i))] = edge(leave);
        }
    }
    CubeCase out;
    std::array<bool, 12> done{};
    for (int start = 0; start < 12; ++start) {
        if (next[std::size_t(start)] < 0 || done[std::size_t(start)]) continue;
        Loop loop;
        for (int at = start; !done[std::size_t(at)]; at = next[std::size_t(at)]) {
            done[std::size_t(at)] = true;
            loop.push_back(std::uint8_t(at));
        }
        if (fill(loop, 0, loop.size() - 1, out)) continue;
        const auto centre = std::uint8_t(kFirstCentre + int(out.centres.size()));
        for (std::size_t i = 0; i < loop.size(); ++i)
            out.triangles.push_back({loop[i], loop[(i + 1) % loop.size()], centre});
        out.centres.push_back(std::move(loop));
    }
    return out;
}

struct Tables {
    std::array<std::uint8_t, 256> ambiguous{};
    std::array<std::array<std::uint16_t, 64>, 256> place{};
    std::vector<CubeCase> cases;

    Tables() {
        for (int inside = 0; inside < 256; ++inside) {
            for (int face = 0; face < 6; ++face) {
                const std::array<int, 4> c = faceCorners(face);
                const auto in = [&](std::size_t i) { return (inside >> c[i] & 1) != 0; };
                if (in(0) == in(2) && in(1) == in(3) && in(0) != in(1))
                    ambiguous[std::size_t(inside)] |= std::uint8_t(1 << face);
            }
            for (int joined = 0; joined < 64; ++joined) {
                if ((joined & ~ambiguous[std::size_t(inside)]) != 0) continue;
                place[std::size_t(inside)][std::size_t(joined)] = std::uint16_t(cases.size());
                cases.push_back(makeCase(inside, joined));
            }
        }
    }
};

const Tables& tables() {
    static const Tables made;
    return made;
}

} // namespace

std::array<int, 4> faceCorners(int face) {
    const int axis = face / 2, side = face % 2, u = 1 << ((axis + 1) % 3), v = 1 << ((axis + 2) % 3),
              base = side << axis;
    if (side == 1) return {base, base + u, base + u + v, base + v};
    return {base, base + v, base + u + v, base + u};
}

std::uint8_t ambiguousFaces(int inside) {
    return tables().ambiguous[std::size_t(inside)];
}

const CubeCase& cubeCase(int inside, std::uint8_t joined) {
    const Tables& t = tables();
    return t.cases[t.place[std::size_t(inside)][joined]];
}

} // namespace tessera::volume
