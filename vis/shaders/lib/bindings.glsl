// What the ray caster knows of the scene. Compiled-in (generated #defines; the names of their values are those of
// vis/gl/shader_constants.h):
//   FIELDS    number of channels bound, and their parts; FIELD_COVERAGE(i), FIELD_NEAREST(i): 0 or 1; LATER, PARTS,
//             FIELD_PARTS(i), FIELD_MORE(i), PART_MARGIN: see lib/between_times.glsl
//   LAYERS    ray layers; LAYER_STYLE(i) (STYLE_COMPOSITE, ...), LAYER_FIELD(i), LAYER_SHADED(i); LAYER_LOOKUP(i): how a composite
//             layer is classified (LOOKUP_CURVE, ...); LAYER_GRADIENT(i): 1 where the gradient's magnitude is shown;
//             LAYER_LOOK(i) (lib/draw_look.glsl); LAYER_INTERVAL(i): 1 where all opacity lies between layerOpaque[i];
//             LAYER_PLANE(i): page of planeTable of LOOKUP_PLANE and LOOKUP_SLAB; COLORED, LAYER_COLORED(i),
//             LAYER_COLOR(i), LAYER_COLOR_ROW(i): see lib/color_by.glsl
//   ISOS      iso layers; ISO_LAYER(n)
//   SLICES    slice planes; SLICE_FIELD(i)
//   GEOMETRY  layers of rasterised surfaces
//   LAYER_LENS(i), SLICE_LENS(i)  lens that it is drawn in, -1 everywhere
//   LAYER_BRUSHED(i), SLICE_BRUSHED(i)  what brushes do to it (BRUSHED_FADE, ...)
//   BRUSH_TESTS    room for tests of brushes, 0 = no brush is active; BRUSH_RANGES, BRUSH_ELLIPSES, BRUSH_LASSOS,
//                  BRUSH_SPACE, BRUSH_LENSES: 0 or 1; BRUSH_COLORS: 1 where samples take theirs; BRUSH_FIELDS channels they look at, BRUSH_FIELD(i)
// These are chains of ?: and not constant arrays, since Mesa turns such arrays into uniforms before it unrolls loops
// and then runs every style for every layer.
//   CONTEXT_BLUR  1 where the picture tells its degree of interest
//   GRADIENT_DIAGONAL  1 where differences go along the diagonals
//   BCC       1 on that lattice; PRESENT_COVERAGE   kPresentCoverage of volume/reconstruct/reconstruct.h
// Positions `p` are cells of the even sublattice at level 0 (Lattice::toCells); values are texel units.

#include "lib/light_bindings.glsl"

// Dense texture of a channel: texture coordinate = p * fieldScale + fieldOffset (even sublattice), fieldOdd added for
// the moved one.
uniform sampler3D fieldTexture[FIELDS];
uniform vec3 fieldScale[FIELDS];
uniform vec3 fieldOffset[FIELDS];
uniform vec3 fieldOdd[FIELDS];
uniform int fieldLevel[FIELDS];
// Of an atlas: 1 / its size in texels; shift of level 1 in cells, of level l: levelPhase * (2^l - 1).
uniform vec3 atlasInverse[FIELDS];
uniform float levelPhase;

// Rays: linear in normalised device coordinates x, y.
uniform vec3 rayOrigin, rayOriginX, rayOriginY;
uniform vec3 rayDirection, rayDirectionX, rayDirectionY;
uniform vec2 ndcScale, ndcOffset; // ndc = gl_FragCoord * scale + offset
uniform float rayBegin;           // 0 in perspective, very negative in parallel projection
uniform vec3 worldCell;           // world edges of the cell that steps are measured in
uniform float stepVoxels;
uniform vec3 cellsPerWorld, cellsOffset; // p = world * cellsPerWorld + cellsOffset
uniform float gradientReach, gradientScale; // of volume/reconstruct/gradient.h; from sums of differences to change over a worldCell
// 3 or 4, kBisections and 8 or (BCC) 16: no constants, so that no compiler unrolls these loops (seconds of it on
// software GL).
uniform int gradientDirections, bisections, latticeCorners;

// JITTER: 1 if rays start at random; the number of the pass of a supersampled still.
uniform int passNumber;

// Layers. layerMap: transfer coordinate = value * x + y; z = density, or the iso value; w = opacity of an iso-surface.
// Rows of the transfer table: TABLE_ROW(i) of layer i, of slice i - LAYERS; TABLE_ROWS further on whether a layer has
// opacity (opaqueAt).
uniform sampler1DArray transferTable;
#if LAYERS > 0
uniform vec4 layerMap[LAYERS];
uniform vec3 layerColor[LAYERS]; // of a surface; of a volume where what it is coloured by is absent
#if COLORED
uniform vec2 layerColorMap[LAYERS]; // transfer coordinate of what it is coloured by = value * x + y
#endif
uniform vec2 layerMore[LAYERS]; // factor from gradient magnitude (texels per cell) to its place; place of the threshold
uniform vec2 layerOpaque[LAYERS]; // of LAYER_INTERVAL(i): the places between which there is opacity
#endif
#if PLANES > 0
uniform sampler2D planeTable; // pages of PLANE_SIZE x PLANE_SIZE one above the other, premultiplied
#endif

#if SLICES > 0
uniform vec4 slicePlane[SLICES]; // normal, offset
uniform vec4 sliceMap[SLICES];   // transfer coordinate = value * x + y; z = contours, w = opacity
#endif

#if GEOMETRY > 0
uniform sampler2DArray geometryColor;    // linear, premultiplied; layer 0 the nearest
uniform sampler2DArray geometryDistance; // along the ray, 1e9: nothing; BrushEffect
#endif

#if BRUSH_TESTS > 0
uniform int brushTestCount;
uniform ivec4 brushMeaning[BRUSH_TESTS];   // BRUSH_TEST_ALWAYS, ...; brush fields, flags: BrushTest in vis/raycast/brush_tests.h
uniform vec4 brushShape[2 * BRUSH_TESTS];
uniform float brushStart;
uniform sampler2D lassoTables;
#endif
#if BRUSH_COLORS
uniform vec4 brushOwnColor[BRUSH_TESTS]; // of the test's brush, linear; 1, or 0 where it holds nothing
uniform float brushColorShare;
#endif
uniform vec3 context; // opacity, saturation, lightness of what is not brushed
