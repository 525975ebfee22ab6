// Where a figure is that hangs on another one: turned and moved as a whole.

uniform vec4 placement;   // real and imaginary part of the factor, of modulus 1, and the shift

vec2 placed(vec2 place) {
    vec2 turn = placement.xy;
    return vec2(turn.x * place.x - turn.y * place.y, turn.y * place.x + turn.x * place.y) + placement.zw;
}
