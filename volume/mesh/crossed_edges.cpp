#include "volume/mesh/crossed_edges.h"

#include "volume/base/parallel.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace tessera::volume {

namespace {

bool inGrid(const Lattice& lattice, glm::ivec3 at) {
    return at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < lattice.size.x && at.y < lattice.size.y &&
           at.z < lattice.size.z;
}

/// Bits of one row: value >= limit.
void compareRow(const float* values, int count, float limit, std::uint64_t* bits) {
    for (int begin = 0; begin < count; begin += 64) {
        const int n = std::min(64, count - begin);
        std::uint64_t word = 0;
        if (n == 64) {
            // Bytes first, since compilers vectorise this loop and the packing below.
            for (int byte = 0; byte < 8; ++byte) {
                std::uint64_t part = 0;
                for (int i = 0; i < 8; ++i) part |= std::uint64_t(values[begin + byte * 8 + i] >= limit) << i;
                word |= part << (8 * byte);
            }
        } else {
            for (int i = 0; i < n; ++i) word |= std::uint64_t(values[begin + i] >= limit) << i;
        }
        bits[begin / 64] = word;
    }
}

struct Neighbour {
    bool there = false;
    float value = 0;
};
Neighbour neighbour(const SampleGrid& grid, glm::ivec3 at) {
    if (!inGrid(grid.lattice, at)) return {};
    const std::size_t index = grid.lattice.index(at);
    if (!grid.isPresent(index)) return {};
    return {true, grid.values[index]};
}

glm::vec3 gradientCc(const SampleGrid& grid, glm::ivec3 at, float centre) {
    glm::vec3 out(0);
    for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 step(0);
        step[axis] = 1;
        const Neighbour lower = neighbour(grid, at - step), upper = neighbour(grid, at + step);
        const float difference = (upper.there ? upper.value : centre) - (lower.there ? lower.value : centre);
        out[axis] = lower.there && upper.there ? 0.5f * difference : difference;
    }
    return out;
}

/// Along each of the four diagonals s the change over a cell is s.g; with all of them the least squares solution is
/// g = 1/4 sum s (s.g).
glm::vec3 gradientBcc(const SampleGrid& grid, glm::ivec3 at, float centre) {
    const int lo = (at.z & 1) - 1; // neighbours have indices lo and lo + 1, see Prefiltered
    glm::vec3 sum(0);
    glm::mat3 normal(0);
    int found = 0;
    for (int d = 0; d < 4; ++d) {
        const int x = d & 1, y = d >> 1;
        const glm::vec3 s(x ? 1 : -1, y ? 1 : -1, 1);
        const Neighbour upper = neighbour(grid, at + glm::ivec3(lo + x, lo + y, 1)),
                        lower = neighbour(grid, at + glm::ivec3(lo + 1 - x, lo + 1 - y, -1));
        if (!upper.there && !lower.there) continue;
        const float difference = (upper.there ? upper.value : centre) - (lower.there ? lower.value : centre);
        sum += s * (upper.there && lower.there ? difference : 2 * difference);
        normal += glm::outerProduct(s, s);
        ++found;
    }
    if (found == 4) return 0.25f * sum;
    if (found == 3) return glm::inverse(normal) * sum;
    return found == 0 ? glm::vec3(0) : sum / (3.0f * float(found));
}

} // namespace

glm::vec3 sampleGradient(const SampleGrid& grid, glm::ivec3 at) {
    const float centre = grid.values[grid.lattice.index(at)];
    return grid.lattice.kind == LatticeKind::CC ? gradientCc(grid, at, centre) : gradientBcc(grid, at, centre);
}

glm::vec3 spaceGradient(const SampleGrid& grid, glm::ivec3 at) {
    const Lattice& lattice = grid.lattice;
    if (lattice.kind != LatticeKind::CC || lattice.isEven())
        return sampleGradient(grid, at) / glm::vec3(lattice.lengthsAt(lattice.position(at)));
    const double centre = grid.values[lattice.index(at)];
    glm::dvec3 out(0);
    for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 step(0);
        step[axis] = 1;
        const Neighbour lower = neighbour(grid, at - step), upper = neighbour(grid, at + step);
        const double middle = lattice.position(at)[axis], down = middle - lattice.position(at - step)[axis],
                     up = lattice.position(at + step)[axis] - middle;
        const double below = (centre - double(lower.value)) / down, above = (double(upper.value) - centre) / up;
        if (lower.there && upper.there)
            out[axis] = (above * down + below * up) / (down + up);
        else if (lower.there || upper.there)
            out[axis] = upper.there ? above : below;
    }
    return glm::vec3(out);
}

