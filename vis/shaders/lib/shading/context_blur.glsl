// Depth-of-field blur of unselected samples; twin: vis/optics/context_blur.h.
const float kBlurTaps = 32.0;

// Position of a tap in the unit disc.
vec2 blurTap(int tap) {
    float radius = sqrt((float(tap) + 0.5) / kBlurTaps), angle = 2.399963229728653 * float(tap);
    return radius * vec2(cos(angle), sin(angle));
}

// Weight with which a pixel of the given degree of interest contributes at a distance of `away` pixels.
float blurShare(float interest, float away, float radius) {
    return clamp(radius * (1.0 - interest) - away + 1.0, 0.0, 1.0);
}
