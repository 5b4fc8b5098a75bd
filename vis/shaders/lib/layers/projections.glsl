// Projections (MIP, average, X-ray, ...): ray styles that evaluate the whole ray. Defined in vis/optics/ray_setup.h.
#if HAS_PROJECTION

// Best score and its sample; sums. weight is 1 once a local maximum is found.
float best[LAYERS], bestAt[LAYERS], sum[LAYERS], weight[LAYERS], factor[LAYERS];
#if COLORED
vec2 tint[LAYERS]; // of sums: weighted colour channel value; its weight
#endif

void beginProjections() {
    for (int i = 0; i < LAYERS; ++i) {
        best[i] = -1.0;
        bestAt[i] = 0.0;
        sum[i] = 0.0;
        weight[i] = 0.0;
        factor[i] = 0.0;
#if COLORED
        tint[i] = vec2(0.0);
#endif
    }
}

// Adds sample k at p: `x` is its transfer function position, `lens` the opacity in the layer's lens. An absent sample
// (`is` false) only ends the rise to a local maximum.
void project(int i, int k, vec3 p, float x, float lens, bool is) {
    float f = is ? focusOpacity(degreeOfInterest(p), LAYER_BRUSHED(i)) * lens : 0.0;
    float place = clamp(x, 0.0, 1.0), share = f; // weight in the colour sum
    if (LAYER_STYLE(i) == STYLE_AVERAGE) {
        sum[i] += is ? f * x : 0.0;
        weight[i] += f;
        factor[i] += is ? 1.0 : 0.0;
    } else if (LAYER_STYLE(i) == STYLE_XRAY) {
        float a = is ? correctedOpacity(transfer(i, x).a * f, ray.stepLength * REFERENCE_LENGTHS * layerMap[i].z) : 0.0;
        share = (1.0 - sum[i]) * a;
        sum[i] += share;
    } else {
        float score = (LAYER_STYLE(i) == STYLE_MINIMUM ? 1.0 - place : place) * f;
        // A local maximum above the threshold is final once values fall again.
        if (LAYER_STYLE(i) == STYLE_LOCALMAXIMUM)
            weight[i] = best[i] >= layerMore[i].y && (!is || score < best[i]) ? 1.0 : weight[i];
        bool better = is && score > best[i] && weight[i] == 0.0;
        bestAt[i] = better ? float(k) : bestAt[i];
        best[i] = better ? score : best[i];
    }
#if COLORED
    if (LAYER_COLORED(i) == 1 && (LAYER_STYLE(i) == STYLE_AVERAGE || LAYER_STYLE(i) == STYLE_XRAY)) {
        vec2 s = reconstruct(LAYER_COLOR(i), p);
        tint[i] += is && present(s) ? share * vec2(s.x, 1.0) : vec2(0.0);
    }
#endif
}

// Colour (linear) of a layer that shows a sum.
vec3 colorOfSum(int i, vec3 own) {
#if COLORED
    return colorOfReading(i, tint[i].x / max(tint[i].y, 1e-20), tint[i].y > 0.0, own);
#else
    return own;
#endif
}

void showProjections() {
    for (int i = 0; i < LAYERS; ++i) {
        if (LAYER_STYLE(i) == STYLE_COMPOSITE || LAYER_STYLE(i) == STYLE_ISO) continue;
        vec4 c;
        float alpha, at = 0.5 * float(ray.count), doi = 1.0; // a sum has no position on the ray
        if (LAYER_STYLE(i) == STYLE_XRAY) {
            alpha = sum[i];
            c = transfer(i, alpha);
            c.rgb = colorOfSum(i, c.rgb);
        } else if (LAYER_STYLE(i) == STYLE_AVERAGE) {
            c = transfer(i, sum[i] / max(weight[i], 1e-6));
            c.rgb = colorOfSum(i, c.rgb);
            alpha = weight[i] > 0.0
                        ? min(min(1.0, layerMap[i].z * c.a) * (weight[i] / max(factor[i], 1.0)), 1.0) : 0.0;
        } else {
            at = bestAt[i];
            vec3 p = cellsAt(at);
            vec2 s = reconstruct(LAYER_FIELD(i), p);
            float x = s.x * layerMap[i].x + layerMap[i].y;
            if (LAYER_GRADIENT(i) == 1) x = gradientPlace(i, cellGradient(LAYER_FIELD(i), p, s.x, best[i] >= 0.0));
            doi = degreeOfInterest(p);
            c = transfer(i, x);
            c.rgb = colorBy(i, p, c.rgb);
            vec2 lens = lensAction(LAYER_LENS(i), worldAt(at), doi);
            c.rgb = focusColor(c.rgb, doi, lens.y, LAYER_BRUSHED(i));
            alpha = best[i] >= 0.0
                        ? min(min(1.0, layerMap[i].z * c.a) * focusOpacity(doi, LAYER_BRUSHED(i)) * lens.x, 1.0) : 0.0;
        }
        show(Met(at, vec4(c.rgb * alpha, alpha), focusInterest(doi, LAYER_BRUSHED(i))));
    }
}
#endif
