#include "vis/demand/added_rays.h"

#include "vis/optics/jitter.h"
#include "vis/optics/ray_setup.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <variant>

namespace tessera::vis {

namespace {

constexpr int kProbes = 17;  ///< one block of so many has all rays in any case; prime, so that every line meets some
constexpr int kFollowed = 2; ///< pixels around one that differs from what was predicted
static_assert(kFollowed <= AddedRays::kBlock);
/// Of the blocks of a group that show anything: if more are chosen, all of them are.
constexpr double kDense = 0.6;

float greatest(const glm::vec4& of) {
    return std::max({std::abs(of.x), std::abs(of.y), std::abs(of.z), std::abs(of.w)});
}

template <class Body> void forEach(const Tile& tile, Body&& body) {
    for (int y = tile.begin.y; y < tile.end.y; ++y)
        for (int x = tile.begin.x; x < tile.end.x; ++x) body(glm::ivec2(x, y));
}

template <class Test> bool anyIn(const Tile& tile, Test&& test) {
    for (int y = tile.begin.y; y < tile.end.y; ++y)
        for (int x = tile.begin.x; x < tile.end.x; ++x)
            if (test(glm::ivec2(x, y))) return true;
    return false;
}

/// Calls body(group), a tile of blocks, for those of a tile of blocks that begins with a group.
template <class Body> void forEachGroup(const Tile& blocks, Body&& body) {
    constexpr int kEdge = AddedRays::kGroup / AddedRays::kBlock;
    for (int y = blocks.begin.y; y < blocks.end.y; y += kEdge)
        for (int x = blocks.begin.x; x < blocks.end.x; x += kEdge)
            body(intersection({{x, y}, glm::ivec2(x, y) + kEdge}, blocks));
}

/// Whether all that is drawn is strokes and grain, which differ from pixel to pixel.
bool drawsGrainAlone(const Scene& scene) {
    bool any = false;
    for (const Layer& layer : scene.layers) {
        if (!layer.visible) continue;
        const VolumeLayer* const volume = std::get_if<VolumeLayer>(&layer.technique);
        const Look* const look = lookOf(layer.technique);
        if ((volume && volume->style != RayStyle::Composite) || !look || !look->charcoal) return false;
        any = true;
    }
    for (const GeometryLayer& layer : scene.geometry) {
        if (!drawn(scene, layer)) continue;
        if (!layer.style.look.charcoal) return false;
        any = true;
    }
    return any;
}

/// The colour of a pixel of a picture, part of which may be left out.
glm::vec4 colorIn(const packet::PacketPicture& picture, glm::ivec2 pixel) {
    if (!Tile{picture.box.begin, picture.box.end}.holds(pixel)) return glm::vec4(0);
    const glm::ivec2 in = pixel - picture.box.begin;
    const float* rgba = picture.rgba.data() +
                        std::size_t(4) * (std::size_t(in.y) * std::size_t(picture.box.extent().x) + std::size_t(in.x));
    return {rgba[0], rgba[1], rgba[2], rgba[3]};
}

} // namespace

void AddedRays::begin(const Scene& scene, glm::ivec2 size, const Tile& area) {
    size_ = size;
    area_ = area;
    // Rays that a lens spreads over what is out of focus say nothing of each other.
    seen_ = {.bound = scene.camera.aperture > 0 || drawsGrainAlone(scene) ? 0 : kAlike,
             .ground = glm::vec3(linearFromSrgb(glm::dvec3(groundColor(scene)))),
             .showGround = scene.showGround,
             .tone = scene.tone};
    const int rays = raysPerPixel(scene);
    mean_ = squares_ = glm::vec2(0);
    product_ = 0;
    for (int pass = 0; pass < rays; ++pass) {
        const glm::vec2 place(pixelJitter(pass));
        mean_ += place / float(rays);
        squares_ += place * place / float(rays);
        product_ += place.x * place.y / float(rays);
    }
    const auto pixels = std::size_t(area.area());
    first_.resize(pixels);
    shown_.resize(pixels);
    now_.resize(pixels);
    count_ = (area.end - area.begin + kBlock - 1) / kBlock;
    states_.assign(std::size_t(count_.x) * std::size_t(count_.y), State::Open);
}

std::size_t AddedRays::at(glm::ivec2 pixel) const {
    const glm::ivec2 in = pixel - area_.begin;
    return std::size_t(in.y) * std::size_t(area_.end.x - area_.begin.x) + std::size_t(in.x);
}

Tile AddedRays::pixelsOf(const Tile& blocks) const {
    return intersection({area_.begin + blocks.begin * kBlock, area_.begin + blocks.end * kBlock}, area_);
}

Tile AddedRays::blocksOf(const Tile& pixels) const {
    const Tile within = intersection(pixels, area_);
    if (within.empty()) return {};
    return {(within.begin - area_.begin) / kBlock, (within.end - area_.begin + kBlock - 1) / kBlock};
}

AddedRays::State& AddedRays::state(glm::ivec2 block) {
    return states_[std::size_t(block.y) * std::size_t(count_.x) + std::size_t(block.x)];
}
AddedRays::State AddedRays::state(glm::ivec2 block) const {
    return states_[std::size_t(block.y) * std::size_t(count_.x) + std::size_t(block.x)];
}

/// A colour as a screen shows it, nearly: equal differences are equally seen, dark or bright.
glm::vec4 AddedRays::shown(const glm::vec4& rgba) const {
    constexpr float kDark = 0.0015f; // makes the root as steep in the dark as sRGB is
    glm::vec3 light = glm::max(glm::vec3(rgba), 0.0f);
    const float opacity = glm::clamp(rgba.a, 0.0f, 1.0f);
    if (seen_.tone.curve != ToneCurve::None)
        light = glm::vec3(toneMap(glm::dvec3(light / std::max(opacity, 1e-6f)), seen_.tone)) * opacity;
    if (!seen_.showGround) return {glm::sqrt(light + kDark), opacity};
    return {glm::sqrt(light + (1 - opacity) * seen_.ground + kDark), 0};
}

/// Of a pixel, or beside the area: there the two pixels at its border go on as a straight line.
glm::vec4 AddedRays::around(const std::vector<glm::vec4>& of, glm::ivec2 pixel) const {
    for (int axis = 0; axis < 2; ++axis) {
        const int least = area_.begin[axis], most = area_.end[axis] - 1;
        if (pixel[axis] >= least && pixel[axis] <= most) continue;
        glm::ivec2 near = pixel, far = pixel;
        near[axis] = glm::clamp(pixel[axis], least, most);
        far[axis] = glm::clamp(2 * near[axis] - pixel[axis], least, most);
        return 2.0f * around(of, near) - around(of, far);
    }
    return of[at(pixel)];
}

/// A pixel and its neighbours, row by row.
AddedRays::Nine AddedRays::nine(const std::vector<glm::vec4>& of, glm::ivec2 pixel) const {
    Nine out;
    const bool inside =
        pixel.x > area_.begin.x && pixel.y > area_.begin.y && pixel.x + 1 < area_.end.x && pixel.y + 1 < area_.end.y;
    for (int y = 0; y < 3; ++y)
        if (inside)
            std::copy_n(of.begin() + std::ptrdiff_t(at(pixel + glm::ivec2(-1, y - 1))), 3, out.begin() + 3 * y);
        else
            for (int x = 0; x < 3; ++x) out[std::size_t(3 * y + x)] = around(of, pixel + glm::ivec2(x - 1, y - 1));
    return out;
}

/// The mean over the places of all rays of the polynomial through the first ones.
glm::vec4 AddedRays::predicted(glm::ivec2 pixel) const {
    const Nine of = nine(first_, pixel);
    const glm::vec4 own = of[4], left = of[3], right = of[5], below = of[1], above = of[7];
    return own +
           0.5f * (mean_.x * (right - left) + mean_.y * (above - below) + squares_.x * (left + right - 2.0f * own) +
                   squares_.y * (below + above - 2.0f * own)) +
           0.25f * product_ * (of[8] + of[0] - of[2] - of[6]);
}

/// Whether the first rays of pixels have met nothing.
bool AddedRays::isEmpty(const Tile& pixels) const {
    for (int y = pixels.begin.y; y < pixels.end.y; ++y) {
        const auto row = first_.begin() + std::ptrdiff_t(at({pixels.begin.x, y}));
        if (!std::all_of(row, row + (pixels.end.x - pixels.begin.x),
                         [](const glm::vec4& color) { return color == glm::vec4(0); }))
            return false;
    }
    return true;
}

/// Whether a pixel differs from the mean of two opposite neighbours.
bool AddedRays::standsOut(glm::ivec2 pixel) const {
    const Nine of = nine(shown_, pixel);
    for (std::size_t i = 0; i < 4; ++i)
        if (greatest(of[4] - 0.5f * (of[i] + of[8 - i])) > seen_.bound) return true;
    return false;
}

void AddedRays::takeFirst(const packet::PacketPicture& picture, const Tile& tile) {
    forEach(tile, [&](glm::ivec2 pixel) { first_[at(pixel)] = colorIn(picture, pixel); });
}

bool AddedRays::choose(const Tile& tile) {
    const Tile blocks = blocksOf(tile), needed = intersection({tile.begin - 2, tile.end + 2}, area_);
    if (blocks.empty() || state(blocks.begin) != State::Open) return false;
    if (!(seen_.bound > 0)) {
        forEach(blocks, [&](glm::ivec2 block) { setChosen(block); });
        return true;
    }
    parallelFor(std::size_t(needed.end.y - needed.begin.y), [&](std::size_t row) {
        const int y = needed.begin.y + int(row);
        forEach({{needed.begin.x, y}, {needed.end.x, y + 1}},
                [&](glm::ivec2 pixel) { shown_[at(pixel)] = shown(first_[at(pixel)]); });
    });
    parallelFor(std::size_t(blocks.end.y - blocks.begin.y), [&](std::size_t row) {
        const int y = blocks.begin.y + int(row);
        forEach({{blocks.begin.x, y}, {blocks.end.x, y + 1}}, [&](glm::ivec2 block) {
            const Tile own = pixelsOf(block), wide = intersection({own.begin - 1, own.end + 1}, area_);
            const bool probed = (block.x + 5 * block.y) % kProbes == 0;
            if (!probed && isEmpty(intersection({own.begin - 2, own.end + 2}, area_))) {
                state(block) = State::Predicted;
                return forEach(own, [&](glm::ivec2 p) { now_[at(p)] = glm::vec4(0); });
            }
            if (probed || anyIn(wide, [&](glm::ivec2 pixel) { return standsOut(pixel); })) return setChosen(block);
            state(block) = State::Predicted;
            forEach(own, [&](glm::ivec2 p) { now_[at(p)] = predicted(p); });
        });
    });
    forEachGroup(blocks, [&](const Tile& group) { chooseDense(group); });
    return true;
}

void AddedRays::setChosen(glm::ivec2 block) {
    state(block) = State::Chosen;
    forEach(pixelsOf(block), [&](glm::ivec2 p) { now_[at(p)] = first_[at(p)]; });
}

/// Chooses all blocks of a group that show anything, if most of them are.
void AddedRays::chooseDense(const Tile& group) {
    int shows = 0, chosen = 0;
    forEach(group, [&](glm::ivec2 block) {
        if (isEmpty(pixelsOf(block))) return;
        ++shows;
        chosen += state(block) == State::Chosen ? 1 : 0;
    });
    if (chosen == shows || chosen <= kDense * shows) return;
    forEach(group, [&](glm::ivec2 block) {
        if (state(block) == State::Predicted && !isEmpty(pixelsOf(block))) setChosen(block);
    });
}

/// Whether what is found in a block may choose others.
bool AddedRays::besidePredicted(glm::ivec2 block) const {
    return anyIn(intersection({block - 1, block + 2}, {{0, 0}, count_}),
                 [&](glm::ivec2 other) { return state(other) == State::Predicted; });
}

std::vector<packet::PixelBox> AddedRays::blocks(const Tile& tile) const {
    std::vector<packet::PixelBox> out;
    const auto isChosen = [&](glm::ivec2 block) { return state(block) == State::Chosen; };
    const auto add = [&](const Tile& pixels) { out.push_back({pixels.begin, pixels.end}); };
    forEachGroup(blocksOf(tile), [&](const Tile& group) {
        if (!anyIn(group, [&](glm::ivec2 block) { return !isChosen(block); })) return add(pixelsOf(group));
        forEach(group, [&](glm::ivec2 block) {
            if (isChosen(block)) add(pixelsOf(block));
        });
    });
    return out;
}

void AddedRays::take(const packet::PacketPicture& picture, const Tile& tile, int pass) {
    for (const packet::PixelBox& box : blocks(tile))
        forEach({box.begin, box.end}, [&](glm::ivec2 pixel) {
            glm::vec4& mean = now_[at(pixel)];
            mean += (colorIn(picture, pixel) - mean) / float(pass + 1);
        });
}

bool AddedRays::chooseMore() {
    std::vector<glm::ivec2> differ; // pixels
    forEach({{0, 0}, count_}, [&](glm::ivec2 block) {
        if (state(block) != State::Chosen) return;
        state(block) = State::Done;
        if (!(seen_.bound > 0) || !besidePredicted(block)) return;
        forEach(pixelsOf(block), [&](glm::ivec2 pixel) {
            if (greatest(shown(now_[at(pixel)]) - shown(predicted(pixel))) > seen_.bound) differ.push_back(pixel);
        });
    });
    bool any = false;
    for (const glm::ivec2& pixel : differ)
        forEach(blocksOf({pixel - kFollowed, pixel + kFollowed + 1}), [&](glm::ivec2 block) {
            if (state(block) != State::Predicted) return;
            setChosen(block);
            any = true;
        });
    return any;
}

void AddedRays::show(const Tile& tile, packet::PacketPicture& out) const {
    out.begin(size_, {tile.begin, tile.end}, false);
    float* to = out.rgba.data();
    forEach(tile, [&](glm::ivec2 pixel) {
        const glm::vec4& color = now_[at(pixel)];
        for (int part = 0; part < 4; ++part) *to++ = color[part];
    });
}

double AddedRays::share() const {
    const auto chosen =
        std::ranges::count_if(states_, [](State state) { return state == State::Chosen || state == State::Done; });
    return states_.empty() ? 0 : double(chosen) / double(states_.size());
}

} // namespace tessera::vis
