// Uniforms and constants of the ray caster. The constants are generated #defines; the names of enumerators come from
// vis/gl/shader_constants.h:
//   FIELDS    number of bound fields (channels and their parts); FIELD_COVERAGE(i), FIELD_NEAREST(i): 0 or 1; CUBIC,
//             FIELD_CUBIC(i): see lib/sampling/cubic.glsl; LATER, PARTS, FIELD_PARTS(i), FIELD_MORE(i), PART_MARGIN: see lib/sampling/between_times.glsl
//   LAYERS    number of ray layers; LAYER_STYLE(i) (STYLE_COMPOSITE, ...), LAYER_FIELD(i), LAYER_SHADED(i);
//             LAYER_LOOKUP(i): classification of a composite layer (LOOKUP_CURVE, ...);
//             LAYER_GRADIENT(i): 1 if it shows the gradient magnitude; LAYER_LOOK(i): see lib/shading/draw_look.glsl;
//             LAYER_INTERVAL(i): 1 if only values within layerOpaque[i] have opacity;
//             LAYER_PLANE(i): page of planeTable for LOOKUP_PLANE and LOOKUP_SLAB;
//             COLORED, LAYER_COLORED(i), LAYER_COLOR(i), LAYER_COLOR_ROW(i): see lib/layers/color_by.glsl
//   ISOS      number of iso-surface layers; ISO_LAYER(n)
//   SLICES    number of slice planes; SLICE_FIELD(i); STROKES: 1 if any has strokes, SLICE_STROKES(i): 1 if it has
//   GEOMETRY  number of layers of rasterised surfaces
//   LAYER_LENS(i), SLICE_LENS(i)        lens that it is drawn in, -1: everywhere
//   LAYER_BRUSHED(i), SLICE_BRUSHED(i)  effect of brushes (BRUSHED_FADE, ...)
//   BRUSH_TESTS    capacity for brush tests, 0: no brush is active; BRUSH_RANGES, BRUSH_ELLIPSES, BRUSH_LASSOS,
//                  BRUSH_SPACE, BRUSH_LENSES: 0 or 1; BRUSH_COLORS: 1 if samples take the colours of brushes;
//                  BRUSH_FIELDS: number of fields tested, BRUSH_FIELD(i)
//   CONTEXT_BLUR       1 if the degree of interest is written for context blur
//   GRADIENT_DIAGONAL  1 if central differences are along the cube diagonals
//   BCC       1 on BCC; PRESENT_COVERAGE: kPresentCoverage of volume/reconstruct/reconstruct.h
// The indexed ones are ?: chains instead of constant arrays: Mesa turns constant arrays into uniforms before it unrolls
// loops, and then executes every style for every layer.
// Positions `p` are cells of the even sublattice at level 0 (Lattice::toCells); values are in texel units.

#include "lib/bindings/light_bindings.glsl"

// Dense texture of a channel: texture coordinate = p * fieldScale + fieldOffset on the even sublattice, plus fieldOdd
// on the odd one.
uniform sampler3D fieldTexture[FIELDS];
uniform vec3 fieldScale[FIELDS];
uniform vec3 fieldOffset[FIELDS];
uniform vec3 fieldOdd[FIELDS];
uniform int fieldLevel[FIELDS];
// Per atlas: 1 / size in texels. The offset of level l is levelPhase * (2^l - 1) cells.
uniform vec3 atlasInverse[FIELDS];
uniform float levelPhase;

// Rays are linear in the normalised device coordinates x, y.
uniform vec3 rayOrigin, rayOriginX, rayOriginY;
uniform vec3 rayDirection, rayDirectionX, rayDirectionY;
uniform vec2 ndcScale, ndcOffset; // ndc = gl_FragCoord * scale + offset
uniform float rayBegin;           // 0 in perspective, very negative in parallel projection
uniform vec3 worldCell;           // world edges of the cell that steps are measured in
uniform float stepVoxels;
uniform vec3 cellsPerWorld, cellsOffset; // p = world * cellsPerWorld + cellsOffset
uniform float gradientReach, gradientScale; // volume/reconstruct/gradient.h: reach; factor to change per worldCell
// 3 or 4, 4, kBisections, 8 or (BCC) 16, and 8. Uniforms instead of constants, so that no compiler unrolls these loops: on
// software GL that takes seconds.
uniform int gradientDirections, diagonals, bisections, latticeCorners, cubicCorners;

// JITTER: 1 if ray starts are jittered. Number of the pass of a supersampled frame.
uniform int passNumber;

// Layers. layerMap: transfer function position = value * x + y; z = density, or the iso value; w = opacity of an
// iso-surface. TABLE_ROW(i): row of the transfer table for layer i, or for slice i - LAYERS; TABLE_ROWS rows further is
// the row of maximal opacities of opaqueAt.
uniform sampler1DArray transferTable;
#if LAYERS > 0
uniform vec4 layerMap[LAYERS];
uniform vec3 layerColor[LAYERS]; // of a surface, or of a volume where its colour channel is absent
#if COLORED
uniform vec2 layerColorMap[LAYERS]; // position of the colour channel = value * x + y
#endif
uniform vec2 layerMore[LAYERS]; // gradient magnitude (texels per cell) to position; position of the threshold
uniform vec2 layerOpaque[LAYERS]; // if LAYER_INTERVAL(i): the interval of positions with opacity
#endif
#if PLANES > 0
uniform sampler2D planeTable; // pages of PLANE_SIZE x PLANE_SIZE, stacked vertically, premultiplied
#endif

#if SLICES > 0
uniform vec4 slicePlane[SLICES]; // normal, offset
uniform vec4 sliceMap[SLICES];   // transfer function position = value * x + y; z = contours, w = opacity
#if STROKES
uniform sampler2DArray strokeTexture;  // lightness times coverage, coverage
uniform vec4 strokeAcross[SLICES];     // texel = (dot(across.xyz, world) + across.w, the same of up)
uniform vec4 strokeUp[SLICES];
uniform vec4 strokeSize[SLICES];       // texels along both edges, layer of the texture
uniform vec2 strokeLook[SLICES];       // strength; 1 on grey
#endif
#endif

#if GEOMETRY > 0
uniform sampler2DArray geometryColor;    // linear, premultiplied; layer 0 the nearest
uniform sampler2DArray geometryDistance; // distance along the ray, 1e9: nothing; BrushEffect
#endif

#if BRUSH_TESTS > 0
uniform int brushTestCount;
uniform ivec4 brushMeaning[BRUSH_TESTS];   // BRUSH_TEST_ALWAYS, ...; brush fields, flags: BrushTest in vis/optics/brush_tests.h
uniform vec4 brushShape[2 * BRUSH_TESTS];
uniform float brushStart;
uniform sampler2D lassoTables;
#endif
#if BRUSH_COLORS
uniform vec4 brushOwnColor[BRUSH_TESTS]; // of the test's brush, linear; a: 1, or 0 if it holds nothing
uniform float brushColorShare;
#endif
uniform vec3 context; // opacity, saturation and lightness of unselected samples
