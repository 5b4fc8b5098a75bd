#pragma once

#include "vis/optics/brush_tests.h"
#include "vis/optics/look_shading.h"
#include "vis/optics/ray_setup.h"
#include "vis/optics/shade.h"
#include "vis/packed/packed_box.h"
#include "vis/packed/packed_light.h"
#include "vis/scene/brush_effect.h"
#include "vis/scene/clipping.h"
#include "vis/scene/geometry.h"
#include "vis/scene/layers.h"
#include "vis/scene/lens.h"
#include "volume/reconstruct/gradient.h"

#include <cstdint>
#include <span>

/// What the ray caster of every instruction set gets: plain values and pointers into a PacketScene.
namespace tessera::vis::packet {

/// A PacketVolume.
struct VolumeView {
    const std::int16_t* shorts = nullptr; ///< null: floats
    const float* floats = nullptr;
    const std::int16_t* present = nullptr; ///< null: all
    bool bcc = false;
    bool labels = false; ///< the nearest sample is read
    bool cubic = false;  ///< the samples are coefficients of cubic B-splines
    glm::ivec3 cells{1};
    glm::ivec3 perBrick{0};            ///< added to the place of a pair for each brick before it along an axis
    int oddOffset = 0;                 ///< pairs from the even to the odd sublattice
    const VolumeView* parts = nullptr; ///< of a parameter with several; then this one has no samples
    int partCount = 0;
};

inline constexpr float kNowhere = -1e9f;
inline constexpr int kMostPacketLayers = 16, kMostPacketSurfaces = 8, kMostPacketSlices = 8, kMostBrushFields = 8;
inline constexpr int kTableEntries = 2048; ///< of a transfer function
inline constexpr int kShowBins = 256;      ///< of its places, one bit each
/// Entries of the table of unshaded samples, which are not interpolated: red and green, blue and extinction in the low
/// and high 16 bits of two words; kQuantum = 1. The extinction (ray_setup.h) is a float of a sign bit that is 0, 5 bits
/// of exponent and 10 of mantissa; 0 is 0.
inline constexpr int kPackedEntries = 4096, kExtinctionShift = 13, kExtinctionLeast = 127 - 20;

/// Integrals of a transfer function (vis/optics/preintegration.h) from place 0 to each of kSegmentPlaces equally far
/// apart: of t * colour and t, as whole numbers, so that their differences are exact. Ends of segments are rounded to
/// these places.
inline constexpr int kSegmentPlaces = 16384;
struct IntegralView {
    const std::int32_t* sums = nullptr; ///< four of each place, also of one before the first and behind the last
    float extinction = 0;               ///< -log2(1 - opacity) of a mean of t that is 1 from one place to the next
};

/// Another channel that colours a layer.
struct ColorView {
    const VolumeView* volume = nullptr; ///< null: none
    float placeScale = 1, placeOffset = 0;
    const std::int32_t* table = nullptr;
    glm::vec3 absent{0}; ///< linear, where it has no value
};

/// A transfer function: entry i has the colour (linear) and opacity at places i and i + 1 of kTableEntries - 1, red,
/// green, blue and opacity, low and high 16 bits of a number, kQuantum = 1.
struct LayerView {
    const VolumeView* volume = nullptr;
    RayStyle style = RayStyle::Composite;
    bool shaded = false;
    float placeScale = 1, placeOffset = 0; ///< place = sample * scale + offset
    bool gradient = false;                 ///< shows the gradient's magnitude:
    float gradientScale = 0;               ///< place = change of samples over a cell * this
    float surfaceScale = 0;                ///< weight of the surface = change of samples over a cell * this, at most 1
    const std::int32_t* table = nullptr;
    const std::uint32_t* packed = nullptr;
    /// Regions of value and gradient magnitude that have opacity. Then colours of the table are sRGB, and its opacity
    /// is 1 where a region may have some; place in the range = place * x + y.
    std::span<const TransferRegion> regions;
    bool byRegions = false;
    glm::vec2 toRange{1, 0};
    Classification classification = Classification::Post;
    IntegralView integrals;     ///< of pre-integration
    const Look* look = nullptr; ///< null: plain
    float smooth = 0;           ///< of the look, in cells of a sublattice
    ColorView colors = {};
    std::uint32_t shows[kShowBins / 32] = {}; ///< bits of places around which there is opacity
    float opacityScale = 1;                   ///< of the table's opacities
    float density = 1;
    float threshold = 0; ///< place; of a local maximum
    float isoValue = 0;  ///< a sample
    float isoOpacity = 1;
    glm::vec3 isoColor{0}; ///< linear
    BrushEffect brushes = BrushEffect::Fade;
    int lens = -1; ///< index of the lens that it is drawn in; -1: everywhere
};

/// Strokes of a slice: see StrokePicture.
struct StrokesView {
    const float* texels = nullptr; ///< pairs; null: there are none
    glm::ivec2 size{1};
    glm::vec4 across{0}, up{0}; ///< StrokeMap
    float strength = 0;
    bool grey = false;
};

/// A slice layer.
struct SliceView {
    LayerView look; ///< its samples and colours, brushes and lens
    Plane plane;
    int contours = 0;
    float levelScale = 0, levelOffset = 0; ///< of contours: place in the range = sample * scale + offset
    float opacity = 1;
    StrokesView strokes;
};

/// A BrushTest in samples of its channels.
struct BrushView {
    BrushTestKind kind = BrushTestKind::Always;
    int flags = 0;      ///< BrushTest::Flags
    int x = -1, y = -1; ///< index of the brushed channels; -1: there is none; of a lens brush, bits of the lenses
    glm::vec4 place{0}; ///< range: lo, hi; ellipse and lasso: centre, and one over the radii or half the table
    glm::vec3 center{0}, inverseRadius{1}; ///< of a sphere or box, in cells of a PacketVolume
    double correlation = 0, soft = 0;
    const float* lasso = nullptr; ///< its table
    glm::vec3 color{0};           ///< linear
    bool holds = false;           ///< gives its colour
};

/// Brushes and lenses of a picture.
struct FocusView {
    bool any = false;
    std::span<const BrushView> brushes;
    std::span<const VolumeView* const> fields; ///< the brushed channels
    float start = 1;                           ///< degree of interest before the first brush
    float contextOpacity = 1, brushColor = 0;
    ContextLook context;
    std::span<const PlacedLens> lenses;
    float magnifies[kMaxLenses] = {}; ///< of each lens: distance from its centre within which it bends what is read
};

/// Blocks of kFine^3 cells, and what leaps over them need.
struct SkipView {
    const std::uint8_t* alike = nullptr;  ///< of a SkipMap
    const std::uint8_t* absent = nullptr; ///< of each block: some of its samples are absent
    const std::uint8_t* bound = nullptr;  ///< of a single maximum or minimum: largest score of a block, 255 = 1
    glm::ivec3 count{1};
};

struct CastJob {
    glm::ivec2 size{0};  ///< of the picture
    glm::vec2 jitter{0}; ///< of the rays in their pixels
    bool jitterStarts = false;
    std::uint32_t pass = 0;
    float share = 1;          ///< of this pass in the picture
    glm::ivec2 first{0};      ///< the pixel that `picture` and `pick` begin with, counted from the bottom left
    int rowLength = 0;        ///< pixels in their rows, bottom up
    float* picture = nullptr; ///< RGBA, linear, premultiplied: passes are added