CrossedEdges::CrossedEdges(const SampleGrid& grid, float value, const Progress& progress)
    : grid_(grid), value_(value), kinds_(std::size_t(edgeKinds(grid.lattice.kind))), inside_(grid.lattice.size),
      present_(grid.lattice.size) {
    const glm::ivec3 size = grid.lattice.size;
    progress.advance(0);
    parallelFor(std::size_t(size.z), [&](std::size_t slice) {
        const int z = int(slice);
        for (int y = 0; y < size.y; ++y) {
            const std::size_t first = grid.lattice.index({0, y, z});
            std::uint64_t *in = inside_.row(y, z), *there = present_.row(y, z);
            compareRow(grid.values.data() + first, size.x, value, in);
            for (int x = 0; x < size.x; ++x) {
                if (grid.present.empty()) { // whole words
                    const int n = std::min(64, size.x - x);
                    there[x / 64] = n == 64 ? ~std::uint64_t(0) : (std::uint64_t(1) << n) - 1;
                    x += n - 1;
                } else {
                    there[x / 64] |= std::uint64_t(grid.present[first + std::size_t(x)] != 0) << (x & 63);
                }
            }
            for (std::size_t w = 0; w < inside_.words; ++w) in[w] &= there[w];
        }
    });
    progress.advance(0.2);
    const std::size_t rows = std::size_t(size.y) * std::size_t(size.z);
    edges_.resize(rows * kinds_ * inside_.words);
    before_.resize(edges_.size());
    rowStart_.resize(rows + 1);
    std::vector<std::uint32_t> rowCount(rows);
    parallelFor(std::size_t(size.z), [&](std::size_t z) { number(int(z), rowCount); });
    std::uint64_t total = 0;
    for (std::size_t row = 0; row < rows; ++row) {
        rowStart_[row] = std::uint32_t(total);
        total += rowCount[row];
    }
    if (total >= 0xffffffffu) throw Error("the surface has more than 4 thousand million vertices");
    rowStart_[rows] = std::uint32_t(total);
}

void CrossedEdges::number(int z, std::vector<std::uint32_t>& rowCount) {
    const glm::ivec3 size = inside_.size;
    const bool odd = grid_.lattice.kind == LatticeKind::BCC && (z & 1) != 0;
    for (int y = 0; y < size.y; ++y) {
        const std::size_t row = std::size_t(z) * std::size_t(size.y) + std::size_t(y);
        std::uint32_t count = 0;
        for (std::size_t kind = 0; kind < kinds_; ++kind) {
            const glm::ivec3 step = edgeStep(grid_.lattice.kind, int(kind), odd);
            const int toY = y + step.y, toZ = z + step.z;
            const bool exists = toY >= 0 && toY < size.y && toZ < size.z;
            for (std::size_t w = 0; w < inside_.words; ++w) {
                const std::size_t at = (row * kinds_ + kind) * inside_.words + w;
                before_[at] = count;
                if (!exists) continue;
                edges_[at] = (inside_.row(y, z)[w] ^ inside_.word(toY, toZ, w, step.x)) & present_.row(y, z)[w] &
                             present_.word(toY, toZ, w, step.x);
                count += std::uint32_t(std::popcount(edges_[at]));
            }
        }
        rowCount[row] = count;
    }
}

void CrossedEdges::place(int y, int z, SurfaceMesh& out) const {
    const Lattice& lattice = grid_.lattice;
    const bool odd = lattice.kind == LatticeKind::BCC && (z & 1) != 0;
    const std::size_t row = std::size_t(z) * std::size_t(lattice.size.y) + std::size_t(y);
    std::uint32_t number = rowStart_[row];
    for (std::size_t kind = 0; kind < kinds_; ++kind) {
        const glm::ivec3 step = edgeStep(lattice.kind, int(kind), odd);
        for (std::size_t w = 0; w < inside_.words; ++w)
            for (std::uint64_t bits = edges_[(row * kinds_ + kind) * inside_.words + w]; bits != 0; bits &= bits - 1) {
                const glm::ivec3 a(int(w) * 64 + std::countr_zero(bits), y, z), b = a + step;
                const float from = grid_.values[lattice.index(a)], to = grid_.values[lattice.index(b)];
                float t = (value_ - from) / (to - from);
                if (!(t >= 0 && t <= 1)) t = 0.5f; // beside an infinite value
                out.positions[number] =
                    glm::vec3(glm::mix(lattice.position(a), lattice.position(b), double(t)) - out.origin);
                glm::vec3 down(0);
                if (lattice.isEven()) {
                    const glm::vec3 perCell = glm::mix(sampleGradient(grid_, a), sampleGradient(grid_, b), t);
                    down = -perCell / glm::vec3(lattice.spacing);
                } else {
                    down = -glm::mix(spaceGradient(grid_, a), spaceGradient(grid_, b), t);
                }
                const float length = glm::length(down);
                out.normals[number] = length > 0 && length < 1e30f ? down / length : glm::vec3(0);
                ++number;
            }
    }
}

SurfaceMesh CrossedEdges::vertices(glm::dvec3 origin, const Progress& progress) const {
    SurfaceMesh out;
    out.origin = origin;
    out.positions.resize(rowStart_.back());
    out.normals.resize(rowStart_.back());
    parallelFor(std::size_t(inside_.size.z), [&](std::size_t z) {
        if (progress.stop.stop_requested()) throw Cancelled();
        for (int y = 0; y < inside_.size.y; ++y) place(y, int(z), out);
    });
    return out;
}

} // namespace tessera::volume
