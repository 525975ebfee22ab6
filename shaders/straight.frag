// A finished frame as a file wants it: straight alpha, 8 bits, first row on top.

uniform sampler2D frame;   // premultiplied
uniform int samples;       // of each pixel, along both axes

out vec4 colour;

void main() {
    ivec2 corner = ivec2(gl_FragCoord.xy) * samples;
    corner.y = textureSize(frame, 0).y - samples - corner.y;
    vec4 sum = vec4(0.0);
    for (int k = 0; k < samples * samples; ++k) {
        sum += texelFetch(frame, corner + ivec2(k % samples, k / samples), 0);
    }
    vec4 premultiplied = clamp(sum / float(samples * samples), 0.0, 1.0);
    // Rounded here, since OpenGL lets a driver round as it likes.
    float alpha = floor(premultiplied.a * 255.0 + 0.5);
    vec3 straight = clamp(premultiplied.rgb / max(premultiplied.a, 1e-6), 0.0, 1.0);
    colour = alpha > 0.0 ? vec4(floor(straight * 255.0 + 0.5), alpha) / 255.0 : vec4(0.0);
}
