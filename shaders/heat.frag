// The drawing in the colours of a quantity; its own lights and darks stay visible.

uniform sampler2D ramp;      // colours of the quantity, one row
uniform vec2 limits;         // quantities at the ends of the ramp
uniform float contours;      // number of contour lines between the limits
uniform float strength;      // 1 hides the drawing's own colours, 0 the heat map
uniform float two_sided;     // 1: a quantity in the middle of the limits changes nothing

in vec2 texture_uv;
in float vertex_heat;

out vec4 colour;

const vec3 LUMA = vec3(0.299, 0.587, 0.114);

vec4 picture_at(vec2 uv);

void main() {
    vec4 drawing = picture_at(texture_uv);
    float level = clamp((vertex_heat - limits.x) / (limits.y - limits.x), 0.0, 1.0);
    float texels = float(textureSize(ramp, 0).x);
    vec3 heat = texture(ramp, vec2((level * (texels - 1.0) + 0.5) / texels, 0.5)).rgb;

    float line = level * (contours + 1.0);
    float steepness = max(fwidth(line), 1e-6);
    float distance_px = abs(line - round(line)) / steepness;
    bool between = round(line) > 0.5 && round(line) < contours + 0.5;
    // A line is meaningless if the quantity is flat or jumps within a pixel.
    float ink = between ? clamp(1.2 - distance_px, 0.0, 1.0) * clamp(0.5 / steepness, 0.0, 1.0) : 0.0;
    heat = mix(heat, vec3(1.0), 0.45 * ink);

    float luma = dot(drawing.rgb, LUMA);
    vec3 painted = heat * mix(drawing.a, luma, 0.35);
    float shown = strength * mix(1.0, min(3.0 * abs(2.0 * level - 1.0), 1.0), two_sided);
    colour = vec4(mix(drawing.rgb, painted, shown), drawing.a);
}
