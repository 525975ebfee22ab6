// A vertex of the drawing. Where it is comes from the vertex source that is linked with this file.

uniform vec4 view;   // factors and offsets from the plane to clip space

in vec2 uv;          // place in the picture, (0, 0) its lower left corner

out vec2 texture_uv;

vec2 vertex_position();
vec2 placed(vec2 place);

void main() {
    texture_uv = uv;
    gl_Position = vec4(placed(vertex_position()) * view.xy + view.zw, 0.0, 1.0);
}
