// A vertex of the heat map: as mesh.vert, with the quantity that is shown.

uniform vec4 view;

in vec2 uv;
in float heat;

out vec2 texture_uv;
out float vertex_heat;

vec2 vertex_position();
vec2 placed(vec2 place);

void main() {
    texture_uv = uv;
    vertex_heat = heat;
    gl_Position = vec4(placed(vertex_position()) * view.xy + view.zw, 0.0, 1.0);
}
