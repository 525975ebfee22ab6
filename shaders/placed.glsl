// Applies the transform of a layer or a camera: rotation, scale and translation.

uniform vec4 placement;   // real and imaginary part of the factor, and the shift

vec2 placed(vec2 place) {
    vec2 turn = placement.xy;
    return vec2(turn.x * place.x - turn.y * place.y, turn.y * place.x + turn.x * place.y) + placement.zw;
}
