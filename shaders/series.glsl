// Vertex source: a series in time. Its functions of time are the same for all vertices and are
// uploaded as weights. Clenshaw's sum is then one product per row.

in vec4 rows[ROW_PAIRS];            // two rows of the series each
uniform vec2 weights[ROW_PAIRS];

vec2 vertex_position() {
    vec2 sum = vec2(0.0);
    for (int k = 0; k < ROW_PAIRS; ++k) {
        sum += weights[k].x * rows[k].xy + weights[k].y * rows[k].zw;
    }
    return sum;
}
