// What is not brushed lies out of focus; twin: vis/optics/context_blur.h.
const float kBlurTaps = 32.0;

// Place of a tap in the unit disc.
vec2 blurTap(int tap) {
    float radius = sqrt((float(tap) + 0.5) / kBlurTaps), angle = 2.399963229728653 * float(tap);
    return radius * vec2(cos(angle), sin(angle));
}

// How much of a pixel with a degree of interest reaches a place `away` pixels off.
float blurShare(float interest, float away, float radius) {
    return clamp(radius * (1.0 - interest) - away + 1.0, 0.0, 1.0);
}
