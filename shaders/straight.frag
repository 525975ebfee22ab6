// A finished frame in a file's format: straight alpha, 8 bits, first row on top.

uniform sampler2D frame;   // premultiplied

out vec4 colour;

void main() {
    // SAMPLES of each pixel along both axes. It is a constant: a loop of unknown length takes
    // software OpenGL twice the time.
    ivec2 corner = ivec2(gl_FragCoord.xy) * SAMPLES;
    corner.y = textureSize(frame, 0).y - SAMPLES - corner.y;
    vec4 sum = vec4(0.0);
    for (int k = 0; k < SAMPLES * SAMPLES; ++k) {
        sum += texelFetch(frame, corner + ivec2(k % SAMPLES, k / SAMPLES), 0);
    }
    vec4 premultiplied = clamp(sum / float(SAMPLES * SAMPLES), 0.0, 1.0);
    // Rounded here, since OpenGL leaves rounding to the driver.
    float alpha = floor(premultiplied.a * 255.0 + 0.5);
    vec3 straight = clamp(premultiplied.rgb / max(premultiplied.a, 1e-6), 0.0, 1.0);
    colour = alpha > 0.0 ? vec4(floor(straight * 255.0 + 0.5), alpha) / 255.0 : vec4(0.0);
}
