#include "vis/lic/make_strokes.h"

#include "volume/base/parallel.h"
#include "volume/bricks/brick_cache.h"
#include "volume/bricks/parts_bricks.h"
#include "volume/reconstruct/probe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

namespace tessera::vis {

namespace {

constexpr int kGrain = 2;                                     ///< texels in a stroke's width
constexpr int kBlock = 64;                                    ///< texels along the edge of what is sampled in one go
constexpr std::size_t kStrokeBricks = std::size_t(128) << 20; ///< bytes of decoded bricks
constexpr float kNoVector = std::numeric_limits<float>::quiet_NaN();

/// Corners of the part of a plane in the box |p| <= half, in no order.
std::vector<glm::dvec3> cornersInBox(const Plane& plane, glm::dvec3 half) {
    std::vector<glm::dvec3> corners;
    const double slack = 1e-9 * std::max(glm::length(half), 1e-300);
    const auto distance = [&](glm::dvec3 at) { return glm::dot(plane.normal, at) - plane.offset; };
    for (int axis = 0; axis < 3; ++axis)
        for (int edge = 0; edge < 4; ++edge) {
            glm::dvec3 from = -half;
            if (edge & 1) from[(axis + 1) % 3] = half[(axis + 1) % 3];
            if (edge & 2) from[(axis + 2) % 3] = half[(axis + 2) % 3];
            glm::dvec3 to = from;
            to[axis] = half[axis];
            const double a = distance(from), b = distance(to);
            if (std::abs(a) <= slack) corners.push_back(from);
            if (std::abs(b) <= slack) corners.push_back(to);
            if ((a < -slack && b > slack) || (a > slack && b < -slack))
                corners.push_back(glm::mix(from, to, a / (a - b)));
        }
    return corners;
}

/// The axis of the world that the rows of a plane run along as far as they can.
glm::dvec3 rowsOf(glm::dvec3 normal) {
    const glm::dvec3 along = std::abs(normal.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    return glm::normalize(along - normal * glm::dot(along, normal));
}

/// A place of the data, or none; rounding puts none of their faces outside.
std::optional<glm::dvec3> placeInData(glm::dvec3 place, const volume::Box& box) {
    const glm::dvec3 inside = glm::clamp(place, box.lo, box.hi);
    if (glm::distance(place, inside) > 1e-9 * glm::length(box.size())) return std::nullopt;
    return inside;
}

/// Sets the texels of a block.
class StrokeSampler {
public:
    StrokeSampler(const volume::BrickSource& source, int parameter, int time, const StrokeRoom& room,
                  const WorldFrame& frame)
        : source_(source), time_(time), room_(room), frame_(frame),
          parts_(volume::labelChannel(source.info(), source.info().parameters[std::size_t(parameter)])) {
        for (int c = 0; c < 3; ++c) channels_[std::size_t(c)] = source.info().channelIndex(parameter, c);
    }
    bool hasParts() const { return parts_.has_value(); }

    void operator()(glm::ivec2 begin, glm::ivec2 end, StrokeSamples& out) const {
        std::vector<glm::dvec3> places;
        std::vector<std::size_t> texels;
        for (int y = begin.y; y < end.y; ++y)
            for (int x = begin.x; x < end.x; ++x) {
                const auto place = placeInData(frame_.toPhysical(room_.middleOf({x, y})), source_.info().bounds);
                if (!place) continue;
                places.push_back(*place);
                texels.push_back(out.field.index({x, y}));
            }
        std::array<std::vector<volume::ProbeValue>, 3> found;
        for (std::size_t c = 0; c < 3; ++c) found[c] = volume::probeAlong(source_, channels_[c], places, time_);
        for (std::size_t i = 0; i < places.size(); ++i) {
            if (!found[0][i].interpolated || !found[1][i].interpolated || !found[2][i].interpolated) continue;
            set(texels[i], places[i], {*found[0][i].interpolated, *found[1][i].interpolated, *found[2][i].interpolated},
                out);
        }
        if (!parts_) return;
        const auto labels = volume::probeAlong(source_, *parts_, places, time_);
        for (std::size_t i = 0; i < places.size(); ++i)
            out.field.parts[texels[i]] = std::uint16_t(std::lround(labels[i].nearest.value_or(0)));
    }

private:
    void set(std::size_t texel, glm::dvec3 place, glm::dvec3 vector, StrokeSamples& out) const {
        const volume::Lattice& lattice = source_.info().lattice;
        const glm::dvec3 drawn = frame_.scale * (glm::abs(lattice.spacing) / lattice.lengthsAt(place));
        const glm::dvec3 world = vector * drawn, normal = glm::normalize(room_.normal * drawn);
        out.field.vectors[texel] = glm::vec2(glm::dot(room_.right, world), glm::dot(room_.up, world));
        out.speed[texel] = float(glm::length(vector - normal * glm::dot(normal, vector)));
    }

    const volume::BrickSource& source_;
    int time_;
    const StrokeRoom& room_;
    const WorldFrame& frame_;
    std::optional<int> parts_;
    std::array<int, 3> channels_{};
};

} // namespace

std::optional<int> vectorNamed(const volume::DatasetInfo& info, const std::string& name) {
    for (std::size_t p = 0; p < info.parameters.size(); ++p)
        if (info.parameters[p].components == 3 && info.parameters[p].name == name) return int(p);
    return std::nullopt;
}

StrokeRoom strokeRoom(const Plane& plane, const WorldFrame& frame, double texel) {
    StrokeRoom room;
    room.normal = plane.normal;
    room.right = rowsOf(plane.normal);
    room.up = glm::cross(plane.normal, room.right);
    if (room.up[std::abs(plane.normal.y) > 0.9 ? 2 : 1] < 0) room.up = -room.up;
    room.foot = plane.normal * plane.offset;
    room.texel = texel;
    const std::vector<glm::dvec3> corners = cornersInBox(plane, frame.halfSize);
    if (corners.empty()) return room;
    glm::dvec2 lo(1e300), hi(-1e300);
    for (const glm::dvec3& corner : corners) {
        const glm::dvec2 at(glm::dot(room.right, corner), glm::dot(room.up, corner));
        lo = glm::min(lo, at);
        hi = glm::max(hi, at);
    }
    if (!(hi.x > lo.x) || !(hi.y > lo.y)) return room;
    constexpr double kSlack = 1e-6; // texels
    room.first = glm::ivec2(glm::floor(lo / texel + kSlack));
    room.size = glm::max(glm::ivec2(glm::ceil(hi / texel - kSlack)) - room.first, glm::ivec2(1));
    return room;
}

StrokeSamples sampleStrokes(const std::shared_ptr<const volume::BrickSource>& source, int parameter, int time,
                            const StrokeRoom& room, const WorldFrame& frame, const Progress& progress) {
    const volume::BrickCache cache(source, kStrokeBricks);
    const StrokeSampler sample(cache, parameter, time, room, frame);
    StrokeSamples out;
    out.field.size = room.size;
    const std::size_t count = std::size_t(room.size.x) * std::size_t(room.size.y);
    out.field.vectors.assign(count, glm::vec2(kNoVector));
    if (sample.hasParts()) out.field.parts.assign(count, 0);
    out.speed.assign(count, 0);
    const glm::ivec2 blocks = (room.size + kBlock - 1) / kBlock;
    for (int row = 0; row < blocks.y; ++row) {
        progress.advance(double(row) / blocks.y);
        parallelFor(std::size_t(blocks.x), [&](std::size_t column) {
            const glm::ivec2 begin = glm::ivec2(int(column), row) * kBlock;
            sample(begin, glm::min(begin + kBlock, room.size), out);
        });
    }
    return out;
}

std::shared_ptr<const StrokePicture> makeStrokes(const std::shared_ptr<const volume::BrickSource>& source,
                                                 const Strokes& strokes, int time, const Plane& plane,
                                                 glm::dvec3 stretch, const Progress& progress) {
    const std::optional<int> parameter = vectorNamed(source->info(), strokes.vector);
    if (!parameter) return nullptr;
    const WorldFrame frame = worldFrame(source->info(), stretch);
    const double texel = double(strokes.width) / kGrain;
    const StrokeRoom room = strokeRoom(plane, frame, texel);
    if (room.size == glm::ivec2(0)) return nullptr;
    const StrokeSamples samples = sampleStrokes(source, *parameter, time, room, frame, progress.part(0, 0.4));
    const std::vector<float> noise = planeNoise(room.size, room.first, kGrain, std::uint32_t(strokes.random));
    const std::vector<float> lightness = lineIntegralConvolution(
        samples.field, noise, {double(strokes.length) / texel, strokes.kernel}, progress.part(0.4, 1));
    const float fastest = *std::max_element(samples.speed.begin(), samples.speed.end());
    auto picture = std::make_shared<StrokePicture>();
    picture->size = room.size;
    picture->texels.resize(lightness.size(), glm::vec2(0));
    for (std::size_t i = 0; i < lightness.size(); ++i) {
        if (std::isnan(lightness[i])) continue;
        const float share = strokes.bySpeed && fastest > 0 ? samples.speed[i] / fastest : 1;
        picture->texels[i] = {lightness[i] * share, 1};
    }
    const glm::dvec2 corner = glm::dvec2(room.first) * texel;
    picture->corner = room.foot + room.right * corner.x + room.up * corner.y;
    picture->right = room.right;
    picture->up = room.up;
    picture->texel = texel;
    return picture;
}

} // namespace tessera::vis
