// Jitter of the sample positions along a pixel's ray, in steps, -1/2..1/2; twin: startJitter() in vis/optics/jitter.h.
float startJitter(uvec2 pixel, uint pass) {
    uint inner = pixel.x * 288237660u + pixel.y * 25070368u, high, low;
    umulExtended(inner, 4221604530u, high, low);
    uint outer = inner * 52u + high + pass * 2654435769u;
    return float(outer >> 8) / 16777216.0 - 0.5;
}
