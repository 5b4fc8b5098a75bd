#include "vis/gl/shader_constants.h"

#include "vis/optics/brush_tests.h"

#include "vis/scene/brush_effect.h"
#include "vis/scene/clipping.h"
#include "vis/scene/layers.h"
#include "vis/scene/lens.h"
#include "vis/scene/tone.h"

#include <cctype>
#include <span>

namespace tessera::vis {

namespace {

struct Enumeration {
    std::string_view prefix;
    std::span<const std::string_view> names; ///< of enumerators 0, 1, ...
    bool bits = false;                       ///< the constants are 1 << enumerator
};
constexpr Enumeration kEnumerations[] = {{"STYLE_", kRayStyleNames},       {"LOOKUP_", kRayLookupNames},
                                         {"LENS_SHAPE_", kLensShapeNames}, {"CLIP_KIND_", kClipKindNames},
                                         {"BRUSHED_", kBrushEffectNames},  {"BRUSH_TEST_", kBrushTestNames},
                                         {"TONE_CURVE_", kToneCurveNames}, {"LOOK_", kLookFeatureNames, true}};

} // namespace

const std::string& shaderConstants() {
    static const std::string text = [] {
        std::string made;
        for (const Enumeration& each : kEnumerations)
            for (std::size_t i = 0; i < each.names.size(); ++i) {
                made += "#define " + std::string(each.prefix);
                for (const char c : each.names[i]) made += char(std::toupper(static_cast<unsigned char>(c)));
                made += ' ' + std::to_string(each.bits ? std::size_t(1) << i : i) + '\n';
            }
        return made;
    }();
    return text;
}

} // namespace tessera::vis
