#include "vis/processor/rasterized.h"

#include "vis/processor/pieces.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <tuple>

namespace tessera::vis {

namespace {

constexpr float kNothingThere = 1e9f; ///< distance where there is no surface
constexpr double kCovers = 0.998;     ///< opacity of what occludes everything behind it

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
    /// `covers`: nothing is seen behind what is opaque. `whole`: everything is opaque and nothing is cut away, so that
    /// the nearest triangle of a pixel is what it shows.
    Band(const SurfaceShading& shading, const Pieces& pieces, glm::ivec2 size, glm::dvec2 jitter, bool covers,
         bool whole, int begin, int end)
        : shading_(shading), pieces_(pieces), size_(size), jitter_(jitter), covers_(covers), begin_(begin), end_(end) {
        if (whole) nearest_.resize(std::size_t(size.x) * std::size_t(end - begin), {0, kNothingThere, 0});
    }

    void draw(std::span<const std::uint32_t> numbers, packet::PacketGeometry& out) {
        for (const std::uint32_t number : numbers) collect(number);
        for (std::size_t i = 0; i < nearest_.size(); ++i) {
            nearest_[i].pixel = int(i);
            if (nearest_[i].along < kNothingThere) drawPixel(std::span(nearest_).subspan(i, 1), out);
        }
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

    void collect(std::uint32_t number) {
        const Piece piece = pieces_[number];
        const Triangle::Box box = pieces_.box(number);
        for (int y = std::max(box.lo.y, begin_); y < std::min(box.hi.y, end_); ++y)
            for (int x = box.lo.x; x < box.hi.x; ++x)
                if (const auto shares = piece.triangle.covered(centre({x, y})))
                    add({(y - begin_) * size_.x + x, float(shading_.along(piece.between(*shares).world)), number});
    }

    void add(const Fragment& fragment) {
        if (nearest_.empty()) {
            fragments_.push_back(fragment);
        } else if (Fragment& best = nearest_[std::size_t(fragment.pixel)]; fragment.along < best.along) {
            best = fragment; // of equally far ones the first stays
        }
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

    /// The piece of that number, which is often that of the pixel before.
    const Piece& pieceOf(std::uint32_t number) {
        if (!last_ || last_->first != number) last_.emplace(number, pieces_[number]);
        return last_->second;
    }

    /// The nearest fragments of a pixel, which come sorted.
    void drawPixel(std::span<const Fragment> fragments, packet::PacketGeometry& out) {
        const std::size_t pixels = std::size_t(size_.x) * std::size_t(size_.y);
        const int local = fragments.front().pixel;
        const glm::ivec2 pixel(local % size_.x, begin_ + local / size_.x);
        std::size_t to = std::size_t(pixel.y) * std::size_t(size_.x) + std::size_t(pixel.x);
        float last = -kNothingThere;
        int peel = 0;
        for (const Fragment& fragment : fragments) {
            if (peel == out.peels) return;
            if (fragment.along <= last) continue;
            const Piece& piece = pieceOf(fragment.piece);
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
    std::vector<Fragment> fragments_, nearest_; ///< nearest_: of each pixel, or empty
    std::optional<std::pair<std::uint32_t, Piece>> last_;
};

/// Whether nothing of the geometry of a scene is cut away, by places, by a look or as a rim.
bool isWhole(const Scene& scene) {
    const auto cuts = [](const GeometryLayer& layer) { return layer.style.look.any() || layer.style.rim > 0; };
    return scene.clips.empty() && scene.lenses.empty() && std::ranges::none_of(scene.geometry, cuts);
}

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
    const Pieces pieces(shading, scene.camera, size, jitter);
    const bool covers = !scene.selection.active(); // brushes change the opacity later
    const bool whole = out.peels == 1 && isWhole(scene);
    const auto bands = pieces.inBands(kRows, std::size_t((size.y + kRows - 1) / kRows));
    parallelFor(bands.size(), [&](std::size_t i) {
        const int begin = int(i) * kRows;
        Band(shading, pieces, size, jitter, covers, whole, begin, std::min(begin + kRows, size.y)).draw(bands[i], out);
    });
    return out;
}

} // namespace tessera::vis
