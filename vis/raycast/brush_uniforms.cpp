#include "vis/raycast/brush_uniforms.h"

#include "vis/shapes/proxy.h"

#include <algorithm>

namespace tessera::vis {

namespace {

/// 1 / soft, or a large number for a hard edge.
double inverse(double soft) {
    return soft > 1e-30 ? 1 / soft : 1e30;
}

/// A test in the shader's layout, in texel units of its fields.
struct Shape {
    glm::vec4 a{0}, b{0};
};

/// Centre and 1 / radius in texel units of two fields.
glm::vec4 planeOf(const BrushTest& test, const TexelEncoding& across, const TexelEncoding& up) {
    return {(test.place.x - across.offset) / across.scale, (test.place.y - up.offset) / up.scale,
            across.scale / test.place.z, up.scale / test.place.w};
}

Shape shapeOf(const BrushTest& test, const RayPlan& plan) {
    const auto encoding = [&](int at) -> const TexelEncoding& {
        return plan.fields[std::size_t(plan.brushFields[std::size_t(at)])].encoding;
    };
    const double c = test.correlation;
    switch (test.kind) {
    case BrushTestKind::Always:
    case BrushTestKind::Lens:
        return {};
    case BrushTestKind::Sphere:
    case BrushTestKind::Box:
        return {{glm::dvec3(test.place), inverse(test.soft)}, {test.inverseRadius, 0}};
    default:
        break;
    }
    if (test.x < 0) return {};
    const TexelEncoding &x = encoding(test.x), &y = encoding(test.y);
    switch (test.kind) {
    case BrushTestKind::Range:
        return {
            {(test.place.x - x.offset) / x.scale, (test.place.y - x.offset) / x.scale, inverse(test.soft / x.scale), 0},
            {}};
    case BrushTestKind::Ellipse:
        return {planeOf(test, x, y), {c, 1 / (1 - c * c), inverse(test.soft), 0}};
    case BrushTestKind::Lasso:
        return {planeOf(test, x, y), {float(test.table) * kLassoTable, 0, 0, 0}};
    default:
        return {};
    }
}

} // namespace

std::vector<std::pair<std::string, std::string>> brushDefines(const BrushTests& brushes, const Selection& selection) {
    std::vector<std::pair<std::string, std::string>> defines;
    const auto define = [&](const char* name, int value) { defines.emplace_back(name, std::to_string(value)); };
    const auto has = [&](BrushTestKind kind) {
        return std::ranges::any_of(brushes.tests, [=](const BrushTest& test) { return test.kind == kind; });
    };
    // Capacities in few sizes, so that a new brush rarely needs another program.
    const int count = int(brushes.tests.size());
    define("BRUSH_TESTS", count == 0 ? 0 : count <= 8 ? 8 : count <= 32 ? 32 : kMaxBrushTests);
    define("BRUSH_RANGES", has(BrushTestKind::Range));
    define("BRUSH_ELLIPSES", has(BrushTestKind::Ellipse));
    define("BRUSH_LASSOS", has(BrushTestKind::Lasso));
    define("BRUSH_SPACE", has(BrushTestKind::Sphere) || has(BrushTestKind::Box));
    define("BRUSH_LENSES", has(BrushTestKind::Lens));
    define("BRUSH_COLORS", count > 0 && selection.brushColor > 0);
    define("LASSO_TABLE", kLassoTable);
    return defines;
}

bool blursContext(const Scene& scene) {
    return scene.selection.contextBlur > 0 && scene.selection.active() && !drawnByProxy(scene);
}

void setBrushUniforms(const Program& program, const RayPlan& plan, const Selection& selection) {
    std::vector<glm::ivec4> meanings;
    std::vector<glm::vec4> shapes, colors;
    for (const BrushTest& test : plan.brushes.tests) {
        meanings.emplace_back(int(test.kind), test.x, test.y, test.flags);
        const Shape shape = shapeOf(test, plan);
        shapes.push_back(shape.a);
        shapes.push_back(shape.b);
        colors.push_back(test.color);
    }
    program.set("brushTestCount", int(meanings.size()));
    program.set("brushMeaning", std::span<const glm::ivec4>(meanings));
    program.set("brushShape", shapes);
    program.set("brushStart", plan.brushes.start);
    program.set("brushOwnColor", colors);
    program.set("brushColorShare", selection.brushColor);
    program.set("context",
                glm::vec3(selection.contextOpacity, selection.contextSaturation, selection.contextLightness));
}

GLuint BrushTables::update(const BrushTests& brushes) {
    if (brushes.dropped > dropped_)
        messages_.push_back(
            "the last " + std::to_string(brushes.dropped) +
            " brushes are ignored in 3D views, which have reached their limit; plots and tables use them");
    dropped_ = brushes.dropped;
    if (brushes.lassos == shown_) return texture_.name();
    if (brushes.lassos.size() != shown_.size())
        texture_ = brushes.lassos.empty() ? Texture()
                                          : makeTexture2D({kLassoTable, kLassoTable * int(brushes.lassos.size())},
                                                          GL_R32F, GL_NEAREST, "lasso tables");
    for (std::size_t i = 0; i < brushes.lassos.size(); ++i) {
        if (brushes.lassos.size() == shown_.size() && brushes.lassos[i] == shown_[i]) continue;
        const LassoTable table = lassoTable(brushes.lassos[i]);
        glTextureSubImage2D(texture_.name(), 0, 0, kLassoTable * int(i), kLassoTable, kLassoTable, GL_RED, GL_FLOAT,
                            table.doi.data());
    }
    shown_ = brushes.lassos;
    return texture_.name();
}

} // namespace tessera::vis
