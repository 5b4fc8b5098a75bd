#pragma once

#include "volume/mesh/surface_mesh.h"
#include "volume/reconstruct/sample_grid.h"

#include <bit>
#include <cstdint>
#include <vector>

/// Where a surface crosses the edges of a lattice: one bit per sample and per edge, so that the number of a vertex is a
/// count of bits. After the row-wise numbering of flying edges (Schroeder, Maynard, Geveci 2015).
namespace tessera::volume {

/// One bit per sample, rows of whole words along x.
struct BitRows {
    glm::ivec3 size{0};
    std::size_t words = 0; ///< per row
    std::vector<std::uint64_t> bits;

    BitRows() = default;
    explicit BitRows(glm::ivec3 samples)
        : size(samples), words((std::size_t(samples.x) + 63) / 64),
          bits(words * std::size_t(samples.y) * std::size_t(samples.z)) {}
    const std::uint64_t* row(int y, int z) const {
        return bits.data() + (std::size_t(z) * std::size_t(size.y) + std::size_t(y)) * words;
    }
    std::uint64_t* row(int y, int z) { return const_cast<std::uint64_t*>(std::as_const(*this).row(y, z)); }
    /// Word w of the row moved by dx (-1, 0, 1): bit x is that of sample x + dx, 0 beyond the row.
    std::uint64_t word(int y, int z, std::size_t w, int dx) const {
        const std::uint64_t* r = row(y, z);
        if (dx == 0) return r[w];
        if (dx > 0) return r[w] >> 1 | (w + 1 < words ? r[w + 1] << 63 : 0);
        return r[w] << 1 | (w > 0 ? r[w - 1] >> 63 : 0);
    }
};

/// Kinds of edges, by their first end: CC 0..2 along x, y, z; BCC 0..2 the same within a sublattice, 3..6 to the four
/// samples of the slice above.
inline int edgeKinds(LatticeKind kind) {
    return kind == LatticeKind::CC ? 3 : 7;
}
/// From the first end to the other, in storage indices; `odd`: the first end lies in an odd slice of BCC.
inline glm::ivec3 edgeStep(LatticeKind lattice, int kind, bool odd) {
    if (kind < 3) return {kind == 0, kind == 1, kind == 2 ? (lattice == LatticeKind::BCC ? 2 : 1) : 0};
    const int lo = odd ? 0 : -1;
    return {lo + ((kind - 3) & 1), lo + ((kind - 3) >> 1), 1};
}

class CrossedEdges {
public:
    /// Throws Error when there are more crossings than 32 bits count.
    CrossedEdges(const SampleGrid& grid, float value, const Progress& progress);

    const BitRows& inside() const { return inside_; }   ///< value >= the surface's, and present
    const BitRows& present() const { return present_; } ///< samples of the grid that are there

    /// Number of the vertex on the edge of a kind that begins at a sample; the surface must cross it.
    std::uint32_t vertex(int kind, int x, int y, int z) const {
        const std::size_t row = std::size_t(z) * std::size_t(inside_.size.y) + std::size_t(y);
        const std::size_t at = (row * kinds_ + std::size_t(kind)) * inside_.words + std::size_t(x >> 6);
        const std::uint64_t before = (std::uint64_t(1) << (x & 63)) - 1;
        return rowStart_[row] + before_[at] + std::uint32_t(std::popcount(edges_[at] & before));
    }
    /// Positions (less an origin) and normals of all vertices, in the order of their numbers.
    SurfaceMesh vertices(glm::dvec3 origin, const Progress& progress) const;

private:
    void number(int z, std::vector<std::uint32_t>& rowCount);
    void place(int y, int z, SurfaceMesh& out) const;

    const SampleGrid& grid_;
    float value_;
    std::size_t kinds_;
    BitRows inside_, present_;
    std::vector<std::uint64_t> edges_;    ///< [row][kind][word]
    std::vector<std::uint32_t> before_;   ///< crossings of the row before the word
    std::vector<std::uint32_t> rowStart_; ///< crossings before the row, one more entry at the end
};

/// Change of the value per cell and axis at a sample, from its neighbours that are present.
glm::vec3 sampleGradient(const SampleGrid& grid, glm::ivec3 at);
/// Per length in space: on uneven axes of CC by the distances of the neighbours, of BCC by the cell there.
glm::vec3 spaceGradient(const SampleGrid& grid, glm::ivec3 at);

} // namespace tessera::volume
