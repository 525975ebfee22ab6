// An edge of the mesh's border as a strip on its outer, right side. The triangles draw the inner
// half of the line. The fill rules give each pixel along the edge to exactly one half.

layout(lines) in;
layout(triangle_strip, max_vertices = 4) out;

uniform vec2 frame_size;   // in pixels
uniform float width;       // of the line, in pixels

noperspective out vec3 edge_distance;
flat out float thickness;

void main() {
    vec2 along = (gl_in[1].gl_Position.xy - gl_in[0].gl_Position.xy) * frame_size;
    float reach = 0.5 * width + 1.0;
    vec2 outward = reach * vec2(along.y, -along.x) / max(length(along), 1e-6);
    for (int k = 0; k < 4; ++k) {
        float away = float(k / 2);
        // The strip's other sides are no edges, and the border is never crowded.
        edge_distance = vec3(away * reach, 1e6, 1e6);
        thickness = 1e6;
        vec4 place = gl_in[k % 2].gl_Position;
        gl_Position = place + vec4(away * outward / frame_size * 2.0, 0.0, 0.0);
        EmitVertex();
    }
    EndPrimitive();
}