    float* pick = nullptr; ///< distance along the ray of what is picked, kNowhere: nothing; rays that miss are left out

    glm::dvec3 origin{0}, originX{0}, originY{0};          ///< linear in ndc
    glm::dvec3 direction{0}, directionX{0}, directionY{0}; ///< to be normalised
    float begin = 0;
    PackedBox box;
    glm::dvec3 cell{1}; ///< world
    float stepVoxels = 1;
    std::span<const PlacedClip> clips;

    bool bcc = false, exact = false; ///< of all volumes
    std::span<const LayerView> layers;
    std::span<const SliceView> slices;
    int peels = 0;                       ///< rasterised surfaces of each pixel (PacketGeometry)
    std::size_t pixels = 0;              ///< from one of them to the next
    const float* peelDistance = nullptr; ///< distance along the ray, and BrushEffect; `first` and `rowLength` as below
    const float* peelColor = nullptr;    ///< RGBA, linear, premultiplied
    FocusView focus;
    SkipView skip;
    volume::GradientStencil stencil;
    LookView look;               ///< of looks, when there are any
    glm::dvec3 middle{0, 0, -1}; ///< direction of the ray in the middle of the picture
    ShadedBy light;
    const PackedLight* around = nullptr; ///< what `light` looks up
    std::uint64_t* samples = nullptr;    ///< counts samples taken, when not null
};

} // namespace tessera::vis::packet
