#pragma once

#include "vis/gl/shader_constants.h"
#include "vis/scene/scene.h"
#include "volume/field/dataset.h"

#include <span>

/// From the selection of a scene to what rays test: every brush becomes tests in a row, one per interval or one for
/// another shape.
namespace tessera::vis {

inline constexpr int kMaxBrushTests = 128;
/// Labels are integers: a little room, so that [1, 1] means the label 1 in float too.
inline constexpr double kLabelRoom = 0.25;

/// One test, in physical units.
struct BrushTest {
    enum Flags { First = 1, Last = 2, Inverted = 4, Or = 8 }; ///< of its brush
    BrushTestKind kind = BrushTestKind::Always;
    int flags = 0;
    /// Brush fields that it looks at; -1: the data lack the channel, which has no value anywhere. Of a lens, x has the
    /// bits of the lenses.
    int x = -1, y = -1;
    /// Range: lo, hi. Ellipse: centre, radii. Lasso: centre, half size of its table. Sphere, box: centre, in cells.
    glm::dvec4 place{0};
    glm::dvec3 inverseRadius{1}; ///< of a sphere or a box, in cells
    double correlation = 0;      ///< of an ellipse
    double soft = 0;             ///< width of its edge; of ellipse, sphere and box in radii
    int table = 0;               ///< of a lasso: place among BrushTests::lassos
    glm::vec4 color{0};          ///< of its brush, linear; 1, or 0 where it holds nothing
};

struct BrushTests {
    std::vector<BrushTest> tests;
    std::vector<LassoRegion> lassos; ///< whose tables the tests look up, in order
    float start = 1;                 ///< what the first brush meets
    int dropped = 0;                 ///< brushes beyond kMaxBrushTests, from the last one on
};

/// The tests of a selection. `channels`: of each brush field.
BrushTests brushTests(const Selection& selection, const volume::DatasetInfo& info, std::span<const int> channels,
                      std::span<const PlacedLens> lenses);

} // namespace tessera::vis
