// A composited layer, or another frame of the drawing tinted as a ghost.

uniform sampler2D frame;   // premultiplied
uniform vec3 tint;
uniform float strength;   // of the tint; 0 keeps the colours
uniform float opacity;
uniform vec3 layer_tint;   // multiplies the colours; white keeps them

out vec4 colour;

const vec3 LUMA = vec3(0.299, 0.587, 0.114);

void main() {
    vec4 drawing = texelFetch(frame, ivec2(gl_FragCoord.xy), 0) * vec4(layer_tint, 1.0);
    vec3 tinted = mix(tint * drawing.a, vec3(dot(drawing.rgb, LUMA)), 0.35);
    colour = vec4(mix(drawing.rgb, tinted, strength), drawing.a) * opacity;
}
