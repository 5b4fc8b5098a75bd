#include "vis/processor/rasterized.h"

#include "vis/processor/surface_shading.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <tuple>

namespace tessera::vis {

namespace {

constexpr float kNothingThere = 1e9f; ///< distance where there is no surface
constexpr double kCovers = 0.998;     ///< opacity of what occludes everything behind it

/// A triangle of the picture.
struct Piece {
    Triangle triangle;
    Triangle::Box box;
    std::array<SurfacePoint, 3> corners;
    const SurfaceLayer* layer = nullptr;
    glm::vec4 tint = kNoTint;
    bool line = false;

    SurfacePoint between(glm::dvec3 shares) const {
        return corners[0] * shares.x + corners[1] * shares.y + corners[2] * shares.z;
    }
};

/// Triangles in the order in which they are drawn, in blocks, so that blocks can be filled at the same time.
class Pieces {
public:
    static constexpr std::size_t kBlock = 4096; ///< at most, of one block
    using Block = std::vector<Piece>;

    /// Adds as many empty blocks; returns the first.
    Block* addBlocks(std::size_t count) {
        const std::size_t first = blocks_.size();
        blocks_.resize(first + count);
        return blocks_.data() + first;
    }
    /// Adds a triangle after all others.
    void add(const Piece& piece) {
        if (blocks_.empty() || blocks_.back().size() == kBlock) blocks_.emplace_back();
        blocks_.back().push_back(piece);
    }
    const Piece& operator[](std::uint32_t number) const { return blocks_[number / kBlock][number % kBlock]; }
    /// For each band of so many rows the numbers of the triangles that may cover some of it.
    std::vector<std::vector<std::uint32_t>> inBands(int rows, std::size_t bands) const {
        std::vector<std::vector<std::uint32_t>> out(bands);
        for (std::size_t block = 0; block < blocks_.size(); ++block)
            for (std::size_t i = 0; i < blocks_[block].size(); ++i) {
                const Triangle::Box& box = blocks_[block][i].box;
                for (int band = box.lo.y / rows; band <= (box.hi.y - 1) / rows; ++band)
                    out[std::size_t(band)].push_back(std::uint32_t(block * kBlock + i));
            }
        return out;
    }

private:
    std::vector<Block> blocks_;
};

/// Where points of the sheet of the data lie in the picture.
class Placement {
public:
    Placement(const Camera& camera, const WorldFrame& frame, glm::ivec2 size, glm::dvec2 jitter)
        : frame_(frame), size_(size), jitter_(jitter),
          toClip_(projectionMatrix(camera, double(size.x) / size.y) * viewMatrix(camera)) {}

