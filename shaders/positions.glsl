// Vertex source: positions that the program uploads for every frame.

in vec2 position;

vec2 vertex_position() {
    return position;
}
