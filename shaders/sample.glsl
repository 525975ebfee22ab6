// A sample of the source picture. It is exact at a pixel's centre and smooth in enlargements. A
// picture squeezed along one axis has no aliasing and no needless blur.

uniform sampler2D picture;   // premultiplied, mip-mapped, transparent outside

// Rasterisation moves vertices by up to 1/512 pixel, float32 by as much again on the largest
// pictures. Without this zone around the centres, in texels, a frame at 1:1 would mix in a trace
// of the neighbours. At a soft edge this trace is many levels of a faint pixel's colour.
const float EXACT_ZONE = 1.0 / 64.0;

// Our own anisotropic filter: the filter of Mesa's drivers frays edges, also enlarged ones.
const float MOST_TAPS = 8.0;

// The footprint of a pixel of the frame on a picture, in texels.
struct Footprint {
    vec2 along;     // its longest side
    float longest;  // the length of this side
    int taps;       // samples side by side along it, each as wide as the footprint is narrow
    float level;    // of the mip map
};

Footprint footprint_at(vec2 place) {
    vec2 step_x = dFdx(place);
    vec2 step_y = dFdy(place);
    bool x_is_longer = dot(step_x, step_x) > dot(step_y, step_y);
    vec2 along = x_is_longer ? step_x : step_y;
    float longest = length(along);
    float area = abs(step_x.x * step_y.y - step_x.y * step_y.x);
    float narrow = max(area / max(longest, 1e-6), 1.0);
    // Integers: as floats, garbage in lanes that draw nothing slows software OpenGL down.
    int taps = max(int(min(longest / narrow + 0.75, MOST_TAPS)), 1);
    return Footprint(along, longest, taps, log2(max(longest / float(taps), 1.0)));
}

vec4 sample_of(sampler2D source, vec2 place, Footprint foot) {
    ivec2 size = textureSize(source, 0);
    vec2 texels = vec2(size);
    vec2 centre = round(place);
    vec2 offset = place - centre;
    // Stretch the rest of the distance to the neighbour, so that there is no seam.
    offset = sign(offset) * max(abs(offset) - EXACT_ZONE, 0.0) / (1.0 - 2.0 * EXACT_ZONE);
    bool is_exact = offset == vec2(0.0) && foot.longest < 1.2;
    ivec2 pixel = ivec2(centre);
    bool inside = all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size));
    if (is_exact) {
        return inside ? texelFetch(source, pixel, 0) : vec4(0.0);
    }
    vec2 reach = vec2(foot.longest + 2.0 * exp2(foot.level));
    bool is_near = all(greaterThan(place, -reach)) && all(lessThan(place, texels + reach));
    int taps = is_near ? foot.taps : 0;
    vec2 stride = foot.along / float(foot.taps) / texels;
    vec2 first = (centre + offset + 0.5) / texels - 0.5 * float(foot.taps - 1) * stride;
    vec4 sum = vec4(0.0);
    for (int k = 0; k < taps; ++k) {
        sum += textureLod(source, first + float(k) * stride, foot.level) / float(foot.taps);
    }
    return sum;
}

vec4 picture_at(vec2 uv) {
    vec2 place = uv * vec2(textureSize(picture, 0)) - 0.5;
    return sample_of(picture, place, footprint_at(place));
}
