#include "vis/raycast/brush_uniforms.h"

#include "vis/optics/proxy.h"

#include <algorithm>

namespace tessera::vis {

namespace {

enum Kind { kAlways, kRange, kEllipse, kLasso, kSphere, kBox, kLens };

/// 1 / soft, or a hard edge.
double inverse(double soft) {
    return soft > 1e-30 ? 1 / soft : 1e30;
}

class Encoder {
public:
    Encoder(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info)
        : plan_(plan), info_(info), lenses_(placeLenses(scene, {})) {}

    BrushTests tests;

    void add(const Brush& brush) {
        const std::size_t first = tests.meanings.size(), lassos = tests.lassos.size();
        std::visit([&](const auto& region) { encode(region); }, brush.region);
        if (tests.meanings.size() == first) test(kAlways, 0, 0, glm::vec4(0), glm::vec4(0));
        // Whole brushes only: half a brush would select more than it says.
        if (tests.dropped > 0 || tests.meanings.size() > std::size_t(kMaxBrushTests)) {
            ++tests.dropped;
            tests.meanings.resize(first);
            tests.shapes.resize(2 * first);
            tests.lassos.resize(lassos);
            return;
        }
        const bool holds = !brush.inverted && brush.combine != BrushCombine::Minus;
        tests.colors.resize(tests.meanings.size(), glm::vec4(linearFromSrgb(glm::dvec3(brush.color)), holds ? 1 : 0));
        if (first == 0) tests.start = brush.combine == BrushCombine::Or ? 0.0f : 1.0f;
        tests.meanings[first].w |= 1;
        const bool turned = brush.inverted != (brush.combine == BrushCombine::Minus);
        tests.meanings.back().w |= 2 | (turned ? 4 : 0) | (brush.combine == BrushCombine::Or ? 8 : 0);
    }

private:
    void test(Kind kind, int x, int y, glm::vec4 a, glm::vec4 b) {
        tests.meanings.emplace_back(kind, x, y, 0);
        tests.shapes.push_back(a);
        tests.shapes.push_back(b);
    }

    /// Position of a channel among the brush fields, -1 where the data lack it: then it has no value anywhere.
    int use(const std::string& name) const {
        const std::optional<int> channel = info_.findChannel(name);
        for (std::size_t i = 0; channel && i < plan_.brushFields.size(); ++i)
            if (plan_.fields[std::size_t(plan_.brushFields[i])].channel == *channel) return int(i);
        return -1;
    }
    const BoundField& field(int at) const {
        return plan_.fields[std::size_t(plan_.brushFields[std::size_t(std::max(0, at))])];
    }
    /// Centre, and 1 / radius, in texel units.
    glm::vec4 plane(int x, int y, glm::dvec2 center, glm::dvec2 radius) const {
        const TexelEncoding &across = field(x).encoding, &up = field(y).encoding;
        return {(center.x - across.offset) / across.scale, (center.y - up.offset) / up.scale, across.scale / radius.x,
                up.scale / radius.y};
    }

    // Range: lo, hi, 1 / soft in texel units.
    void encode(const RangeRegion& region) {
        for (const BrushInterval& interval : region.intervals) {
            const int at = use(interval.channel);
            if (at < 0) {
                test(kRange, -1, -1, glm::vec4(0), glm::vec4(0));
                continue;
            }
            const TexelEncoding& encoding = field(at).encoding;
            // Labels are integers: a little room, so that [1, 1] means the label 1 in float too.
            const double room = field(at).categorical ? 0.25 : 0;
            test(kRange, at, at,
                 {(interval.lo - room - encoding.offset) / encoding.scale,
                  (interval.hi + room - encoding.offset) / encoding.scale, inverse(interval.soft / encoding.scale), 0},
                 glm::vec4(0));
        }
    }
    // Ellipse: centre, 1 / radius; correlation c, 1 / (1 - c^2), 1 / soft.
    void encode(const EllipseRegion& region) {
        const int x = use(region.x), y = use(region.y);
        if (x < 0 || y < 0) return test(kEllipse, -1, -1, glm::vec4(0), glm::vec4(0));
        const double c = region.correlation;
        test(kEllipse, x, y, plane(x, y, region.center, region.radius), {c, 1 / (1 - c * c), inverse(region.soft), 0});
    }
    // Lasso: centre, 1 / half size of its table; first row of the table.
    void encode(const LassoRegion& region) {
        const int x = use(region.x), y = use(region.y);
        if (x < 0 || y < 0) return test(kLasso, -1, -1, glm::vec4(0), glm::vec4(0));
        const LassoPlace place = lassoPlace(region);
        test(kLasso, x, y, plane(x, y, place.center, place.halfSize * place.extent),
             {float(tests.lassos.size()) * kLassoTable, 0, 0, 0});
        tests.lassos.push_back(region);
    }
    // Sphere and box: centre in cells, 1 / soft; 1 / radius in cells.
    void space(Kind kind, const auto& region) {
        test(kind, -1, -1, {info_.lattice.toCells(region.center), inverse(region.soft)},
             {info_.lattice.spacing / region.radius, 0});
    }
    void encode(const SphereRegion& region) { space(kSphere, region); }
    void encode(const BoxRegion& region) { space(kBox, region); }
    // Lens: bits of the lenses meant.
    void encode(const LensRegion& region) {
        int bits = 0;
        for (std::size_t i = 0; i < lenses_.size(); ++i)
            if (region.lens.empty() ? lenses_[i].marks : lenses_[i].name == region.lens) bits |= 1 << i;
        test(kLens, bits, 0, glm::vec4(0), glm::vec4(0));
    }

