#include "tests/codec/plain/fitted.h"

#include "tests/codec/plain/bands.h"

#include <algorithm>
#include <cstdlib>

namespace tessera::codec::plain {

namespace {

struct Tap {
    int z, y, x;
    bool own = false;
};

/// Taps of the passes in the order of their weights, in samples of the level; those of `odd` in cells.
std::vector<Tap> alongZ() {
    return {{-1, 0, 0},        {1, 0, 0},       {0, -2, 0, true}, {-2, 0, 0, true}, {-1, 0, -2},       {-1, 0, 2},
            {1, 0, -2},        {1, 0, 2},       {-1, -2, 0},      {-1, 2, 0},       {1, -2, 0},        {1, 2, 0},
            {-1, -2, -2},      {-1, -2, 2},     {-1, 2, -2},      {-1, 2, 2},       {1, -2, -2},       {1, -2, 2},
            {1, 2, -2},        {1, 2, 2},       {-3, 0, 0},       {3, 0, 0},        {0, -2, -2, true}, {0, -2, 2, true},
            {-2, -2, 0, true}, {-2, 2, 0, true}};
}
std::vector<Tap> alongY() {
    return {{0, -1, 0},       {0, 1, 0},         {-1, 0, 0, true},  {0, -2, 0, true},  {-1, -1, 0},
            {-1, 1, 0},       {1, -1, 0},        {1, 1, 0},         {-1, -1, -2},      {-1, -1, 2},
            {-1, 1, -2},      {-1, 1, 2},        {0, -1, -2},       {0, -1, 2},        {0, 1, -2},
            {0, 1, 2},        {1, -1, -2},       {1, -1, 2},        {1, 1, -2},        {1, 1, 2},
            {0, -3, 0},       {0, 3, 0},         {-1, 0, -2, true}, {0, -2, -2, true}, {-1, 0, 2, true},
            {0, -2, 2, true}, {-1, -2, 0, true}, {-1, 2, 0, true}};
}
std::vector<Tap> alongX() {
    return {{0, 0, -1},        {0, 0, 1},         {-1, 0, 0, true},   {0, -1, 0, true},  {-1, 0, -1},
            {0, -1, -1},       {-1, 0, 1},        {0, -1, 1},         {1, 0, -1},        {0, 1, -1},
            {1, 0, 1},         {0, 1, 1},         {-1, -1, -1},       {-1, -1, 1},       {-1, 1, -1},
            {-1, 1, 1},        {1, -1, -1},       {1, -1, 1},         {1, 1, -1},        {1, 1, 1},
            {0, 0, -3},        {0, 0, 3},         {-1, -1, -2, true}, {-1, -1, 2, true}, {-1, 0, -2, true},
            {-1, 0, 2, true},  {-1, 1, -2, true}, {-1, 1, 2, true},   {-1, -1, 0, true}, {-1, 1, 0, true},
            {0, -1, -2, true}, {0, -1, 2, true},  {0, -2, 0, true},   {-2, 0, 0, true}};
}
std::vector<Tap> odd() {
    std::vector<Tap> taps{{0, 0, 0}, {1, 1, 1}, {0, 0, 1}, {0, 1, 0},        {0, 1, 1},
                          {1, 0, 0}, {1, 0, 1}, {1, 1, 0}, {-1, 0, 0, true}, {0, -1, 0, true}};
    for (const int far : {-1, 2})
        for (int a = 0; a < 2; ++a)
            for (int b = 0; b < 2; ++b) {
                taps.push_back({far, a, b});
                taps.push_back({a, far, b});
                taps.push_back({a, b, far});
            }
    for (const Tap& tap : {Tap{-1, 0, -1, true},
                           {0, -1, -1, true},
                           {-1, 0, 1, true},
                           {0, -1, 1, true},
                           {-1, -1, 0, true},
                           {-1, 1, 0, true}})
        taps.push_back(tap);
    return taps;
}

/// A pass: the samples with remainders `first` modulo `step`, predicted from those with `known` modulo `knownStep`.
struct Pass {
    std::vector<Tap> taps;
    std::size_t near;
    Size first, step, known, knownStep; ///< x, y, z
    Size before;                        ///< what stands in place of rows before the first, relative to the tap
    Box *own, *from;
};

int clampTo(int value, int first, int step, int size) {
    const int last = first + (size - 1 - first) / step * step;
    return std::clamp(value, first, last);
}

std::int64_t tapValue(const Pass& pass, const Tap& tap, const Size& at) {
    Size place{at[0] + tap.x, at[1] + tap.y, at[2] + tap.z};
    bool own = tap.own;
    if (own && (place[2] < pass.first[2] || place[1] < pass.first[1])) {
        own = false;
        place = {at[0] + tap.x + pass.before[0], at[1] + pass.before[1], at[2] + pass.before[2]};
    }
    Box& box = own ? *pass.own : *pass.from;
    for (std::size_t a = 0; a < 3; ++a)
        place[a] = own ? clampTo(place[a], pass.first[a], pass.step[a], box.size[a])
                       : clampTo(place[a], pass.known[a], pass.knownStep[a], box.size[a]);
    return asSigned(*box.at(place));
}

Foreseen foresee(const Pass& pass, const std::vector<std::vector<std::int32_t>>& weights, const FittedBrick& of,
                 const Size& at) {
    std::vector<std::int64_t> values;
    for (const Tap& tap : pass.taps) values.push_back(tapValue(pass, tap, at));
    const std::int64_t guess = (values[0] + values[1]) >> 1;
    std::uint32_t activity = 0;
    for (std::size_t t = 0; t < pass.near; ++t) activity += std::uint32_t(std::abs(values[t] - guess));
    activity = std::min(activity >> of.model.shift, 32767u);
    need(weights.size() == 32, "weights");
    const auto& own = weights[std::min(classOf(activity), 31u)];
    std::int64_t sum = 128 + own.back();
    for (std::size_t t = 0; t < values.size(); ++t) sum += own[t] * values[t];
    return {std::clamp(sum >> 8, of.least, of.most), activity};
}

} // namespace

void readFitted(const FittedBrick& of, const std::vector<Octets>& segments, std::vector<Box>& boxes) {
    const Size finest = boxes[0].size;
    const auto sizeAt = [&](int level) {
        Size size = finest;
        for (int l = of.level; l < level; ++l) size = half(size);
        return size;
    };
    Box samples = makeBox(sizeAt(of.levels - 1));
    places({0, 0, 0}, samples.size, [&](const Size& p) { samples.at(p) = boxes[0].at(p); });
    for (int level = of.levels - 2; level >= of.level; --level) {
        const Octets& bytes = segments[std::size_t(of.levels - 2 - level)];
        Box next = makeBox(sizeAt(level));
        places({0, 0, 0}, samples.size, [&](const Size& p) { next.at(2 * p[0], 2 * p[1], 2 * p[2]) = samples.at(p); });
        std::vector<Pass> passes{{alongZ(), 12, {0, 0, 1}, {2, 2, 2}, {0, 0, 0}, {2, 2, 2}, {0, 0, -1}, &next, &next},
                                 {alongY(), 8, {0, 1, 0}, {2, 2, 1}, {0, 0, 0}, {2, 2, 1}, {0, -1, 0}, &next, &next},
                                 {alongX(), 8, {1, 0, 0}, {2, 1, 1}, {0, 0, 0}, {2, 1, 1}, {-1, 0, 0}, &next, &next}};
        if (level == 0 && boxes.size() == 2)
            passes.push_back({odd(), 10, {0, 0, 0}, {1, 1, 1}, {0, 0, 0}, {1, 1, 1}, {0, 0, 0}, &boxes[1], &next});
        std::vector<Band> bands;
        std::vector<std::size_t> passOf;
        for (std::size_t p = 0; p < passes.size(); ++p) {
            constexpr int kKinds[] = {4, 2, 1, 0};
            Band band{passes[p].own, passes[p].first, passes[p].own->size, kKinds[p], passes[p].step};
            if (band.size(0) < 1 || band.size(1) < 1 || band.size(2) < 1) continue;
            bands.push_back(band);
            passOf.push_back(p);
        }
        Reader in(bytes);
        const auto known = [&](std::size_t band, const Size& place) {
            const std::size_t p = passOf[band];
            return foresee(passes[p], of.model.weights[std::size_t(4 * std::min(level, 2)) + p], of, place);
        };
        if (bands.empty()) {
            need(bytes.empty(), "trailing bytes");
        } else if (const auto mode = in.number(1); mode == 4) {
            decodeBands(in.take(std::size_t(in.end - in.at)), bands, std::size_t(level), of.model, known);
        } else {
            need(mode == 0 && in.at == in.end, "mode");
            for (std::size_t b = 0; b < bands.size(); ++b)
                for (int z = 0; z < bands[b].size(2); ++z)
                    for (int y = 0; y < bands[b].size(1); ++y)
                        for (int x = 0; x < bands[b].size(0); ++x) {
                            const Band& band = bands[b];
                            const Size place{band.lo[0] + x * band.step[0], band.lo[1] + y * band.step[1],
                                             band.lo[2] + z * band.step[2]};
                            band.box->at(place) = std::uint32_t(known(b, place).value);
                        }
        }
        samples = next;
    }
    boxes[0] = samples;
    if (boxes.size() == 2 && of.level > 0) predictOdd(boxes[0], boxes[1], of.level);
}

} // namespace tessera::codec::plain
