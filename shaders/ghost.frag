// A composited layer, or another frame of the drawing tinted as a ghost.

uniform sampler2D frame;   // premultiplied
uniform vec3 tint;
uniform float strength;   // of the tint; 0 keeps the colours
uniform float opacity;
uniform vec3 layer_tint;   // multiplies the colours; white keeps them

out vec4 colour;

const vec3 LUMA = vec3(0.299, 0.587, 0.114);

#ifdef BLEND
uniform sampler2D backdrop;   // premultiplied
uniform float clipped;   // 1: the layer meets its backdrop as if the backdrop were opaque

vec3 BLEND(vec3 backdrop, vec3 source);

vec3 straight(vec4 premultiplied) {
    return clamp(premultiplied.rgb / max(premultiplied.a, 1e-6), 0.0, 1.0);
}
#endif

void main() {
    vec4 drawing = texelFetch(frame, ivec2(gl_FragCoord.xy), 0) * vec4(layer_tint, 1.0);
    vec3 tinted = mix(tint * drawing.a, vec3(dot(drawing.rgb, LUMA)), 0.35);
    drawing.rgb = mix(drawing.rgb, tinted, strength);
#ifdef BLEND
    vec4 behind = texelFetch(backdrop, ivec2(gl_FragCoord.xy), 0);
    vec3 blended = drawing.a * BLEND(straight(behind), straight(drawing));
    drawing.rgb = mix(drawing.rgb, blended, max(clipped, behind.a));
#endif
    colour = drawing * opacity;
}
