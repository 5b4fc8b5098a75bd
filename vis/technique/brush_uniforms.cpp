#include "vis/technique/brush_uniforms.h"

#include "vis/technique/ray_field.h"

#include <algorithm>

namespace tessera::vis {

void setBrushUniforms(const Program& program, const RayPlan& plan, const Scene& scene,
                      const volume::DatasetInfo& info) {
    std::vector<glm::ivec2> meanings;
    std::vector<glm::vec3> intervals;
    for (const Brush& brush : scene.selection.brushes) {
        if (!brush.enabled || plan.brushFields.empty()) continue;
        const std::size_t first = meanings.size();
        for (const BrushInterval& interval : brush.intervals) {
            const std::optional<int> channel = info.findChannel(interval.channel);
            int use = -1;
            for (std::size_t i = 0; channel && i < plan.brushFields.size(); ++i)
                if (plan.fields[std::size_t(plan.brushFields[i])].channel == *channel) use = int(i);
            if (use < 0) { // an unknown channel has no value anywhere: never holds
                meanings.emplace_back(0, 0);
                intervals.emplace_back(1e30f, -1e30f, 1e30f);
                continue;
            }
            const BoundField& field = plan.fields[std::size_t(plan.brushFields[std::size_t(use)])];
            // Labels are integers: a little room, so that [1, 1] means the label 1 in float too.
            const double room = field.categorical ? 0.25 : 0;
            const double soft = interval.soft / field.encoding.scale;
            meanings.emplace_back(use, 0);
            intervals.emplace_back(toTexel(field, interval.lo - room), toTexel(field, interval.hi + room),
                                   soft > 1e-30 ? 1 / soft : 1e30);
        }
        if (meanings.size() == first) { // no interval: holds everywhere
            meanings.emplace_back(-1, 0);
            intervals.emplace_back(0);
        }
        meanings[first].y |= 1;
        meanings.back().y |= 2 | (brush.inverted ? 4 : 0);
    }
    constexpr std::size_t kMaxIntervals = 32; // MAX_INTERVALS in lib/bindings.glsl
    if (meanings.size() > kMaxIntervals) {
        meanings.resize(kMaxIntervals); // whole brushes only: half a brush would select more than it says
        while (!meanings.empty() && (meanings.back().y & 2) == 0) meanings.pop_back();
        intervals.resize(meanings.size());
    }
    program.set("intervalCount", int(meanings.size()));
    program.set("intervalMeaning", std::span<const glm::ivec2>(meanings));
    program.set("interval", intervals);
    program.set("combineAny", scene.selection.combine == Combine::Any ? 1 : 0);
    program.set("context", glm::vec2(scene.selection.contextOpacity, scene.selection.contextSaturation));
}

} // namespace tessera::vis
