// What a pixel shows so far, front to back.

const float kNoPick = -2.0, kPickOpacity = 0.1;

vec4 color = vec4(0.0); // linear, premultiplied
float pick = kNoPick;   // sample at which it becomes noticeable
float interest = 0.0;   // of what is shown, times its opacity; for CONTEXT_BLUR

// Something that the ray meets at a sample or between samples.
struct Met {
    float at;       // sample k lies at k; kNowhere: not met
    vec4 color;     // linear, premultiplied
    float interest;
};
const float kNowhere = 1e9;

// Puts it behind what has accumulated.
void show(Met met) {
    interest += (1.0 - color.a) * met.color.a * met.interest;
    color = under(color, met.color);
    if (pick <= kNoPick && color.a > kPickOpacity) pick = met.at;
}

// The nearer one first.
void order(inout Met a, inout Met b) {
    if (b.at < a.at) {
        Met nearer = b;
        b = a;
        a = nearer;
    }
}