    glm::dvec3 world(glm::dvec3 sheet) const { return frame_.sheetToWorld(sheet); }
    glm::dvec4 clip(glm::dvec3 world) const { return toClip_ * glm::dvec4(world, 1); }
    /// A position of clip space with x and y in pixels, times w.
    glm::dvec4 pixels(glm::dvec4 clip) const {
        return {(glm::dvec2(clip) + clip.w) * 0.5 * glm::dvec2(size_), clip.z, clip.w};
    }
    glm::ivec2 size() const { return size_; }
    Triangle::Box box(const std::array<glm::dvec4, 3>& pixels) const { return Triangle::box(pixels, size_, jitter_); }
    const WorldFrame& frame() const { return frame_; }

private:
    WorldFrame frame_;
    glm::ivec2 size_;
    glm::dvec2 jitter_;
    glm::dmat4 toClip_;
};

/// Triangles [begin, end) of a mesh; `pixels`: its vertices in the picture.
void fillBlock(const Placement& placement, const SurfaceLayer& layer, const std::vector<glm::dvec4>& pixels,
               std::size_t begin, std::size_t end, Pieces::Block& block) {
    const Geometry& geometry = *layer.layer->geometry;
    const volume::SurfaceMesh& mesh = geometry.mesh;
    for (std::size_t n = begin; n < end; ++n) {
        const glm::uvec3 triangle = mesh.triangles[n];
        const std::array<glm::dvec4, 3> at{pixels[triangle.x], pixels[triangle.y], pixels[triangle.z]};
        const Triangle::Box box = placement.box(at);
        if (box.empty()) continue;
        std::array<SurfacePoint, 3> corners;
        for (int i = 0; i < 3; ++i) {
            const std::size_t v = triangle[i];
            const glm::dvec3 normal = mesh.normals.empty() ? glm::dvec3(0) : glm::dvec3(mesh.normals[v]);
            corners[std::size_t(i)] = {.world = placement.world(mesh.origin + glm::dvec3(mesh.positions[v])),
                                       .direction = normal / placement.frame().scale,
                                       .value = mesh.scalars.empty() ? 0 : double(mesh.scalars[v])};
        }
        const glm::vec4 tint = geometry.tints.empty() ? kNoTint : geometry.tints[triangle.z];
        block.push_back({Triangle(at), box, corners, &layer, tint, false});
    }
}

void addMesh(const Placement& placement, const SurfaceLayer& layer, Pieces& pieces) {
    const volume::SurfaceMesh& mesh = layer.layer->geometry->mesh;
    std::vector<glm::dvec4> pixels(mesh.positions.size());
    parallelRanges(
        pixels.size(),
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                pixels[i] =
                    placement.pixels(placement.clip(placement.world(mesh.origin + glm::dvec3(mesh.positions[i]))));
        },
        1024);
    const std::size_t count = mesh.triangles.size(), blocks = (count + Pieces::kBlock - 1) / Pieces::kBlock;
    Pieces::Block* const first = pieces.addBlocks(blocks);
    parallelFor(blocks, [&](std::size_t i) {
        fillBlock(placement, layer, pixels, i * Pieces::kBlock, std::min((i + 1) * Pieces::kBlock, count), first[i]);
    });
}

void addPiece(const Placement& placement, const std::array<glm::dvec4, 3>& clip,
              const std::array<SurfacePoint, 3>& corners, const SurfaceLayer& layer, Pieces& pieces) {
    const std::array<glm::dvec4, 3> at{placement.pixels(clip[0]), placement.pixels(clip[1]), placement.pixels(clip[2])};
    const Triangle::Box box = placement.box(at);
    if (!box.empty()) pieces.add({Triangle(at), box, corners, &layer, kNoTint, true});
}

/// A segment of a line as a strip of two triangles that faces the viewer. Twin: vis/shaders/geometry_lines.vert.glsl.
void addSegment(const Placement& placement, const std::array<SurfacePoint, 2>& ends, const SurfaceLayer& layer,
                Pieces& pieces) {
    const glm::dvec2 size(placement.size());
    const glm::dvec4 a = placement.clip(ends[0].world), b = placement.clip(ends[1].world);
    glm::dvec2 along = (glm::dvec2(b) / std::max(b.w, 1e-6) - glm::dvec2(a) / std::max(a.w, 1e-6)) * size;
    along = glm::dot(along, along) > 1e-12 ? glm::normalize(along) : glm::dvec2(1, 0);
    const glm::dvec2 beside = glm::dvec2(-along.y, along.x) * double(layer.layer->style.lineWidth) / size;
    std::array<glm::dvec4, 4> clip;
    std::array<SurfacePoint, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) {
        const double side = i >= 2 ? 1 : -1;
        clip[i] = i % 2 == 1 ? b : a;
        clip[i] += glm::dvec4(beside * (side * clip[i].w), 0, 0);
        corners[i] = ends[i % 2];
        corners[i].side = side;
    }
    addPiece(placement, {clip[0], clip[1], clip[2]}, {corners[0], corners[1], corners[2]}, layer, pieces);
    addPiece(placement, {clip[2], clip[1], clip[3]}, {corners[2], corners[1], corners[3]}, layer, pieces);
}

void addLines(const Placement& placement, const LineSet& lines, const SurfaceLayer& layer, Pieces& pieces) {
    std::size_t first = 0;
    for (const std::uint32_t end : lines.ends) {
        for (std::size_t i = first; i + 1 < std::min<std::size_t>(end, lines.positions.size()); ++i) {
            std::array<SurfacePoint, 2> ends;
            for (std::size_t k = 0; k < 2; ++k)
                ends[k] = {.world = placement.world(lines.origin + glm::dvec3(lines.positions[i + k])),
                           .value = lines.scalars.empty() ? 0 : double(lines.scalars[i + k])};
            ends[0].direction = ends[1].direction = ends[1].world - ends[0].world;
            addSegment(placement, ends, layer, pieces);
        }
        first = end;
    }
}

/// A pixel of a piece.
struct Fragment {
    int pixel = 0; ///< in the band
    float along = 0;
    std::uint32_t piece = 0; ///< the earlier one is in front where two are equally far
    bool operator<(const Fragment& b) const {
        return std::tie(pixel, along, piece) < std::tie(b.pixel, b.along, b.piece);
    }
};

/// Rows [begin, end) of a picture.
class Band {
public:
    Band(const SurfaceShading& shading, const Pieces& pieces, glm::ivec2 size, glm::dvec2 jitter, bool covers,
         int begin, int end)
        : shading_(shading), pieces_(pieces), size_(size), jitter_(jitter), covers_(covers), begin_(begin), end_(end) {}

