// A checkerboard of two colours.

uniform vec4 light;     // premultiplied
uniform vec4 dark;
uniform vec2 origin;    // a corner of four squares, in pixels from the lower left
uniform float square;   // side of a square in pixels

out vec4 colour;

void main() {
    vec2 cell = floor((gl_FragCoord.xy - origin) / square);
    colour = mod(cell.x + cell.y, 2.0) < 0.5 ? light : dark;
}
