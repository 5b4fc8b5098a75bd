// The scene's lenses in world space (vis/raycast/lens_uniforms.h). Constants: LENSES: number of lenses; LENS_KIND(i):
// see lib/sampling/lens.glsl; LENS_ACTS: 1 if a lens changes opacity or saturation or has its own layers; LENS_BENDS: 1 if a
// lens magnifies, LENS_BENDING(i): whether lens i does; LENS_FOCUS: 1 if a lens confines the brushes;
// LENS_SELECTS: 1 if the inside of a lens is what the brushes select.
#if LENSES > 0
uniform vec3 lensCenter[LENSES];
uniform vec3 lensToUnit[3 * LENSES];   // rows
uniform vec3 lensFromUnit[3 * LENSES]; // columns
uniform vec4 lensEdge[LENSES]; // rim; 1 if inverted; magnification; how much it confines the brushes
uniform vec3 lensAct[LENSES];  // opacity factors inside and outside; saturation factor inside
#endif
