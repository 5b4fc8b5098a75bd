// The scene's lenses in world space (vis/raycast/lens_uniforms.h). Compiled-in: LENSES their number, LENS_KIND(i)
// (lib/lens.glsl), LENS_ACTS 1 if one changes opacity or saturation or has layers of its own, LENS_BENDS 1 if one
// magnifies and LENS_BENDING(i) which, LENS_FOCUS 1 if one confines the brushes.
#if LENSES > 0
uniform vec3 lensCenter[LENSES];
uniform vec3 lensToUnit[3 * LENSES];   // rows
uniform vec3 lensFromUnit[3 * LENSES]; // columns
uniform vec4 lensEdge[LENSES]; // rim; 1 if inverted; magnification; share of brushes confined
uniform vec3 lensAct[LENSES];  // factors on opacity inside and outside, on saturation inside
#endif
