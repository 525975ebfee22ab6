// A segment of a polyline as a rectangle around it, one instance per segment.

uniform vec4 view;         // factors and offsets from the plane to clip space
uniform vec2 view_turn;   // rotation of the plane before it, of length 1
uniform vec2 frame_size;   // in pixels

in vec2 before;            // points of the polyline around the segment; at the line's ends
in vec2 start;             // `before` is `start`, and `after` is `end`
in vec2 end;
in vec2 after;
in vec4 ink;               // straight alpha
in float width;            // in pixels
in float dash;             // length of a dash and of a gap in pixels; 0 for a solid line
in float travelled;        // pixels along the polyline from its first point to `start`

out vec2 place;            // of the fragment, in pixels
flat out vec4 ends;        // `start` and `end`, in pixels
flat out vec2 cut_start;   // directions of the cuts towards the neighbouring segments
flat out vec2 cut_end;
flat out vec4 line_ink;
flat out vec3 pen;         // width, dash, travelled

vec2 turned(vec2 point) {
    return vec2(dot(point, vec2(view_turn.x, -view_turn.y)), dot(point, view_turn.yx));
}

vec2 pixels(vec2 point) {
    return ((turned(point) * view.xy + view.zw) * 0.5 + 0.5) * frame_size;
}

vec2 direction(vec2 way) {
    float far = length(way);
    return far > 1e-6 ? way / far : vec2(0.0);
}

void main() {
    vec2 from = pixels(start);
    vec2 to = pixels(end);
    vec2 along = direction(to - from);
    if (along == vec2(0.0)) {
        along = vec2(1.0, 0.0);
    }
    vec2 aside = vec2(-along.y, along.x);
    float reach = 0.5 * width + 1.0;
    // Corners of a strip: 0 and 1 at the start, 2 and 3 at the end.
    vec2 corner = gl_VertexID < 2 ? from - along * reach : to + along * reach;
    place = corner + aside * (gl_VertexID % 2 == 0 ? reach : -reach);
    ends = vec4(from, to);
    cut_start = direction(from - pixels(before)) + (before == start ? vec2(0.0) : along);
    cut_end = direction(pixels(after) - to) + (after == end ? vec2(0.0) : along);
    line_ink = ink;
    pen = vec3(width, dash, travelled);
    gl_Position = vec4(place / frame_size * 2.0 - 1.0, 0.0, 1.0);
}
