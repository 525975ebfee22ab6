// A vertex of the drawing. Where it is comes from the vertex source that is linked with this file.

uniform vec4 view;   // factors and offsets from the plane to clip space
uniform vec2 view_turn;   // by which the plane is turned before, of length 1

in vec2 uv;          // place in the picture, (0, 0) its lower left corner

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
