// Vertex source: positions that the program writes anew for every frame.

in vec2 position;

vec2 vertex_position() {
    return position;
}