    void draw(std::span<const std::uint32_t> numbers, packet::PacketGeometry& out) {
        for (const std::uint32_t number : numbers) collect(number);
        std::ranges::sort(fragments_, std::less<>{});
        for (std::size_t i = 0; i < fragments_.size();) {
            std::size_t next = i;
            while (next < fragments_.size() && fragments_[next].pixel == fragments_[i].pixel) ++next;
            drawPixel(std::span(fragments_).subspan(i, next - i), out);
            i = next;
        }
    }

private:
    glm::dvec2 centre(glm::ivec2 pixel) const { return glm::dvec2(pixel) + 0.5 + jitter_; }

    void collect(std::uint32_t index) {
        const Piece& piece = pieces_[index];
        for (int y = std::max(piece.box.lo.y, begin_); y < std::min(piece.box.hi.y, end_); ++y)
            for (int x = piece.box.lo.x; x < piece.box.hi.x; ++x)
                if (const auto shares = piece.triangle.covered(centre({x, y})))
                    fragments_.push_back(
                        {(y - begin_) * size_.x + x, float(shading_.along(piece.between(*shares).world)), index});
    }

    /// What a pixel sees of a piece. Changes are taken within pairs of pixels, as OpenGL takes them.
    std::optional<SurfaceColor> colorOf(const Piece& piece, glm::ivec2 pixel) const {
        const SurfacePoint here = piece.between(*piece.triangle.covered(centre(pixel)));
        const auto next = [&](glm::ivec2 step) {
            const glm::ivec2 other = pixel ^ step;
            const auto shares = piece.triangle.shares(centre(other));
            if (!shares) return here;
            const SurfacePoint there = piece.between(*shares);
            const bool forward = other.x + other.y > pixel.x + pixel.y;
            return forward ? there : here * 2 + there * -1;
        };
        return shading_(*piece.layer, piece.line, {here, next({1, 0}), next({0, 1})}, piece.tint);
    }

    /// The nearest fragments of a pixel, which come sorted.
    void drawPixel(std::span<const Fragment> fragments, packet::PacketGeometry& out) const {
        const std::size_t pixels = std::size_t(size_.x) * std::size_t(size_.y);
        const int local = fragments.front().pixel;
        const glm::ivec2 pixel(local % size_.x, begin_ + local / size_.x);
        std::size_t to = std::size_t(pixel.y) * std::size_t(size_.x) + std::size_t(pixel.x);
        float last = -kNothingThere;
        int peel = 0;
        for (const Fragment& fragment : fragments) {
            if (peel == out.peels) return;
            if (fragment.along <= last) continue;
            const Piece& piece = pieces_[fragment.piece];
            const std::optional<SurfaceColor> seen = colorOf(piece, pixel);
            if (!seen) continue;
            out.distance[to * 2] = last = fragment.along;
            out.distance[to * 2 + 1] = float(int(piece.layer->layer->brushes));
            for (int c = 0; c < 4; ++c) out.color[to * 4 + std::size_t(c)] = float(seen->color[c]);
            if (covers_ && seen->color.a > kCovers) return;
            to += pixels;
            ++peel;
        }
    }

    const SurfaceShading& shading_;
    const Pieces& pieces_;
    glm::ivec2 size_;
    glm::dvec2 jitter_;
    bool covers_;
    int begin_, end_;
    std::vector<Fragment> fragments_;
};

} // namespace

packet::PacketGeometry rasterized(const Scene& scene, const volume::DatasetInfo& info, const packet::SceneLight& light,
                                  glm::ivec2 size, glm::dvec2 jitter) {
    constexpr int kRows = 16; // that one core draws in one go
    packet::PacketGeometry out{.peels = peelsOf(scene)};
    if (out.peels == 0) return out;
    const std::size_t texels = std::size_t(size.x) * std::size_t(size.y) * std::size_t(out.peels);
    out.distance.assign(texels * 2, 0);
    for (std::size_t i = 0; i < texels; ++i) out.distance[i * 2] = kNothingThere;
    out.color.assign(texels * 4, 0);
    const SurfaceShading shading(scene, info, light, size);
    const Placement placement(scene.camera, shading.frame(), size, jitter);
    Pieces pieces;
    for (const SurfaceLayer& layer : shading.layers()) {
        addMesh(placement, layer, pieces);
        addLines(placement, layer.layer->geometry->lines, layer, pieces);
    }
    const bool covers = !scene.selection.active(); // brushes change the opacity later
    const auto bands = pieces.inBands(kRows, std::size_t((size.y + kRows - 1) / kRows));
    parallelFor(bands.size(), [&](std::size_t i) {
        const int begin = int(i) * kRows;
        Band(shading, pieces, size, jitter, covers, begin, std::min(begin + kRows, size.y)).draw(bands[i], out);
    });
    return out;
}

} // namespace tessera::vis
