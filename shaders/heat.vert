// A vertex of the heat map: as mesh.vert, with the shown quantity.

uniform vec4 view;
uniform vec2 view_turn;   // rotation of the plane before it, of length 1

in vec2 uv;
in float heat;

out vec2 texture_uv;
out float vertex_heat;

vec2 vertex_position();
vec2 placed(vec2 place);

vec2 turned(vec2 point) {
    return vec2(dot(point, vec2(view_turn.x, -view_turn.y)), dot(point, view_turn.yx));
}

void main() {
    texture_uv = uv;
    vertex_heat = heat;
    gl_Position = vec4(turned(placed(vertex_position())) * view.xy + view.zw, 0.0, 1.0);
}
