// A disc of constant size on the screen, one instance per disc.

uniform vec4 view;
uniform vec2 view_turn;   // rotation of the plane before it, of length 1
uniform vec2 frame_size;   // in pixels

in vec2 centre;
in float radius;           // in pixels, to the rim's outer edge
in float rim_width;
in float softness;         // width of the outer edge in pixels, 1 for a sharp disc
in vec4 fill;              // straight alpha, like `rim`
in vec4 rim;

out vec2 offset;           // from the centre, in pixels
flat out vec3 disc;        // radius, rim width, softness
flat out vec4 disc_fill;
flat out vec4 disc_rim;

vec2 turned(vec2 point) {
    return vec2(dot(point, vec2(view_turn.x, -view_turn.y)), dot(point, view_turn.yx));
}

void main() {
    float reach = radius + softness;
    offset = vec2(gl_VertexID % 2 == 0 ? -reach : reach, gl_VertexID < 2 ? -reach : reach);
    disc = vec3(radius, rim_width, softness);
    disc_fill = fill;
    disc_rim = rim;
    gl_Position = vec4(turned(centre) * view.xy + view.zw + offset / frame_size * 2.0, 0.0, 1.0);
}
