// The source picture at a place in it: exact where the sample lies on a pixel's centre.

uniform sampler2D picture;   // premultiplied; transparent outside

// Rasterisation moves vertices by up to 1/512 pixel, float32 by as much again on the largest
// pictures. Without this zone around the centres, in texels, a frame at 1:1 would mix in a trace
// of its neighbours, and at a soft edge that trace is many levels of a faint pixel's colour.
const float EXACT_ZONE = 1.0 / 64.0;

vec4 picture_at(vec2 uv) {
    ivec2 size = textureSize(picture, 0);
    vec2 across = dFdx(uv);
    vec2 along = dFdy(uv);
    vec2 texel = uv * vec2(size) - 0.5;
    vec2 centre = round(texel);
    vec2 offset = texel - centre;
    // The rest of the way to the neighbour is stretched, so that there is no seam.
    offset = sign(offset) * max(abs(offset) - EXACT_ZONE, 0.0) / (1.0 - 2.0 * EXACT_ZONE);
    vec2 step_x = across * vec2(size);
    vec2 step_y = along * vec2(size);
    bool shrunk = max(dot(step_x, step_x), dot(step_y, step_y)) > 1.5;
    if (offset == vec2(0.0) && !shrunk) {
        ivec2 pixel = ivec2(centre);
        bool inside = all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size));
        return inside ? texelFetch(picture, pixel, 0) : vec4(0.0);
    }
    return textureGrad(picture, (centre + offset + 0.5) / vec2(size), across, along);
}
