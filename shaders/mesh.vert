// A vertex of the drawing. The vertex source linked with this file gives its position.

uniform vec4 view;   // factors and offsets from the plane to clip space
uniform vec2 view_turn;   // rotation of the plane before it, of length 1

in vec2 uv;          // position in the picture, (0, 0) its lower left corner

out vec2 texture_uv;

vec2 vertex_position();
vec2 placed(vec2 place);

vec2 turned(vec2 point) {
    return vec2(dot(point, vec2(view_turn.x, -view_turn.y)), dot(point, view_turn.yx));
}

void main() {
    texture_uv = uv;
    gl_Position = vec4(turned(placed(vertex_position())) * view.xy + view.zw, 0.0, 1.0);
}
