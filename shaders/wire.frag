// The edges of a triangle, smooth and of constant width, half of it on each side.

uniform vec4 ink;      // straight alpha
uniform float width;   // in pixels

noperspective in vec3 edge_distance;
flat in float thickness;

out vec4 colour;

void main() {
    float nearest = min(edge_distance.x, min(edge_distance.y, edge_distance.z));
    float coverage = clamp(0.5 * width + 0.5 - nearest, 0.0, 1.0);
    // Fade lines of small triangles, which would merge into a solid patch.
    float crowding = clamp(thickness / (6.0 * width), 0.15, 1.0);
    float alpha = ink.a * coverage * crowding;
    colour = vec4(ink.rgb * alpha, alpha);
}
