// A segment with round ends, cut at its neighbours, so that no pixel is drawn twice.

in vec2 place;
flat in vec4 ends;
flat in vec2 cut_start;
flat in vec2 cut_end;
flat in vec4 line_ink;
flat in vec3 pen;

out vec4 colour;

void main() {
    vec2 from = place - ends.xy;
    if (dot(from, cut_start) < 0.0 || dot(place - ends.zw, cut_end) >= 0.0 && cut_end != vec2(0.0)) {
        discard;
    }
    vec2 way = ends.zw - ends.xy;
    float far = max(length(way), 1e-6);
    float along = clamp(dot(from, way) / far, 0.0, far);
    float aside = distance(from, way / far * along);
    float coverage = clamp(0.5 * pen.x + 0.5 - aside, 0.0, 1.0);
    if (pen.y > 0.0) {
        // Distance in pixels from the middle of the nearest dash; a dash is as long as its gap.
        float phase = mod(along + pen.z, 2.0 * pen.y) - 0.5 * pen.y;
        float beyond = min(abs(phase), abs(phase - 2.0 * pen.y));
        coverage *= clamp(0.5 * pen.y + 0.5 - beyond, 0.0, 1.0);
    }
    float alpha = line_ink.a * coverage;
    colour = vec4(line_ink.rgb * alpha, alpha);
}
