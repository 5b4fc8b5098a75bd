// Accumulated result of a pixel, front to back.

const float kNoPick = -2.0, kPickOpacity = 0.1;

vec4 color = vec4(0.0); // linear, premultiplied
float pick = kNoPick;   // sample at which opacity exceeds kPickOpacity
float interest = 0.0;   // opacity-weighted degree of interest; for CONTEXT_BLUR

// A contribution at or between samples.
struct Met {
    float at;       // position in samples; kNowhere: none
    vec4 color;     // linear, premultiplied
    float interest;
};
const float kNowhere = 1e9;

// Composites it behind the accumulated colour.
void show(Met met) {
    interest += (1.0 - color.a) * met.color.a * met.interest;
    color = under(color, met.color);
    if (pick <= kNoPick && color.a > kPickOpacity) pick = met.at;
}

// Sorts two by distance.
void order(inout Met a, inout Met b) {
    if (b.at < a.at) {
        Met nearer = b;
        b = a;
        a = nearer;
    }
}
