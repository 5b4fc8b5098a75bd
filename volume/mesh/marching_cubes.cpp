#include "volume/mesh/cell_triangles.h"
#include "volume/mesh/cube_cases.h"

namespace tessera::volume {

namespace {

/// Which ambiguous faces of a cell join their inside corners: those whose bilinear interpolation has its saddle inside.
/// Both cells at a face do the same arithmetic on the same pairs, so they agree.
std::uint8_t joinedFaces(const SampleGrid& grid, glm::ivec3 cell, float value, int inside, std::uint8_t ambiguous) {
    std::uint8_t joined = 0;
    for (int face = 0; face < 6; ++face) {
        if ((ambiguous >> face & 1) == 0) continue;
        double product[2] = {1, 1}; // of the corners inside, of the others
        for (const int corner : faceCorners(face)) {
            const glm::ivec3 at = cell + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
            product[(inside >> corner & 1) != 0 ? 0 : 1] *= double(grid.values[grid.lattice.index(at)]) - double(value);
        }
        if (product[0] >= product[1]) joined |= std::uint8_t(1 << face);
    }
    return joined;
}

} // namespace

CellTriangles cubeTriangles(const SampleGrid& grid, const CrossedEdges& edges, float value, int slab) {
    CellTriangles out;
    const BitRows &inside = edges.inside(), &present = edges.present();
    const auto vertex = [&](int edge, int x, int y) {
        const int corner = edgeCorner(edge);
        return edges.vertex(edge / 4, x + (corner & 1), y + (corner >> 1 & 1), slab + (corner >> 2));
    };
    for (int y = 0; y + 1 < inside.size.y; ++y)
        for (std::size_t w = 0; w < inside.words; ++w) {
            std::uint64_t corners[8], any = 0, all = ~std::uint64_t(0), there = all;
            for (int c = 0; c < 8; ++c) {
                const int atY = y + (c >> 1 & 1), atZ = slab + (c >> 2);
                corners[c] = inside.word(atY, atZ, w, c & 1);
                any |= corners[c];
                all &= corners[c];
                if ((c & 1) != 0) there &= present.word(atY, atZ, w, 1) & present.row(atY, atZ)[w];
            }
            for (std::uint64_t active = any & ~all & there; active != 0; active &= active - 1) {
                const int bit = std::countr_zero(active), x = int(w) * 64 + bit;
                int index = 0;
                for (int c = 0; c < 8; ++c) index |= int(corners[c] >> bit & 1) << c;
                std::uint8_t joined = 0;
                if (const std::uint8_t ambiguous = ambiguousFaces(index))
                    joined = joinedFaces(grid, {x, y, slab}, value, index, ambiguous);
                const CubeCase& found = cubeCase(index, joined);
                std::uint32_t numbers[12];
                std::uint32_t known = 0;
                const auto number = [&](std::uint8_t n) {
                    if (n >= kFirstCentre) return kOwnVertex | std::uint32_t(out.own.size() + n - kFirstCentre);
                    if ((known >> n & 1) == 0) {
                        numbers[n] = vertex(n, x, y);
                        known |= 1u << n;
                    }
                    return numbers[n];
                };
                for (const auto& triangle : found.triangles)
                    out.triangles.emplace_back(number(triangle[0]), number(triangle[1]), number(triangle[2]));
                for (const auto& loop : found.centres) {
                    std::vector<std::uint32_t> of;
                    for (const std::uint8_t edge : loop) of.push_back(number(edge));
                    out.own.push_back(std::move(of));
                }
            }
        }
    return out;
}

} // namespace tessera::volume
