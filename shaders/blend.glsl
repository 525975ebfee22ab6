// Blends of the straight colours of a layer with those of its backdrop, by the names of the modes.
//
// Formulas of "Compositing and Blending Level 1" of the W3C, Section 10. Linear dodge, linear burn
// and subtract are as in Photoshop.

const float TINY = 1e-6;
const vec3 LUMINANCE = vec3(0.3, 0.59, 0.11);

vec3 darken(vec3 backdrop, vec3 source) { return min(backdrop, source); }

vec3 lighten(vec3 backdrop, vec3 source) { return max(backdrop, source); }

vec3 multiply(vec3 backdrop, vec3 source) { return backdrop * source; }

vec3 screen(vec3 backdrop, vec3 source) { return backdrop + source - backdrop * source; }

vec3 color_dodge(vec3 backdrop, vec3 source) {
    return min(backdrop / max(1.0 - source, TINY), 1.0);
}

vec3 color_burn(vec3 backdrop, vec3 source) {
    return 1.0 - color_dodge(1.0 - backdrop, 1.0 - source);
}

vec3 linear_dodge(vec3 backdrop, vec3 source) { return min(backdrop + source, 1.0); }

vec3 linear_burn(vec3 backdrop, vec3 source) { return max(backdrop + source - 1.0, 0.0); }

vec3 hard_light(vec3 backdrop, vec3 source) {
    vec3 dark = multiply(backdrop, 2.0 * source);
    return mix(dark, screen(backdrop, 2.0 * source - 1.0), step(0.5, source));
}

vec3 overlay(vec3 backdrop, vec3 source) { return hard_light(source, backdrop); }

vec3 soft_light(vec3 backdrop, vec3 source) {
    vec3 deep = ((16.0 * backdrop - 12.0) * backdrop + 4.0) * backdrop;
    vec3 lit = mix(deep, sqrt(backdrop), step(0.25, backdrop));
    vec3 strength = 2.0 * source - 1.0;
    return backdrop + strength * mix(backdrop * (1.0 - backdrop), lit - backdrop, step(0.5, source));
}

vec3 difference(vec3 backdrop, vec3 source) { return abs(backdrop - source); }

vec3 exclusion(vec3 backdrop, vec3 source) {
    return backdrop + source - 2.0 * backdrop * source;
}

vec3 subtract(vec3 backdrop, vec3 source) { return max(backdrop - source, 0.0); }

float least(vec3 levels) { return min(min(levels.r, levels.g), levels.b); }

float largest(vec3 levels) { return max(max(levels.r, levels.g), levels.b); }

// A colour with the luminance of another, clipped to the range of colours.
vec3 with_luminance(vec3 levels, vec3 other) {
    float target = dot(other, LUMINANCE);
    vec3 offset = levels - dot(levels, LUMINANCE);
    float down = target / max(-least(offset), TINY);
    float up = (1.0 - target) / max(largest(offset), TINY);
    return target + offset * min(min(down, up), 1.0);
}

// A colour with the saturation of another.
vec3 with_saturation(vec3 levels, vec3 other) {
    float low = least(levels);
    float target = largest(other) - least(other);
    return (levels - low) * target / max(largest(levels) - low, TINY);
}

vec3 hue(vec3 backdrop, vec3 source) {
    return with_luminance(with_saturation(source, backdrop), backdrop);
}

vec3 saturation(vec3 backdrop, vec3 source) {
    return with_luminance(with_saturation(backdrop, source), backdrop);
}

vec3 color(vec3 backdrop, vec3 source) { return with_luminance(source, backdrop); }

vec3 luminosity(vec3 backdrop, vec3 source) { return with_luminance(backdrop, source); }
