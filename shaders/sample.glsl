// A sample of the source picture. It is exact at a pixel's centre and smooth in enlargements. A
// picture squeezed along one axis has no aliasing and no needless blur.

uniform sampler2D picture;   // premultiplied, mip-mapped, transparent outside

// Rasterisation moves vertices by up to 1/512 pixel, float32 by as much again on the largest
// pictures. Without this zone around the centres, in texels, a frame at 1:1 would mix in a trace
// of the neighbours. At a soft edge this trace is many levels of a faint pixel's colour.
const float EXACT_ZONE = 1.0 / 64.0;

// Our own anisotropic filter: the filter of Mesa's drivers frays edges, also enlarged ones.
const float MOST_TAPS = 8.0;

vec4 picture_of(sampler2D source, vec2 uv) {
    ivec2 size = textureSize(source, 0);
    vec2 texels = vec2(size);
    vec2 place = uv * texels - 0.5;
    vec2 step_x = dFdx(place);
    vec2 step_y = dFdy(place);
    bool x_is_longer = dot(step_x, step_x) > dot(step_y, step_y);
    vec2 along = x_is_longer ? step_x : step_y;
    float longest = length(along);

    vec2 centre = round(place);
    vec2 offset = place - centre;
    // Stretch the rest of the distance to the neighbour, so that there is no seam.
    offset = sign(offset) * max(abs(offset) - EXACT_ZONE, 0.0) / (1.0 - 2.0 * EXACT_ZONE);
    if (offset == vec2(0.0) && longest < 1.2) {
        ivec2 pixel = ivec2(centre);
        bool inside = all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size));
        return inside ? texelFetch(source, pixel, 0) : vec4(0.0);
    }

    // Samples side by side along the pixel's footprint, each as wide as the footprint is narrow.
    float area = abs(step_x.x * step_y.y - step_x.y * step_y.x);
    float narrow = max(area / max(longest, 1e-6), 1.0);
    // Integers: as floats, garbage in lanes that draw nothing slows software OpenGL down.
    int taps = max(int(min(longest / narrow + 0.75, MOST_TAPS)), 1);
    float level = log2(max(longest / float(taps), 1.0));
    vec2 stride = along / float(taps) / texels;
    vec2 first = (centre + offset + 0.5) / texels - 0.5 * float(taps - 1) * stride;
    vec4 sum = vec4(0.0);
    for (int k = 0; k < taps; ++k) {
        sum += textureLod(source, first + float(k) * stride, level);
    }
    return sum / float(taps);
}

vec4 picture_at(vec2 uv) {
    return picture_of(picture, uv);
}