    const RayPlan& plan_;
    const volume::DatasetInfo& info_;
    std::vector<PlacedLens> lenses_;
};

bool has(const BrushTests& tests, std::initializer_list<int> kinds) {
    return std::any_of(tests.meanings.begin(), tests.meanings.end(), [&](const glm::ivec4& meaning) {
        return std::find(kinds.begin(), kinds.end(), meaning.x) != kinds.end();
    });
}

} // namespace

BrushTests brushTests(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info) {
    Encoder encoder(plan, scene, info);
    for (const Brush& brush : scene.selection.brushes)
        if (brush.enabled) encoder.add(brush);
    return std::move(encoder.tests);
}

std::vector<std::pair<std::string, std::string>> brushDefines(const BrushTests& tests, const Scene& scene) {
    std::vector<std::pair<std::string, std::string>> defines;
    const auto define = [&](const char* name, int value) { defines.emplace_back(name, std::to_string(value)); };
    // Few sizes, so that a brush more rarely means another program.
    const int count = int(tests.meanings.size());
    define("BRUSH_TESTS", count == 0 ? 0 : count <= 8 ? 8 : count <= 32 ? 32 : kMaxBrushTests);
    define("BRUSH_RANGES", has(tests, {kRange}));
    define("BRUSH_ELLIPSES", has(tests, {kEllipse}));
    define("BRUSH_LASSOS", has(tests, {kLasso}));
    define("BRUSH_SPACE", has(tests, {kSphere, kBox}));
    define("BRUSH_LENSES", has(tests, {kLens}));
    define("BRUSH_COLORS", count > 0 && scene.selection.brushColor > 0);
    define("LASSO_TABLE", kLassoTable);
    return defines;
}

bool blursContext(const Scene& scene) {
    return scene.selection.contextBlur > 0 && scene.selection.active() && !drawnByProxy(scene);
}

void setBrushUniforms(const Program& program, const BrushTests& tests, const Scene& scene) {
    program.set("brushTestCount", int(tests.meanings.size()));
    program.set("brushMeaning", std::span<const glm::ivec4>(tests.meanings));
    program.set("brushShape", tests.shapes);
    program.set("brushStart", tests.start);
    program.set("brushOwnColor", tests.colors);
    program.set("brushColorShare", scene.selection.brushColor);
    program.set("context", glm::vec3(scene.selection.contextOpacity, scene.selection.contextSaturation,
                                     scene.selection.contextLightness));
}

GLuint BrushTables::update(const BrushTests& tests) {
    if (tests.dropped > dropped_)
        messages_.push_back("the last " + std::to_string(tests.dropped) +
                            " brushes are more than the 3D views can test; plots and tables count them");
    dropped_ = tests.dropped;
    if (tests.lassos == shown_) return texture_.name();
    if (tests.lassos.size() != shown_.size())
        texture_ = tests.lassos.empty() ? Texture()
                                        : makeTexture2D({kLassoTable, kLassoTable * int(tests.lassos.size())}, GL_R32F,
                                                        GL_NEAREST, "lasso tables");
    for (std::size_t i = 0; i < tests.lassos.size(); ++i) {
        if (tests.lassos.size() == shown_.size() && tests.lassos[i] == shown_[i]) continue;
        const LassoTable table = lassoTable(tests.lassos[i]);
        glTextureSubImage2D(texture_.name(), 0, 0, kLassoTable * int(i), kLassoTable, kLassoTable, GL_RED, GL_FLOAT,
                            table.doi.data());
    }
    shown_ = tests.lassos;
    return texture_.name();
}

} // namespace tessera::vis
