#include "vis/optics/brush_tests.h"

#include "vis/optics/ray_setup.h"

#include <algorithm>

namespace tessera::vis {

namespace {

class Encoder {
public:
    Encoder(const volume::DatasetInfo& info, std::span<const int> channels, std::span<const PlacedLens> lenses)
        : info_(info), channels_(channels), lenses_(lenses) {}

    BrushTests out;

    void add(const Brush& brush) {
        const std::size_t first = out.tests.size(), lassos = out.lassos.size();
        std::visit([&](const auto& region) { encode(region); }, brush.region);
        if (out.tests.size() == first) out.tests.emplace_back();
        // Omit whole brushes only: half of a brush would select too much.
        if (out.dropped > 0 || out.tests.size() > std::size_t(kMaxBrushTests)) {
            ++out.dropped;
            out.tests.resize(first);
            out.lassos.resize(lassos);
            return;
        }
        const bool holds = !brush.inverted && brush.combine != BrushCombine::Minus;
        const glm::vec4 color(linearFromSrgb(glm::dvec3(brush.color)), holds ? 1 : 0);
        for (std::size_t i = first; i < out.tests.size(); ++i) out.tests[i].color = color;
        if (first == 0) out.start = brush.combine == BrushCombine::Or ? 0.0f : 1.0f;
        out.tests[first].flags |= BrushTest::First;
        const bool inverted = brush.inverted != (brush.combine == BrushCombine::Minus);
        out.tests.back().flags |= BrushTest::Last | (inverted ? BrushTest::Inverted : 0) |
                                  (brush.combine == BrushCombine::Or ? BrushTest::Or : 0) |
                                  (inverted && brush.inverted ? BrushTest::Present : 0);
    }

private:
    BrushTest& test(BrushTestKind kind, int x, int y) {
        BrushTest& made = out.tests.emplace_back();
        made.kind = kind;
        made.x = x;
        made.y = y;
        return made;
    }
    /// Adds a test on two channels.
    BrushTest& test(BrushTestKind kind, const std::string& x, const std::string& y) {
        BrushTest& made = test(kind, use(x), use(y));
        if (made.x < 0 || made.y < 0) made.x = made.y = -1;
        return made;
    }

    /// Index of a channel among the brush fields, -1 if the data set lacks it.
    int use(const std::string& name) const {
        const std::optional<int> channel = info_.findChannel(name);
        const auto found = channel ? std::ranges::find(channels_, *channel) : channels_.end();
        return found == channels_.end() ? -1 : int(found - channels_.begin());
    }
    bool categorical(int at) const {
        const volume::Channel channel = info_.channel(channels_[std::size_t(at)]);
        return info_.parameters[std::size_t(channel.parameter)].categorical;
    }

    void encode(const RangeRegion& region) {
        for (const BrushInterval& interval : region.intervals) {
            const int at = use(interval.channel);
            BrushTest& made = test(BrushTestKind::Range, at, at);
            if (at < 0) continue;
            const double room = categorical(at) ? kLabelRoom : 0;
            made.place = {interval.lo - room, interval.hi + room, 0, 0};
            made.soft = interval.soft;
        }
    }
    void encode(const EllipseRegion& region) {
        BrushTest& made = test(BrushTestKind::Ellipse, region.x, region.y);
        made.place = {region.center, region.radius};
        made.correlation = region.correlation;
        made.soft = region.soft;
    }
    void encode(const LassoRegion& region) {
        BrushTest& made = test(BrushTestKind::Lasso, region.x, region.y);
        if (made.x < 0) return;
        const LassoPlace place = lassoPlace(region);
        made.place = {place.center, place.halfSize * place.extent};
        made.table = int(out.lassos.size());
        out.lassos.push_back(region);
    }
    void space(BrushTestKind kind, const auto& region) {
        BrushTest& made = test(kind, -1, -1);
        const SheetBox box = sheetBox(region, info_.lattice.axes);
        made.place = {info_.lattice.cellsOfSheet(box.center), 0};
        made.inverseRadius = info_.lattice.spacing / box.radius;
        made.soft = region.soft;
    }
    void encode(const SphereRegion& region) { space(BrushTestKind::Sphere, region); }
    void encode(const BoxRegion& region) { space(BrushTestKind::Box, region); }
    void encode(const LensRegion& region) {
        int bits = 0;
        for (std::size_t i = 0; i < lenses_.size(); ++i)
            if (region.lens.empty() ? lenses_[i].marks : lenses_[i].name == region.lens) bits |= 1 << i;
        test(BrushTestKind::Lens, bits, 0);
    }

    const volume::DatasetInfo& info_;
    std::span<const int> channels_;
    std::span<const PlacedLens> lenses_;
};

} // namespace

BrushTests brushTests(const Selection& selection, const volume::DatasetInfo& info, std::span<const int> channels,
                      std::span<const PlacedLens> lenses) {
    Encoder encoder(info, channels, lenses);
    for (const Brush& brush : selection.brushes)
        if (brush.enabled) encoder.add(brush);
    return std::move(encoder.out);
}

} // namespace tessera::vis
