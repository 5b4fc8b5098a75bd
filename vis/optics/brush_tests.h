#pragma once

#include "vis/scene/scene.h"
#include "volume/field/dataset.h"

#include <span>

/// Converts the selection of a scene to a list of tests: each brush becomes consecutive tests, one per interval, or one
/// for any other shape.
namespace tessera::vis {

/// Kinds of brush tests; shaders know them as BRUSH_TEST_ALWAYS and so on.
enum class BrushTestKind { Always, Range, Ellipse, Lasso, Sphere, Box, Lens };
inline constexpr std::string_view kBrushTestNames[] = {"always", "range", "ellipse", "lasso", "sphere", "box", "lens"};

inline constexpr int kMaxBrushTests = 128;
/// Tolerance for labels, so that [1, 1] includes label 1 in single precision.
inline constexpr double kLabelRoom = 0.25;

/// One test, in physical units.
struct BrushTest {
    enum Flags {
        First = 1,
        Last = 2,
        Inverted = 4,
        Or = 8,
        Present = 16, ///< inverted, and selects nothing where a value is absent
    };                ///< position within its brush, and properties of the brush
    BrushTestKind kind = BrushTestKind::Always;
    int flags = 0;
    /// Indices of the brush fields tested; -1: the data set lacks the channel, so the test fails everywhere. For a
    /// lens, x is the bit mask of the lenses.
    int x = -1, y = -1;
    /// Range: lo, hi. Ellipse: centre, radii. Lasso: centre, half size of its table. Sphere, box: centre, in cells.
    glm::dvec4 place{0};
    glm::dvec3 inverseRadius{1}; ///< of a sphere or a box, in cells
    double correlation = 0;      ///< of an ellipse
    double soft = 0;             ///< width of the soft edge; in radii for ellipse, sphere and box
    int table = 0;               ///< of a lasso: index into BrushTests::lassos
    glm::vec4 color{0};          ///< of its brush, linear; a: 1, or 0 if it holds nothing
};

struct BrushTests {
    std::vector<BrushTest> tests;
    std::vector<LassoRegion> lassos; ///< in the order of the tables that the tests look up
    float start = 1;                 ///< degree of interest before the first brush
    int dropped = 0;                 ///< number of omitted brushes, counted from the last
};

/// Converts a selection. `channels`: the channel of each brush field.
BrushTests brushTests(const Selection& selection, const volume::DatasetInfo& info, std::span<const int> channels,
                      std::span<const PlacedLens> lenses);

} // namespace tessera::vis
