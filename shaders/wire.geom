// Gives each corner of a triangle its distance in pixels to the opposite edge.

layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;

uniform vec2 frame_size;   // in pixels

// Linear on the screen: the interpolated values are distances everywhere in the triangle.
noperspective out vec3 edge_distance;
flat out float thickness;   // smallest height of the triangle in pixels

void main() {
    vec2 corner[3];
    for (int k = 0; k < 3; ++k) {
        corner[k] = gl_in[k].gl_Position.xy * frame_size * 0.5;
    }
    vec2 a = corner[1] - corner[0];
    vec2 b = corner[2] - corner[0];
    float twice_area = abs(a.x * b.y - a.y * b.x);
    vec3 lengths = vec3(distance(corner[1], corner[2]), length(b), length(a));
    vec3 heights = twice_area / max(lengths, vec3(1e-6));
    for (int k = 0; k < 3; ++k) {
        edge_distance = vec3(0.0);
        edge_distance[k] = heights[k];
        thickness = min(heights.x, min(heights.y, heights.z));
        gl_Position = gl_in[k].gl_Position;
        EmitVertex();
    }
    EndPrimitive();
}
